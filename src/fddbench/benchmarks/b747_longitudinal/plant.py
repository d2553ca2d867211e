"""What a plant of the longitudinal benchmark must offer, and what the benchmark watches on every one of them."""

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Row, Rows, record
from fddbench.flight.wind import AirMotion
from fddbench.interfaces import Floats, Parameter, Prepared, Site

__all__ = [
    "ELEVATOR_DEG",
    "PLANT_NEEDS",
    "SITES",
    "STABILISER_DEG",
    "TRIM_POINT",
    "LongitudinalPlant",
    "Motion",
    "TrimPoint",
]

PLANT_NEEDS = (
    *("sites", "parameters", "refused_parameters", "manoeuvres", "states", "constants", "draws"),
    *("prepare", "trimmed", "start", "motion", "step"),
)
"""What a class must have to be a `LongitudinalPlant`."""

ELEVATOR_DEG, STABILISER_DEG = (-23.0, 17.0), (-12.0, 3.0)
"""Travel, positive trailing edge down; stabiliser positive leading edge up. As flown by the type."""
_THRUST_N = (0.0, 230e3)

SITES = (
    Site(
        name="elevator",
        signal="elevator_deg",
        unit_name="deg",
        admissible=40.0,
        kind="actuator",
        stops=ELEVATOR_DEG,
        floats=True,
        limits_s=(10.0,),
    ),
    # of one engine; all four fail together, as in the paper. Percent is of its rating.
    Site(
        name="thrust",
        signal="thrust_n",
        unit_name="N",
        admissible=200e3,
        kind="actuator",
        stops=_THRUST_N,
        limits_s=(20.0,),
    ),
)
"""Elevator (four segments that move and fail together) and thrust per engine.

Time limits are our choice: 10 s for a surface, well inside the 15 s in which the flight path follows a command, and 20 s for
an engine with a lag of 2 s.
"""


@record
class TrimPoint:
    """Steady level flight that a flight begins in: condition, angle of attack, inputs, and the most one engine gives."""

    altitude_m: Row
    v_tas_m_s: Row
    alpha_rad: Row
    elevator_deg: Row
    stabiliser_deg: Row
    thrust_n: Row
    thrust_highest_n: Row


TRIM_POINT = TrimPoint(
    altitude_m=ROW, v_tas_m_s=ROW, alpha_rad=ROW, elevator_deg=ROW, stabiliser_deg=ROW, thrust_n=ROW, thrust_highest_n=ROW
)  # fmt: skip
"""A row each."""


@record
class Motion:
    """An aircraft at one sample, (n_cases,) each.

    Angle of attack [deg] and airspeed [m/s] through the air; pitch rate [deg/s], pitch angle [deg], altitude [m] and
    flight-path angle [deg] over ground; whether it has left what the model describes (boolean).
    """

    alpha_deg: Row
    q_deg_s: Row
    v_tas_m_s: Row
    theta_deg: Row
    altitude_m: Row
    gamma_deg: Row
    departed: Row


class LongitudinalPlant(Protocol):
    """An aircraft that the loop of the benchmark can fly; a class made from ``(sample_s, substeps)``.

    Its record of constants has `trim`, a `TrimPoint`.
    """

    about: str
    sites: tuple[Site, ...]
    parameters: tuple[Parameter, ...]
    refused_parameters: Mapping[str, str]
    manoeuvres: Mapping[str, float]
    states: Layout[Any]
    constants: Layout[Any]
    draws: Draws[Any]

    def prepare(self, parameters: Mapping[str, Floats], manoeuvres: Sequence[str]) -> Prepared:
        """Constants of flights; vectorised, may iterate (trim), with the same bits in any company."""
        ...

    def trimmed(self, parameters: Mapping[str, Floats]) -> TrimPoint:
        """Trim of flights with these parameters, rows of (n_cases,)."""
        ...

    def start(self, c: Any) -> Any:
        """State before sample 0: the trim."""
        ...

    def motion(self, x: Any, c: Any, air: AirMotion) -> Motion:
        """What there is to measure and to show of this sample."""
        ...

    def step(self, x: Any, c: Any, n: Any, inputs: Rows, air: AirMotion) -> tuple[Any, Row]:
        """State at the next sample, and the acceleration along the path at this one [m/s^2].

        `inputs` are elevator and stabiliser [deg] and thrust per engine [N], (3, n_cases), as the air feels them: faults
        included. They and the air's motion are held over the sample.
        """
        ...
