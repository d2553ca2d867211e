"""What differs from flight to flight on the yaw-rate benchmark, with the limits a campaign may ask for."""

from collections.abc import Mapping

from fddbench.interfaces import Parameter

__all__ = ["PARAMETERS", "REFUSED", "gust_rotation"]


def _error(name: str, of: str) -> Parameter:
    return Parameter(
        name=name, about=f"error of the measured {of}: measured = true (1 + error)", default=0.0, low=-30.0, high=30.0
    )


def _delta(name: str, of: str) -> Parameter:
    return Parameter(
        name=name, about=f"change of the aerodynamic {of}; detectors and law keep 0", default=0.0, low=-50.0, high=50.0
    )


def gust_rotation(default: float) -> Parameter:
    """How much of the rotation of the gust an aircraft feels; a lateral model felt none of it at first."""
    return Parameter(
        name="gust_rotation_ratio",
        about="share of the rotations of the gust (gradients over span and length, p_g and r_g) that the aircraft feels",
        default=default,
        low=0.0,
        high=10.0,
    )


PARAMETERS: tuple[Parameter, ...] = (
    Parameter(name="mass_kg", about="aircraft mass", default=200e3, low=100e3, high=260e3),
    Parameter(name="x_cg_ratio", about="centre of gravity, share of the mean chord", default=0.30, low=0.10, high=0.50),
    Parameter(name="altitude_ft", about="pressure altitude", default=20e3, low=0.0, high=45e3),
    Parameter(name="v_cas_kt", about="calibrated airspeed", default=290.0, low=120.0, high=400.0),
    _delta("delta_c_y_percent", "side force C_Y"),
    _delta("delta_c_l_percent", "rolling moment C_l"),
    _delta("delta_c_n_percent", "yawing moment C_n"),
    _error("mass_error_percent", "mass"),
    _error("x_cg_error_percent", "centre of gravity"),
    _error("altitude_error_percent", "altitude"),
    _error("v_cas_error_percent", "calibrated airspeed"),
    Parameter(
        name="beta_error_deg",
        about="error of the measured sideslip: measured = true + error",
        default=0.0,
        low=-5.0,
        high=5.0,
    ),
    Parameter(name="gust_scale_ratio", about="share of the gust of the chosen wind", default=1.0, low=0.0, high=10.0),
    gust_rotation(0.0),
    Parameter(
        name="gust_yaw_moment_percent",
        about="by how much the yawing moment of the gust is larger than the model of its sideslip says",
        default=0.0,
        low=-100.0,
        high=100.0,
    ),
)

REFUSED: Mapping[str, str] = {
    f"delta_c_{axis}_percent": f"a lateral model has no {what}; remove it, or fly a plant with 6 degrees of freedom"
    for axis, what in (("x", "axial force C_X"), ("z", "normal force C_Z"), ("m", "pitching moment C_m"))
}
