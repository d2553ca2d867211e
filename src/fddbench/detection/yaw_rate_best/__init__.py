"""Our own monitor of three yaw-rate sensors: each is believed in turn, and the motion of the aircraft is the judge."""

from fddbench.detection.yaw_rate_best.detector import YawRateBest

__all__ = ["YawRateBest"]
