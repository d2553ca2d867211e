"""The yaw-rate sliding-mode scheme: observer, flag, adaptive threshold, confirmation, isolation, energy monitor."""

from fddbench.detection.sliding_mode.detector import SlidingMode

__all__ = ["SlidingMode"]
