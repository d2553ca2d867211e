"""Our own monitor of three yaw-rate sensors: what would the aircraft have done if this sensor told the truth?"""

from fddbench.detection.yaw_rate_best.detector import YawRateBest

__all__ = ["YawRateBest"]
