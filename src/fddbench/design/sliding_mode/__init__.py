"""Synthesis of sliding-mode observers that reconstruct faults of LPV plants: pair (L, W), certificate, bound, gains."""

from fddbench.design.sliding_mode.error_system import ErrorSystem, Pair, Weights
from fddbench.design.sliding_mode.observer_gains import ObserverGains, largest_fault, observer_gains
from fddbench.design.sliding_mode.plant import FaultyPlant, with_sensor_faults
from fddbench.design.sliding_mode.synthesis import SlidingDesign, analyse, frozen_gain, synthesise

__all__ = [
    "ErrorSystem",
    "FaultyPlant",
    "ObserverGains",
    "Pair",
    "SlidingDesign",
    "Weights",
    "analyse",
    "frozen_gain",
    "largest_fault",
    "observer_gains",
    "synthesise",
    "with_sensor_faults",
]
