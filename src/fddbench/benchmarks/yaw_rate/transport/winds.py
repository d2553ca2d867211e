"""Winds of the yaw-rate benchmark in all six components, for the aircraft that has them."""

from fddbench.benchmarks.yaw_rate.winds import WINDS
from fddbench.flight.dryden import SIX_COMPONENT_WINDS
from fddbench.flight.wind import Wind

__all__ = ["in_six_components"]


def in_six_components(wind: Wind) -> Wind:
    """The wind of the same name that an aircraft with six degrees of freedom meets; others fly as they are."""
    names = [name for name, known in WINDS.items() if known is wind]
    return SIX_COMPONENT_WINDS.get(names[0], wind) if names else wind
