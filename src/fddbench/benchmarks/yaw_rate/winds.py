"""Winds of the yaw-rate benchmark, lateral; `transport.winds` has those with all six components."""

from collections.abc import Mapping

from fddbench.flight.one_minus_cosine import OneMinusCosine
from fddbench.flight.rotating_gust import LATERAL_WINDS
from fddbench.flight.wind import Wind

__all__ = ["WINDS"]

_GUST_S = 5.0

WINDS: Mapping[str, Wind] = {**LATERAL_WINDS, "one_minus_cosine": OneMinusCosine("right", _GUST_S)}
"""Winds by their names in campaigns, the default first; the discrete gust comes from the left at 5 s."""
