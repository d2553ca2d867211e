"""Decisions that detectors of redundant sensors share: agreement, comparison in pairs, confirmation.

The pattern of a member: predict what the sensors should read, by whatever model; make a statistic of each sensor's distance
from the prediction; `Miscompare` says of which sensors that differ the statistic is the larger one; `Confirmation` declares
what stands long enough. `Nearest` is for members that weigh one faulty sensor against several. `live_mean` and `spread` feed
a predictor: it is corrected with the mean of the sensors that are not declared while these agree, and coasts while they
differ.
"""

from fddbench.detection.decision.agreement import live_mean, live_sensors, spread
from fddbench.detection.decision.confirmation import Confirmation, ConfirmationState
from fddbench.detection.decision.miscompare import Compared, Miscompare, MiscompareState
from fddbench.detection.decision.nearest import Decision, Nearest, NearestGains, NearestState
from fddbench.detection.decision.standing import Standing, StandingGains, StandingState

__all__ = [
    "Compared",
    "Confirmation",
    "ConfirmationState",
    "Decision",
    "Miscompare",
    "MiscompareState",
    "Nearest",
    "NearestGains",
    "NearestState",
    "Standing",
    "StandingGains",
    "StandingState",
    "live_mean",
    "live_sensors",
    "spread",
]
