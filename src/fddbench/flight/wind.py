"""What a wind is: a block that says how the air moves at the aircraft, from what the aircraft is when it meets it."""

from dataclasses import dataclass, fields, replace
from typing import Any, Protocol

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Row, Rows, record

__all__ = ["AirMotion", "CalmAir", "Encounter", "Wind", "rotating", "still"]


@record
class AirMotion:
    """Motion of the air at the aircraft, in body axes (x ahead, y to the right, z down), (n_cases,) each.

    Velocity [m/s] and rotation [rad/s] of the air itself, so an aircraft flies with u - u_g, ..., r - r_g relative to it. A
    gradient of the gust is a rotation: ``p_g = dw/dy, q_g = -dw/dx, r_g = dv/dx``.
    """

    u_m_s: Row
    v_m_s: Row
    w_m_s: Row
    p_rad_s: Row
    q_rad_s: Row
    r_rad_s: Row


def still(like: Row, **moving: Row) -> AirMotion:
    """Air that moves in these components only; `like` says of what shape the others are, which nobody else knows.

    >>> still(np.zeros(2), w_m_s=np.array([1.0, 2.0])).w_m_s
    array([1., 2.])
    """
    zero = np.zeros_like(like)
    return AirMotion(**{**dict.fromkeys((field.name for field in fields(AirMotion)), zero), **moving})


def rotating(air: AirMotion, share: Row) -> AirMotion:
    """The same air with so much of its rotation."""
    return replace(air, p_rad_s=share * air.p_rad_s, q_rad_s=share * air.q_rad_s, r_rad_s=share * air.r_rad_s)


@dataclass(frozen=True, kw_only=True, eq=False)
class Encounter:
    """What an aircraft is when it meets the air, (n_cases,) rows or numbers; a wind takes what it needs.

    Attributes
    ----------
    v_tas_m_s : row
        True airspeed at which the frozen field is crossed [m/s]: that of the trim, for the whole flight.
    scale_ratio : row
        Share of the gust of the chosen wind [-].
    altitude_m : row
        Altitude [m].
    span_m : row
        Wing span, which smooths the rotations [m].
    gradient_m : row
        Distance from the beginning of a discrete gust to its peak [m].
    """

    v_tas_m_s: Row
    scale_ratio: Row = 1.0
    altitude_m: Row = 0.0
    span_m: Row = 60.0
    gradient_m: Row = 107.0

    def spread(self) -> "Encounter":
        """The same with every number as a row as long as that of the airspeed."""
        shape = np.shape(self.v_tas_m_s)
        return Encounter(**{field.name: np.broadcast_to(getattr(self, field.name), shape) for field in fields(self)})


class Wind(Protocol):
    """A wind as benchmarks offer it: an instance holds its numbers, a flight its constants.

    Attributes
    ----------
    before : Draws
        What is random before the first sample; a loop names it in its own `before`.
    """

    states: Layout[Any]
    constants: Layout[Any]
    draws: Draws[Any]
    before: Draws[Any]

    def prepare(self, normals: Any, meets: Encounter, sample_s: float) -> Any:
        """Constants of flights, with the same bits in any company; `normals` as `before` names them."""
        ...

    def start(self, c: Any) -> Any:
        """State before sample 0."""
        ...

    def step(self, x: Any, c: Any, n: Any, sample: Row, like: Row) -> tuple[Any, AirMotion]:
        """State at the next sample, and the motion of the air at this one; `like` is any row of the flights."""
        ...


class CalmAir:
    """No gust: a block without states, constants and draws."""

    states: Layout[Any] = NOTHING
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS
    before: Draws[Any] = NO_DRAWS

    def prepare(self, normals: Rows, meets: Encounter, sample_s: float) -> Nothing:
        """No constants."""
        del normals, meets, sample_s
        return Nothing()

    def start(self, c: Nothing) -> Nothing:
        """No state."""
        return c

    def step(self, x: Nothing, c: Nothing, n: Nothing, sample: Row, like: Row) -> tuple[Nothing, AirMotion]:
        """Air at rest."""
        del c, n, sample
        return x, still(like)
