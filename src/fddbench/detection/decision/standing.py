"""Accusations of one sensor or of several that stand long enough become declarations, for good."""

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import total
from fddbench.blocks.primitives import rarely
from fddbench.detection.confirmation import samples
from fddbench.interfaces import Bus

__all__ = ["Standing", "StandingGains", "StandingState"]

NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]


class StandingGains(BaseModel):
    """Confirmation times.

    Attributes
    ----------
    confirm_one_s, confirm_two_s : float
        How long the same single sensor, the same several ones, must stand accused [s].
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    confirm_one_s: NonNegative
    confirm_two_s: NonNegative


@record
class StandingState:
    """Who stands accused, and for how many samples the same ones have; who is declared."""

    accused: Rows
    held_samples: Row
    declared: Rows


@dataclass(frozen=True, kw_only=True)
class Standing:
    """Declares those who have stood accused together for a time: one longer, several at once.

    More may be added to what is declared; an accusation that lets a declared sensor go counts for nothing.
    """

    constants: ClassVar[Layout[Any]] = NOTHING
    draws: ClassVar[Draws[Any]] = NO_DRAWS

    states: Layout[StandingState]
    confirm_one: float
    confirm_two: float

    @classmethod
    def of(cls, gains: StandingGains, bus: Bus, n_sensors: int) -> "Standing":
        """Confirmation on the clock of a bus; refuses times that do not fit it."""
        return cls(
            states=Layout(StandingState(accused=n_sensors, held_samples=ROW, declared=n_sensors)),
            confirm_one=samples("confirm_one_s", gains.confirm_one_s, bus.sample_s),
            confirm_two=samples("confirm_two_s", gains.confirm_two_s, bus.sample_s),
        )

    def start(self, c: Nothing) -> StandingState:
        """Nobody accused."""
        del c
        return StandingState(accused=0.0, held_samples=0.0, declared=0.0)

    def step(self, x: StandingState, c: Nothing, n: Nothing, accused: Rows, clear: Row) -> tuple[StandingState, Rows]:
        """State, and the declared sensors as 1 or 0, (n_sensors, n_cases).

        Parameters
        ----------
        accused : (n_sensors, n_cases) rows
            1 or 0.
        clear : (n_cases,) row of bool
            Whether the accusation is beyond doubt at this sample.
        """
        del c, n
        n_accused, acquitted = total(accused), total(x.declared * (1.0 - accused))
        changed = total(np.abs(accused - x.accused)) > 0.0
        stands = clear & (n_accused > 0.0) & (acquitted < 1.0)
        held = np.where(stands, np.where(changed, 1.0, x.held_samples + 1.0), 0.0)
        # true at samples k0 to k means held for k - k0 samples; an accusation that does not stand has -1
        ready = held - 1.0 >= np.where(n_accused >= 2.0, self.confirm_two, self.confirm_one)
        declared = np.where(rarely(ready), accused, x.declared)
        return StandingState(accused=accused, held_samples=held, declared=declared), declared
