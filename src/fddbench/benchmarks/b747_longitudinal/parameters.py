"""What differs from flight to flight on the longitudinal benchmark, with the limits a campaign may ask for."""

from collections.abc import Mapping

from fddbench.flight.b747.airframe import DATA
from fddbench.interfaces import Parameter

__all__ = ["PARAMETERS", "REFUSED"]


def _delta(name: str, of: str) -> Parameter:
    return Parameter(
        name=name, about=f"change of the aerodynamic {of}; detectors and laws keep 0", default=0.0, low=-30.0, high=30.0
    )


def _error(name: str, of: str, most: float) -> Parameter:
    return Parameter(name=name, about=f"error of the measured {of}", default=0.0, low=-most, high=most)


_INERTIA, _POINT = DATA["inertia"], DATA["design_point"]

PARAMETERS: tuple[Parameter, ...] = (
    Parameter(name="mass_kg", about="aircraft mass", default=_INERTIA["mass_kg"], low=200e3, high=340e3),
    Parameter(name="x_cg_ratio", about="centre of gravity, share of the mean chord", default=0.25, low=0.10, high=0.36),
    Parameter(name="altitude_m", about="geometric altitude", default=_POINT["altitude_m"], low=1e3, high=11e3),
    Parameter(name="v_tas_m_s", about="true airspeed", default=_POINT["v_tas_m_s"], low=150.0, high=280.0),
    Parameter(
        name="stabiliser_deg",
        about="position of the stabiliser, which stays; the elevator trims",
        default=DATA["stabiliser_deg"],
        low=-6.0,
        high=2.0,
    ),
    _delta("delta_c_l_percent", "lift C_L"),
    _delta("delta_c_d_percent", "drag C_D"),
    _delta("delta_c_m_percent", "pitching moment C_m without the tail surfaces"),
    _delta("delta_c_m_elevator_percent", "pitching moment of the elevator"),
    Parameter(
        name="c_m_alphadot_ratio",
        about="pitching moment per alphadot c / V; twice as much is measured in flight",
        default=DATA["moment"]["alphadot"],
        low=-8.0,
        high=0.0,
    ),
    Parameter(
        name="thrust_lapse_ratio",
        about="relative fall of the thrust at a held lever per relative rise of airspeed",
        default=0.4,
        low=0.0,
        high=2.0,
    ),
    Parameter(
        name="float_ratio",
        about="elevator that floats, per angle of attack",
        default=-0.3,
        low=-1.0,
        high=0.0,
    ),
    _error("alpha_error_deg", "angle of attack [deg]", 2.0),
    _error("q_error_deg_s", "pitch rate [deg/s]", 0.5),
    _error("v_tas_error_percent", "airspeed: measured = true (1 + error)", 10.0),
    _error("theta_error_deg", "pitch angle [deg]", 2.0),
    _error("altitude_error_m", "altitude [m]", 500.0),
    Parameter(name="gust_scale_ratio", about="share of the gust of the chosen wind", default=1.0, low=0.0, high=10.0),
)

REFUSED: Mapping[str, str] = {
    f"delta_c_{axis}_percent": f"a longitudinal model has no {what}; remove it, or fly a plant with 6 degrees of freedom"
    for axis, what in (("y", "side force C_Y"), ("n", "yawing moment C_n"))
}
