"""The aircraft as data: every number with its unit in its name and what is plausible for a jet transport.

The ranges are ours. They are wide enough for an airliner of another size and narrow enough for the usual slips to fall out:
per degree for per radian, feet for metres, knots for m/s, and a sign.
"""

from collections.abc import Sequence
from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

__all__ = ["Actuation", "Aircraft", "Plausible", "Sloped", "Surface", "Travel"]


class Part(BaseModel):
    """Numbers that belong together; nothing may be missing or unknown."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, defer_build=True)


class Plausible:
    """Marks a number with what is plausible, ends included."""

    def __init__(self, low: float, high: float) -> None:
        self.low, self.high = low, high

    def __call__(self, value: float) -> float:
        """The number; raises ValueError for one outside."""
        if not self.low <= value <= self.high:
            raise ValueError(f"plausible is {self.low:g} to {self.high:g}, got {value:.6g}")
        return value


def _within(low: float, high: float) -> AfterValidator:
    return AfterValidator(Plausible(low, high))


Angle = Annotated[float, _within(-40.0, 40.0)]

Slope = Annotated[float, _within(-15.0, 15.0)]
Share = Annotated[float, _within(0.001, 1.0)]
Power = Annotated[float, _within(0.0, 2.0)]


class Geometry(Part):
    """Reference sizes and arms."""

    wing_area_m2: Annotated[float, _within(60.0, 900.0)]
    span_m: Annotated[float, _within(20.0, 90.0)]
    chord_m: Annotated[float, _within(2.0, 13.0)]
    x_cg_reference_ratio: Annotated[float, _within(0.05, 0.6)]
    thrust_arm_m: Annotated[float, _within(-4.0, 6.0)]
    elevator_arm_m: Annotated[float, _within(1.0, 9.0)]


class Inertia(Part):
    """Moments of inertia at a mass, and how they grow with it."""

    mass_kg: Annotated[float, _within(20e3, 650e3)]
    i_xx_kg_m2: Annotated[float, _within(1e5, 1e8)]
    i_yy_kg_m2: Annotated[float, _within(1e5, 1.5e8)]
    i_zz_kg_m2: Annotated[float, _within(1e5, 2e8)]
    i_xz_kg_m2: Annotated[float, _within(-2e7, 2e7)]
    exponent_xx: Power
    exponent_yy: Power
    exponent_zz: Power


class Lift(Part):
    """Lift coefficient."""

    alpha_zero_deg: Annotated[float, _within(-8.0, -0.2)]
    c_l_alpha: Annotated[float, _within(3.0, 8.0)]
    mach_reference: Annotated[float, _within(0.0, 0.9)]
    compressibility: Annotated[float, _within(0.0, 1.0)]
    mach_held: Annotated[float, _within(0.5, 0.95)]
    c_l_q: Annotated[float, _within(2.0, 15.0)]
    c_l_elevator: Annotated[float, _within(0.1, 0.9)]
    c_l_stabiliser: Annotated[float, _within(0.2, 1.8)]
    stabiliser_zero_deg: Annotated[float, _within(-14.0, 5.0)]


class Pitch(Part):
    """Pitching moment coefficient about the centre of gravity."""

    c_m_0: Annotated[float, _within(-0.3, 0.3)]
    neutral_point_ratio: Annotated[float, _within(0.2, 0.8)]
    neutral_point_per_mach: Annotated[float, _within(-1.0, 1.0)]
    neutral_point_mach: Annotated[float, _within(0.3, 0.95)]
    c_m_q: Annotated[float, _within(-50.0, -5.0)]
    c_m_alpha_dot: Annotated[float, _within(-20.0, 0.0)]
    c_m_elevator: Annotated[float, _within(-3.0, -0.5)]
    c_m_stabiliser: Annotated[float, _within(-6.0, -1.0)]


class Drag(Part):
    """Drag coefficient."""

    c_d_0: Annotated[float, _within(0.008, 0.04)]
    induced: Annotated[float, _within(0.02, 0.09)]
    rise: Annotated[float, _within(0.0, 100.0)]
    rise_mach: Annotated[float, _within(0.5, 0.95)]
    rise_per_lift: Annotated[float, _within(-0.5, 0.5)]
    rise_lift: Annotated[float, _within(0.0, 1.0)]


class Thrust(Part):
    """All engines together."""

    sea_level_n: Annotated[float, _within(80e3, 1.6e6)]
    per_root_mach: Annotated[float, _within(0.0, 0.9)]
    idle_ratio: Annotated[float, _within(0.0, 0.3)]
    lag_s: Annotated[float, _within(0.2, 10.0)]
    spool_ratio: Annotated[float, _within(0.0, 0.5)]
    spool_lag_s: Annotated[float, _within(0.2, 20.0)]


class Reference(Part):
    """Where lateral coefficients have their values."""

    c_l: Annotated[float, _within(0.1, 1.2)]
    mach: Annotated[float, _within(0.1, 0.95)]
    dynamic_pressure_pa: Annotated[float, _within(1e3, 4e4)]


class Slopes(Part):
    """How a coefficient changes with the lift of the wing, Mach number and dynamic pressure, relative to itself."""

    lift: Slope
    mach: Slope
    pressure: Slope


class Sloped(Slopes):
    """A derivative at the reference, and its slopes."""

    value: float


class Surface(Slopes):
    """What a surface does to side force, rolling and yawing moment."""

    c_y: Annotated[float, _within(-1.0, 1.0)]
    c_l: Annotated[float, _within(-0.3, 0.3)]
    c_n: Annotated[float, _within(-0.5, 0.5)]


def _derivative(low: float, high: float) -> AfterValidator:
    """Range of the value of a derivative."""
    test = Plausible(low, high)

    def check(derivative: Sloped) -> Sloped:
        test(derivative.value)
        return derivative

    return AfterValidator(check)


class Lateral(Part):
    """Lateral derivatives in body axes."""

    c_y_beta: Annotated[Sloped, _derivative(-2.5, -0.2)]
    c_y_p: Annotated[Sloped, _derivative(-1.5, 1.5)]
    c_y_r: Annotated[Sloped, _derivative(-0.5, 1.5)]
    c_l_beta: Annotated[Sloped, _derivative(-0.6, -0.02)]
    c_l_p: Annotated[Sloped, _derivative(-1.0, -0.1)]
    c_l_r: Annotated[Sloped, _derivative(0.005, 0.6)]
    c_n_beta: Annotated[Sloped, _derivative(0.01, 0.4)]
    c_n_p: Annotated[Sloped, _derivative(-0.4, 0.2)]
    c_n_r: Annotated[Sloped, _derivative(-0.6, -0.03)]


def _main(field: str, least: float, most: float) -> AfterValidator:
    """Range of the main moment of a surface."""
    test = Plausible(least, most)

    def check(surface: Surface) -> Surface:
        try:
            test(getattr(surface, field))
        except ValueError as error:
            raise ValueError(f"{field}: {error}") from None
        return surface

    return AfterValidator(check)


class Surfaces(Part):
    """Lateral control surfaces; one of each pair."""

    rudder: Annotated[Surface, _main("c_n", -0.4, -0.02)]
    aileron_1: Annotated[Surface, _main("c_l", 0.003, 0.15)]
    aileron_3: Annotated[Surface, _main("c_l", 0.003, 0.15)]
    spoiler: Annotated[Surface, _main("c_l", -0.1, -0.003)]


class Travel(Part):
    """What an actuator can do."""

    low_deg: Angle
    high_deg: Annotated[float, _within(1.0, 60.0)]
    rate_deg_s: Annotated[float, _within(3.0, 200.0)]


class Stabiliser(Part):
    """What the trimmable tailplane can do."""

    low_deg: Angle
    high_deg: Annotated[float, _within(0.2, 15.0)]
    rate_deg_s: Annotated[float, _within(0.1, 3.0)]


class Actuation(Part):
    """Actuators of all surfaces."""

    bandwidth_rad_s: Annotated[float, _within(2.0, 100.0)]
    rudder: Travel
    rudder_full_kt: Annotated[float, _within(80.0, 250.0)]
    rudder_least_kt: Annotated[float, _within(150.0, 400.0)]
    rudder_least_deg: Annotated[float, _within(1.0, 30.0)]
    aileron: Travel
    spoiler: Travel
    elevator: Travel
    stabiliser: Stabiliser


class Limits(Part):
    """Where it may fly."""

    v_mo_kt: Annotated[float, _within(200.0, 450.0)]
    m_mo: Annotated[float, _within(0.5, 0.98)]
    buffet_mach: Annotated[Sequence[float], Field(min_length=2)]
    buffet_c_l: Annotated[Sequence[Annotated[float, _within(0.2, 2.5)]], Field(min_length=2)]

    @model_validator(mode="after")
    def _table(self) -> "Limits":
        mach = list(self.buffet_mach)
        if len(mach) != len(self.buffet_c_l) or mach != sorted(set(mach)):
            raise ValueError(
                f"buffet_mach rises and has as many numbers as buffet_c_l, got {len(mach)} and {len(self.buffet_c_l)}"
            )
        return self


class Aircraft(Part):
    """Everything the equations need, as `data/twin_jet.yaml` has it."""

    about: str
    geometry: Geometry
    inertia: Inertia
    lift: Lift
    pitch: Pitch
    drag: Drag
    thrust: Thrust
    reference: Reference
    lateral: Lateral
    surfaces: Surfaces
    actuators: Actuation
    limits: Limits

    @model_validator(mode="after")
    def _possible(self) -> "Aircraft":
        i = self.inertia
        smallest = min(i.i_xx_kg_m2, i.i_zz_kg_m2)
        if abs(i.i_xz_kg_m2) >= smallest or i.i_xx_kg_m2 + i.i_yy_kg_m2 <= i.i_zz_kg_m2:
            raise ValueError(
                f"inertia: no body has I_xx {i.i_xx_kg_m2:g}, I_yy {i.i_yy_kg_m2:g}, I_zz {i.i_zz_kg_m2:g}, I_xz "
                f"{i.i_xz_kg_m2:g} kg m2; need I_zz < I_xx + I_yy and |I_xz| below the smaller of I_xx and I_zz"
            )
        loading, low, high = i.mass_kg / self.geometry.wing_area_m2, 250.0, 950.0
        if not low <= loading <= high:
            raise ValueError(
                f"inertia.mass_kg / geometry.wing_area_m2: plausible is {low:g} to {high:g} kg/m2, got {loading:g}"
            )
        return self
