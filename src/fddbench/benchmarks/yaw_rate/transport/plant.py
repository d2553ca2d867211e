"""What the plant with six degrees of freedom keeps, and how its surfaces meet the air."""

from typing import Any, Protocol

from fddbench.benchmarks.yaw_rate.transport.gains import Schedule
from fddbench.benchmarks.yaw_rate.transport.law import LawConstants
from fddbench.blocks.layout import ROW, Layout, Row, Rows, record
from fddbench.flight.transport.aerodynamics import Controls
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.equations import Body
from fddbench.flight.transport.motion import Motion
from fddbench.flight.wind import AirMotion
from fddbench.interfaces import Prepared, Site
from fddbench.units import RAD_PER_DEG

__all__ = ["BODY", "PlantConstants", "PlantState", "TransportPlant", "controls_of"]

BODY = Body(**dict.fromkeys(Body.__dataclass_fields__, ROW))
"""Shape of what of an aircraft differs from flight to flight."""


@record
class PlantState:
    """Rows of the rigid body, as `fddbench.flight.transport.equations.State`; heading of the sample before, turns flown [-]."""

    rigid: Rows
    psi_rad: Row
    turns: Row


@record
class PlantConstants:
    """Body, trimmed state, true airspeed, steady wind and the track that it makes of the first heading, north.

    What is measured of the flight, and what the law knows of it.

    `one_altitude` and `one_v_cas` are ``1 + error`` of the measured altitude and airspeed; the error of sideslip is added.
    """

    body: Body
    begun: Rows
    v_tas_m_s: Row
    wind_north_m_s: Row
    wind_east_m_s: Row
    track_rad: Row
    mass_measured_kg: Row
    x_cg_measured_ratio: Row
    one_altitude: Row
    one_v_cas: Row
    beta_error_deg: Row
    law: LawConstants


class TransportPlant(Protocol):
    """A plant that `fddbench.benchmarks.yaw_rate.transport.loop.TransportLoop` flies."""

    sites: tuple[Site, ...]
    aircraft: Aircraft
    gains: Schedule
    states: Layout[Any]
    constants: Layout[Any]

    def prepare(self, parameters: Any, manoeuvres: Any) -> Prepared:
        """Constants of flights."""
        ...

    def start(self, c: Any) -> Any:
        """In trim."""
        ...

    def step(
        self, x: Any, c: Any, n: Any, controls: Controls, moving: AirMotion, thrust_ratio: Row
    ) -> tuple[Any, Motion]:
        """State at the next sample, and the motion at this one."""
        ...


def controls_of(surface_deg: Rows, elevator_deg: Rows, stabiliser_deg: Row) -> Controls:
    """13 lateral surfaces, left and right elevator and the stabiliser [deg] as the air meets them."""
    s = surface_deg
    spoilers = s[5] - s[6] + s[7] - s[8] + s[9] - s[10] + s[11] - s[12]
    return Controls(
        rudder=RAD_PER_DEG * s[0],
        aileron_1=RAD_PER_DEG * (s[1] - s[2]),
        aileron_3=RAD_PER_DEG * (s[3] - s[4]),
        spoiler=RAD_PER_DEG * spoilers,
        elevator=(0.5 * RAD_PER_DEG) * (elevator_deg[0] + elevator_deg[1]),
        elevator_difference=RAD_PER_DEG * (elevator_deg[0] - elevator_deg[1]),
        stabiliser=RAD_PER_DEG * stabiliser_deg,
    )
