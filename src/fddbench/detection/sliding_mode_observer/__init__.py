"""A sliding-mode observer for any affine model with faults of sensors or of actuators."""

from fddbench.detection.sliding_mode_observer.detector import SlidingModeObserver

__all__ = ["SlidingModeObserver"]
