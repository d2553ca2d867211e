"""What a plant of the yaw-rate benchmark must offer, and what the benchmark watches on every one of them."""

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Row, Rows, record
from fddbench.flight.actuators import Actuators
from fddbench.flight.wind import AirMotion
from fddbench.interfaces import Floats, Loop, Options, Parameter, Prepared, Site

__all__ = ["PLANT_NEEDS", "SITES", "LateralPlant", "Motion", "YawRatePlant"]

PLANT_NEEDS = ("sites", "parameters", "refused_parameters", "manoeuvres", "loop")
"""What a class must have to be a `YawRatePlant`."""

SITES = tuple(
    Site(
        name=f"r{row + 1}",
        signal="r_deg_s",
        row=row,
        unit_name="deg/s",
        # the published figures are percent of a confidential range; 40 deg/s is our choice
        admissible=40.0,
        stops=(-128.0, 128.0),
        # inferred from the published normalised times: one faulty sensor, two or more
        limits_s=(120.0, 0.36),
    )
    for row in range(3)
)
"""Three yaw-rate sensors."""


@record
class Motion:
    """An aircraft at one sample, (n_cases,) each: its lateral motion, what is known of its condition, what it shall do.

    Angles [deg], rates [deg/s], lateral position [m]; speeds, mass, centre of gravity and altitude as measured; whether it
    has left what the model describes (boolean).
    """

    phi_deg: Row
    beta_deg: Row
    p_deg_s: Row
    r_deg_s: Row
    psi_deg: Row
    y_m: Row
    v_tas_measured_m_s: Row
    mass_measured_kg: Row
    x_cg_measured_ratio: Row
    altitude_measured_ft: Row
    v_cas_measured_kt: Row
    bank_command_deg: Row
    departed: Row


class YawRatePlant(Protocol):
    """An aircraft that the benchmark can fly: what there is to choose about it, and the loop that it flies in."""

    about: str
    sites: tuple[Site, ...]
    parameters: tuple[Parameter, ...]
    refused_parameters: Mapping[str, str]
    manoeuvres: Mapping[str, float]

    def loop(self, options: Options) -> Loop:
        """Closed loop for these options; a class method, for campaigns choose classes."""
        ...


class LateralPlant(Protocol):
    """An aircraft that `fddbench.benchmarks.yaw_rate.loop.LateralLoop` can fly; made from ``(sample_s, substeps)``.

    It is a block whose step is fed with the positions of the 13 surfaces [deg] (rudder, four ailerons, eight spoilers), the
    motion of the air and the number of the sample, and gives its `Motion`.
    """

    sites: tuple[Site, ...]
    states: Layout[Any]
    constants: Layout[Any]
    draws: Draws[Any]

    def actuators(self) -> Actuators:
        """Actuators of its 13 surfaces."""
        ...

    def travel(self, c: Any) -> tuple[Rows, Rows]:
        """Lowest and highest positions of the surfaces [deg], (13, n_cases)."""
        ...

    def prepare(self, parameters: Mapping[str, Floats], manoeuvres: Sequence[str]) -> Prepared:
        """Constants of flights; vectorised, may iterate (trim), with the same bits in any company."""
        ...

    def start(self, c: Any) -> Any:
        """State before sample 0."""
        ...

    def step(self, x: Any, c: Any, n: Any, surface_deg: Rows, air: AirMotion, sample: Row) -> tuple[Any, Motion]:
        """State at the next sample, and the motion at this one."""
        ...
