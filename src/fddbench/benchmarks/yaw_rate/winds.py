"""Winds of the yaw-rate benchmark: lateral for the lateral model, in all six components for the aircraft that has them."""

from collections.abc import Mapping

from fddbench.flight.dryden import SIX_COMPONENT_WINDS
from fddbench.flight.one_minus_cosine import OneMinusCosine
from fddbench.flight.turbulence import WINDS as TURBULENCE
from fddbench.flight.wind import Wind

__all__ = ["WINDS", "in_six_components"]

_GUST_S = 5.0

WINDS: Mapping[str, Wind] = {**TURBULENCE, "one_minus_cosine": OneMinusCosine("right", _GUST_S)}
"""Winds by their names in campaigns, the default first; the discrete gust comes from the left at 5 s."""


def in_six_components(wind: Wind) -> Wind:
    """The wind of the same name that an aircraft with six degrees of freedom meets; others fly as they are."""
    names = [name for name, known in WINDS.items() if known is wind]
    return SIX_COMPONENT_WINDS.get(names[0], wind) if names else wind
