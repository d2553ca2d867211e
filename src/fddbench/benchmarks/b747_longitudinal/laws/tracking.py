"""The block that flies a tracking law from its file, and the laws that are shipped."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np

from fddbench.benchmarks.b747_longitudinal.law import Orders
from fddbench.benchmarks.b747_longitudinal.laws.law_file import TrackingLaw, read_law
from fddbench.benchmarks.b747_longitudinal.manoeuvres import Command
from fddbench.benchmarks.b747_longitudinal.plant import ELEVATOR_DEG, STABILISER_DEG, TRIM_POINT, TrimPoint
from fddbench.blocks.block import NO_DRAWS
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import column, product, total
from fddbench.blocks.lookup import Grid, Lookup
from fddbench.flight.atmosphere import GRAVITY_M_S2
from fddbench.flight.b747.aerodynamics import air, coefficients
from fddbench.flight.b747.airframe import DATA
from fddbench.interfaces import Floats
from fddbench.units import DEG_PER_RAD

__all__ = ["Hinf", "Lqi", "Scheduled", "Tracking"]

_SHIPPED = Path(__file__).parents[1] / "data"


@record
class TrackingState:
    """State of the law; of the handover: elevator order before it, its lead, command as it passes, all in deg."""

    law: Rows
    elevator_before_deg: Row
    lead_deg: Row
    command_deg: Row


@record
class TrackingConstants:
    """Trim, and elevator in degrees of the stabiliser: the ratio of their nominal pitching moments there [-]."""

    trim: TrimPoint
    stabiliser_ratio: Row


class Tracking:
    """``u = C x + D y`` about the trim, see `fddbench.benchmarks.b747_longitudinal.laws.law_file.TrackingLaw`.

    While the elevator is declared, its order stays where it was, and what the law orders beyond goes to the stabiliser, ahead
    by the lead of the file; the flight-path command then passes a lag, because the stabiliser is slow.

    A law of one's own is a class in a file beside the campaign::

        class Mine(Tracking):
            law = read_law(Path(__file__).with_name("my_law.yaml"))

    where ``fddbench design my_law.yaml`` makes the numbers from the recipe in the file.

    Attributes
    ----------
    law : TrackingLaw
        Of the class.

    Parameters
    ----------
    sample_s : float
        Sample time [s].
    """

    law: ClassVar[TrackingLaw]
    states: Layout[TrackingState]
    constants = Layout(TrackingConstants(trim=TRIM_POINT, stabiliser_ratio=ROW))
    draws: Draws[Any] = NO_DRAWS

    def __init_subclass__(cls) -> None:
        """A class with a law has as many states as that has, and four for the handover."""
        if "law" in vars(cls):
            rows = TrackingState(law=len(cls.law.A), elevator_before_deg=ROW, lead_deg=ROW, command_deg=ROW)
            cls.states = Layout(rows)

    def __init__(self, sample_s: float) -> None:
        law = self.law
        self.discrete, self.handover = law.discrete(sample_s), law.handover
        self.lead_share, self.command_share = (
            float(1.0 - exp(np.array(-sample_s / lag_s))) for lag_s in (law.handover.lag_s, law.handover.command_lag_s)
        )
        gains = np.concatenate([self.discrete.C, self.discrete.D], axis=2)
        self.grid = Grid(law.dynamic_pressure_pa) if len(law.dynamic_pressure_pa) else None
        self.gains = [[self._gain(gains[:, i, j]) for j in range(gains.shape[2])] for i in range(2)]

    def _gain(self, values: Floats) -> Any:
        """A number, or a table over dynamic pressure."""
        return float(values[0]) if self.grid is None else Lookup(values, self.grid)

    def prepare(self, at: TrimPoint) -> TrackingConstants:
        """Trim of flights, and what the stabiliser does there."""
        found = coefficients(at.alpha_rad, at.v_tas_m_s, air(at.altitude_m))
        return TrackingConstants(trim=at, stabiliser_ratio=found.elevator_moment / DATA["moment"]["stabiliser_per_deg"])

    def start(self, c: TrackingConstants) -> TrackingState:
        """Nothing to correct."""
        return TrackingState(law=0.0, elevator_before_deg=c.trim.elevator_deg, lead_deg=0.0, command_deg=0.0)

    def step(
        self,
        x: TrackingState,
        c: TrackingConstants,
        n: Nothing,
        seen: SimpleNamespace,
        command: Command,
        elevator_declared: Row,
    ) -> tuple[TrackingState, Orders]:
        """State at the next sample, and orders of this one."""
        del n
        declared, way = elevator_declared > 0.0, self.handover
        gamma_deg = np.where(declared, x.command_deg, command.gamma_deg)
        y = _deviations(c.trim, seen, gamma_deg, command.speed_m_s)
        elevator, thrust = self._ordered(x.law, y, seen)
        orders = np.stack([c.trim.elevator_deg + elevator, c.trim.thrust_n + thrust])
        stopped = np.stack(_stopped(orders, c, x.elevator_before_deg, declared))
        beyond = orders[0] - x.elevator_before_deg
        led = way.lead_s / way.lag_s * beyond + (1.0 - way.lead_s / way.lag_s) * x.lead_deg
        moved = product(column(self.discrete.A), x.law) + product(column(self.discrete.B), y)
        after = TrackingState(
            law=moved + product(column(self.discrete.E), stopped - orders),
            elevator_before_deg=np.where(declared, x.elevator_before_deg, stopped[0]),
            lead_deg=np.where(declared, x.lead_deg + self.lead_share * (beyond - x.lead_deg), 0.0),
            command_deg=np.where(
                declared,
                x.command_deg + self.command_share * (command.gamma_deg - x.command_deg),
                command.gamma_deg,
            ),
        )
        trim_deg = c.trim.stabiliser_deg
        return after, Orders(
            elevator_deg=np.where(declared, x.elevator_before_deg, orders[0]),
            stabiliser_deg=np.where(declared, trim_deg + c.stabiliser_ratio * led, trim_deg),
            thrust_n=orders[1],
        )

    def _ordered(self, x: Rows, y: Rows, seen: SimpleNamespace) -> tuple[Row, Row]:
        """Orders minus trim [deg, N], with the gains of the measured dynamic pressure."""
        place = None
        if self.grid is not None:
            speed = seen.v_tas_m_s
            place = self.grid.find(0.5 * air(seen.altitude_m).density_kg_m3 * speed * speed)
        signals = [*x, *y]
        elevator, thrust = (
            total(
                [(gain if place is None else gain(place)) * signal for gain, signal in zip(row, signals, strict=True)]
            )
            for row in self.gains
        )
        return elevator, thrust


def _stopped(orders: Rows, c: TrackingConstants, before_deg: Row, declared: Row) -> tuple[Row, Row]:
    """Orders of elevator [deg] and thrust [N] that can be reached: by the stabiliser, where that has the pitch."""
    low, high = (
        np.where(declared, before_deg + (stop - c.trim.stabiliser_deg) / c.stabiliser_ratio, own)
        for stop, own in zip(STABILISER_DEG, ELEVATOR_DEG, strict=True)
    )
    elevator_deg = np.minimum(np.maximum(orders[0], low), high)
    return elevator_deg, np.minimum(np.maximum(orders[1], 0.0), c.trim.thrust_highest_n)


def _deviations(trim: TrimPoint, seen: SimpleNamespace, gamma_deg: Row, speed_m_s: Row) -> Rows:
    """Inputs of a law, (7, n_cases), see `fddbench.benchmarks.b747_longitudinal.laws.law_file.INPUTS`."""
    path_deg, speed = seen.gamma_deg, seen.v_tas_m_s - trim.v_tas_m_s
    return np.stack(
        [
            gamma_deg - path_deg,
            speed_m_s - speed,
            path_deg,
            seen.acceleration_m_s2 / GRAVITY_M_S2,
            seen.theta_deg - DEG_PER_RAD * trim.alpha_rad,
            seen.q_deg_s,
            speed,
        ]
    )


class Hinf(Tracking):
    """H∞ tracking law of one linear model, that of 7000 m and 241 m/s, Fig. 2."""

    law = read_law(_SHIPPED / "law_hinf.yaml")


class Lqi(Tracking):
    """Linear-quadratic law with integral action for the same point."""

    law = read_law(_SHIPPED / "law_lqi.yaml")


class Scheduled(Tracking):
    """Linear-quadratic laws of points of the envelope, over dynamic pressure."""

    law = read_law(_SHIPPED / "law_scheduled.yaml")
