"""Winds of the yaw-rate benchmark: lateral for the lateral model, in all six components for the aircraft that has them."""

from fddbench.flight.dryden import SIX_COMPONENT_WINDS
from fddbench.flight.turbulence import WINDS
from fddbench.flight.wind import Wind

__all__ = ["WINDS", "in_six_components"]


def in_six_components(wind: Wind) -> Wind:
    """The wind of the same name that an aircraft with six degrees of freedom meets; one of one's own flies as it is."""
    names = [name for name, known in WINDS.items() if known is wind]
    return SIX_COMPONENT_WINDS[names[0]] if names else wind
