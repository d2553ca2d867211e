"""Prediction of the yaw rate by the yaw-moment equation alone, for detectors to compare sensors with."""

from fddbench.detection.yaw_moment.equation import NEEDS, YawAcceleration, YawMoment
from fddbench.detection.yaw_moment.filter import YawMomentFilter, YawMomentState
from fddbench.detection.yaw_moment.gains import WatchGains, YawMomentGains
from fddbench.detection.yaw_moment.watch import Watch, WatchState

__all__ = [
    "NEEDS", "Watch", "WatchGains", "WatchState", "YawAcceleration", "YawMoment", "YawMomentFilter", "YawMomentGains",
    "YawMomentState",
]  # fmt: skip
