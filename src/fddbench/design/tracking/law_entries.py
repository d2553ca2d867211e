"""The blocks of a law's recipe as a file writes them, and what they make."""

from typing import Annotated

from pydantic import Field

from fddbench.benchmarks.b747_longitudinal.laws.law_file import Handover
from fddbench.campaign.rules.model import Strict
from fddbench.design.tracking.interconnection import Weights
from fddbench.design.tracking.lqi import Tolerances

__all__ = ["HandoverEntry", "Pair", "Positive", "TolerancesEntry", "Values", "WeightsEntry"]

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Values = Annotated[tuple[Annotated[float, Field(allow_inf_nan=False)], ...], Field(min_length=1)]
Pair = Annotated[tuple[Positive, ...], Field(min_length=2, max_length=2)]
Noise = Annotated[tuple[Positive, ...], Field(min_length=7, max_length=7)]


class WeightsEntry(Strict):
    """Sizes of an H∞ problem, see `fddbench.design.tracking.interconnection.Weights`; flight path first, then speed.

    Attributes
    ----------
    settling_s, command, disturbance, error, integral, effort, corner_rad_s, gust_m_s : two numbers
    noise : seven numbers
    """

    settling_s: Pair
    command: Pair
    disturbance: Pair
    gust_m_s: Pair
    noise: Noise
    error: Pair
    integral: Pair
    effort: Pair
    corner_rad_s: Pair

    def weights(self) -> Weights:
        """Return them for the synthesis."""
        return Weights(**self.model_dump())


class TolerancesEntry(Strict):
    """Sizes of a linear-quadratic problem, see `fddbench.design.tracking.lqi.Tolerances`; flight path first, then speed.

    Attributes
    ----------
    settling_s, error, integral, order : two numbers
    pitch_rate_deg_s, speed_filter_s : float
    """

    settling_s: Pair
    error: Pair
    integral: Pair
    pitch_rate_deg_s: Positive
    order: Pair
    speed_filter_s: Positive

    def tolerances(self) -> Tolerances:
        """Return them for the synthesis."""
        return Tolerances(**self.model_dump())


class HandoverEntry(Strict):
    """How the stabiliser takes the pitch over, see `fddbench.benchmarks.b747_longitudinal.laws.law_file.Handover`.

    Attributes
    ----------
    lead_s, lag_s, command_lag_s : float
        [s].
    """

    lead_s: Positive
    lag_s: Positive
    command_lag_s: Positive

    def handover(self) -> Handover:
        """Return it for the law."""
        return Handover(**self.model_dump())
