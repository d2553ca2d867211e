"""Numbers of the sliding-mode scheme, checked when a design is read."""

from typing import Annotated, ClassVar, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

__all__ = ["SlidingModeGains", "TwistingEntry"]

Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Row4 = Annotated[tuple[Number, ...], Field(min_length=4, max_length=4)]
Positive4 = Annotated[tuple[Positive, ...], Field(min_length=4, max_length=4)]
Matrix5x4 = Annotated[tuple[Row4, ...], Field(min_length=5, max_length=5)]


class TwistingEntry(BaseModel):
    """Gains of the super-twisting injection.

    Attributes
    ----------
    k1, k2 : numbers, one per output
        Of the root and of the integral.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    k1: Annotated[tuple[Positive, ...], Field(min_length=1)]
    k2: Annotated[tuple[Positive, ...], Field(min_length=1)]


class SlidingModeGains(BaseModel):
    """Gains of observer and logic, in the order [phi, V_y, p, z_f] of the outputs and [phi, V_y, p, r, z_f] of the states.

    Attributes
    ----------
    input_lag_s, output_lag_s : float
        First-order lags on all observer inputs and on the reconstruction [s].
    filter_pole_1_s : float
        Pole A_f of the filter on the voted yaw rate [1/s], eq (6).
    linear_gain : five 5 x 4 matrices
        Gl0 ... Gl4 of eq (36), affine in rho.
    l_row : 4 numbers
        L of eq (20), refined so that it reproduces the printed linear gain.
    gn_convention : {"published", "equation_19"}
        Row of the yaw rate in Gn: -2 L as printed, or -L as eq (19) gives.
    error_pole_1_s : 4 numbers
        Diagonal of the stable matrix A22s [1/s]; P_o follows from the Lyapunov equation (14).
    injection : {"sigmoid", "unit_vector", "super_twisting"}
        Eq (37); eq (13), solved without chattering; or the continuous algorithm of second order.
    k, delta : 4 numbers, float
        Modulation gain K and smoothing of eq (37).
    twisting : TwistingEntry or None
        Gains of super_twisting in place of k and delta.
    w : 4 numbers
        W of eq (21); zeros switch the observer's verdict off.
    newton_steps : int
        Iterations of the semi-implicit injection; a fixed number.
    threshold_floor_deg_s, threshold_pole_1_s, threshold_gain : float
        Adaptive threshold, eq (38), and its floor (eq (38) alone is about 0 in cruise).
    roll_surface_scale, rudder_scale : float
        Divisors of aileron and spoiler, and of rudder deflections [deg] in eq (38).
    flag_threshold_deg_s : float
        Distance from the voted signal that raises the flag [deg/s].
    confirm_one_s, confirm_two_s : float
        Confirmation times for one and for two faulty sensors [s].
    energy_window_samples, energy_count : int
        Energy monitor: so many of the last samples must exceed the limit; at most 52 samples.
    energy_limit_deg_s2 : float
        Limit of the numerical derivative [deg/s^2]; belongs to the sample time of the design.
    record_observer : bool
        Flights that are flown again show the inside of the observer too: output error, injection, rho.
    """

    THRESHOLDS: ClassVar = {
        "threshold_floor_deg_s": "up", "threshold_gain": "up", "flag_threshold_deg_s": "up", "energy_limit_deg_s2": "up",
    }  # fmt: skip
    model_config = ConfigDict(extra="forbid", frozen=True)

    input_lag_s: Positive
    output_lag_s: Positive
    filter_pole_1_s: Positive
    linear_gain: Annotated[tuple[Matrix5x4, ...], Field(min_length=5, max_length=5)]
    l_row: Row4
    gn_convention: Literal["published", "equation_19"]
    error_pole_1_s: Annotated[
        tuple[Annotated[float, Field(lt=0.0, allow_inf_nan=False)], ...], Field(min_length=4, max_length=4)
    ]
    injection: Literal["sigmoid", "unit_vector", "super_twisting"] = "sigmoid"
    k: Positive4
    delta: Positive
    twisting: TwistingEntry | None = None
    w: Row4
    newton_steps: Annotated[int, Field(ge=1, le=20)] = 3
    threshold_floor_deg_s: Positive
    threshold_pole_1_s: Positive
    threshold_gain: NonNegative
    roll_surface_scale: Positive
    rudder_scale: Positive
    flag_threshold_deg_s: Positive
    confirm_one_s: Positive
    confirm_two_s: Positive
    energy_window_samples: Annotated[int, Field(ge=2, le=52)]
    energy_count: Annotated[int, Field(ge=1, le=52)]
    energy_limit_deg_s2: Positive
    record_observer: bool = False

    @model_validator(mode="after")
    def _twisting_has_gains(self) -> Self:
        if (self.injection == "super_twisting") != (self.twisting is not None):
            raise ValueError("injection: super_twisting needs `twisting: {k1, k2}`, and nothing else looks at it")
        if self.twisting is not None and {len(self.twisting.k1), len(self.twisting.k2)} != {4}:
            raise ValueError("twisting: k1 and k2 have 4 numbers, for phi, V_y, p and z_f")
        return self
