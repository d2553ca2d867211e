"""The choice among hypotheses: the healthy sensor is the one that the model speaks for, and whoever differs from it is not."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import largest
from fddbench.detection.decision.standing import Standing, StandingGains, StandingState
from fddbench.interfaces import Bus

__all__ = ["Nearest", "NearestGains"]

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]


class NearestGains(StandingGains):
    """Numbers of the decision.

    Attributes
    ----------
    gate_deg_s : float
        Sensors that differ by more do not measure the same [deg/s].
    gate_lag_s : float
        Lag on their distances [s].
    clear_ratio : float
        The sensor that is believed must be nearer to the model than this share of the distance of each accused one [-].
    """

    THRESHOLDS: ClassVar[Mapping[str, str]] = {"gate_deg_s": "up"}
    gate_deg_s: Positive
    gate_lag_s: Positive
    clear_ratio: Annotated[float, Field(gt=0.0, le=1.0)]


@record
class NearestState:
    """Distances of all pairs of sensors [deg/s]; who stands accused or is declared."""

    apart_deg_s: Rows
    standing: StandingState


@record
class Decision:
    """Declared sites; 1 where sensors differ, else 0; the largest distance over the gate [-]."""

    declared: Rows
    differ: Row
    residual: Row


@dataclass(frozen=True, kw_only=True)
class Nearest:
    """Accuses the sensors that differ from the one nearest to the model, be it one or several; latches.

    Beside `Miscompare` it chooses among whole hypotheses: one sensor must stand long, for the model has to be right all that
    time, several must be told at once; and while the nearest is hardly nearer than the accused it waits. A declaration is for
    good: more may be added to it, none is taken back. Nobody is accused while all sensors agree: a model error alone makes no
    alarm.
    """

    constants: ClassVar[Layout[Any]] = NOTHING
    draws: ClassVar[Draws[Any]] = NO_DRAWS

    states: Layout[NearestState]
    gate_deg_s: float
    share: float
    clear_ratio: float
    standing: Standing

    @classmethod
    def of(cls, gains: NearestGains, bus: Bus, n_sensors: int) -> "Nearest":
        """Decision on the clock of a bus."""
        standing, n_pairs = Standing.of(gains, bus, n_sensors), n_sensors * (n_sensors - 1) // 2
        return cls(
            states=Layout(NearestState(apart_deg_s=n_pairs, standing=standing.states.shape)),
            gate_deg_s=gains.gate_deg_s,
            share=float(1.0 - exp(np.array(-bus.sample_s / gains.gate_lag_s))),
            clear_ratio=gains.clear_ratio,
            standing=standing,
        )

    def start(self, c: Nothing) -> NearestState:
        """All sensors agree, nobody accused."""
        return NearestState(apart_deg_s=0.0, standing=self.standing.start(c))

    def apart(self, x: NearestState, r_deg_s: Rows) -> tuple[Rows, Row]:
        """Lagged distances of all pairs [deg/s], and whether any sensors differ, now or lagged: 1 or 0."""
        now = np.stack([np.abs(r_deg_s[i] - r_deg_s[j]) for i, j in combinations(range(len(r_deg_s)), 2)])
        lagged = x.apart_deg_s + self.share * (now - x.apart_deg_s)
        return lagged, np.where(np.maximum(largest(now), largest(lagged)) > self.gate_deg_s, 1.0, 0.0)

    def step(
        self, x: NearestState, c: Nothing, n: Nothing, r_deg_s: Rows, distance: Rows
    ) -> tuple[NearestState, Decision]:
        """State and decision at this sample.

        Parameters
        ----------
        r_deg_s : (n_sensors, n_cases) rows
            Readings [deg/s].
        distance : (n_sensors, n_cases) rows
            How far each sensor is from what the model says, in any unit, not negative.
        """
        apart, differ = self.apart(x, r_deg_s)
        accused = np.where(_from_nearest(apart, distance) > self.gate_deg_s, 1.0, 0.0)
        least = -largest(np.where(accused > 0.0, -distance, -1e300))
        clear = -largest(-distance) <= self.clear_ratio * least
        standing, declared = self.standing.step(x.standing, c, n, accused, clear)
        after = NearestState(apart_deg_s=apart, standing=standing)
        return after, Decision(declared=declared, differ=differ, residual=largest(apart) / self.gate_deg_s)


def _from_nearest(apart: Rows, distance: Rows) -> Rows:
    """Distance of every sensor from the one that is nearest to the model, of equal ones the first."""
    d, n = list(distance), len(distance)
    pair = {(i, j): k for k, (i, j) in enumerate(combinations(range(n), 2))}
    best, rows = d[0], [np.zeros_like(d[0]) if i == 0 else apart[pair[0, i]] for i in range(n)]
    for h in range(1, n):
        nearer = d[h] < best
        best = np.where(nearer, d[h], best)
        own = [np.zeros_like(d[0]) if i == h else apart[pair[min(i, h), max(i, h)]] for i in range(n)]
        rows = [np.where(nearer, own[i], rows[i]) for i in range(n)]
    return np.stack(rows)
