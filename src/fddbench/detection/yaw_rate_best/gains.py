"""Numbers of the yaw-rate monitor, checked when a design is read."""

from collections.abc import Mapping
from typing import Annotated, ClassVar, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

__all__ = ["SIDE_ROWS", "YAW_ROWS", "LateralTable", "YawRateBestGains"]

Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Four = Annotated[tuple[Number, ...], Field(min_length=4, max_length=4)]
FourPositive = Annotated[tuple[Positive, ...], Field(min_length=4, max_length=4)]
Powers = Annotated[tuple[Annotated[int, Field(ge=0, le=3)], ...], Field(min_length=4, max_length=4)]
Rows = tuple[tuple[Number, ...], ...]

YAW_ROWS = ("v", "p", "r", "rudder", "aileron_1", "aileron_3", "spoiler")
"""What the yaw acceleration is made of: side velocity through the air, rates, surfaces (1 less 2, 3 less 4, odd less even)."""
SIDE_ROWS = ("phi", *YAW_ROWS)
"""What the sideward acceleration is made of."""


class LateralTable(BaseModel):
    """Coefficients of yaw and sideward acceleration over the flight condition, as polynomials.

    A coefficient is the sum of its row times the monomials ``x1^a x2^b x3^c x4^d`` of ``x = (value - centre) / half_width`` of
    mass [kg], centre of gravity [-], altitude [ft] and calibrated airspeed [kt].

    Attributes
    ----------
    centre, half_width : 4 numbers
        In the units of the parameters.
    powers : rows of 4 whole numbers
        a, b, c, d of every monomial; the first is the constant, (0, 0, 0, 0).
    yaw : 7 rows
        By `YAW_ROWS`, in 1/(m s), 1/s, 1/s, and deg/s^2 per deg.
    side : 8 rows
        By `SIDE_ROWS`, in m/s^2 and 1/s, m/s, m/s, and deg m/s^2 per deg (of rad).
    bank_cubic : float
        1/6 where gravity acts with the sine of the bank angle, 0 where the model is linear.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    centre: Four
    half_width: FourPositive
    powers: Annotated[tuple[Powers, ...], Field(min_length=1)]
    yaw: Annotated[Rows, Field(min_length=7, max_length=7)]
    side: Annotated[Rows, Field(min_length=8, max_length=8)]
    bank_cubic: Annotated[float, Field(ge=0.0, le=0.2)] = 0.0

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        n = len(self.powers)
        wrong = [
            f"{name} row {i + 1} has {len(row)} numbers"
            for name in ("yaw", "side")
            for i, row in enumerate(getattr(self, name))
            if len(row) != n
        ]
        if wrong:
            raise ValueError(f"{', '.join(wrong)}; each needs {n}, one for each row of powers")
        if any(self.powers[0]):
            raise ValueError(f"the first row of powers must be [0, 0, 0, 0], the constant, got {list(self.powers[0])}")
        return self


class YawRateBestGains(BaseModel):
    """Model, filters and decision.

    Attributes
    ----------
    sample_s : float
        Clock that the gains are for [s].
    table : LateralTable
        The aircraft.
    beta_lag_s : float
        Time constant of the sideslip vane that is allowed for [s].
    yaw_gain : 2 numbers
        Kalman gains of yaw rate [-] and unknown yaw acceleration [1/s] on what the sensor differs from its prediction.
    slip_gain : 3 numbers
        Of path angle [-], gust angle [-] and unknown turn rate [1/s] on what the vane differs.
    keeps : 3 numbers
        Share of unknown yaw acceleration, gust angle and unknown turn rate that is left after a sample [-].
    smooth_s : float
        Mean of the innovations [s].
    floor_deg_s, floor_deg : float
        Least innovation of yaw rate and of sideslip that the model is trusted to [deg/s, deg].
    level_ratio : 2 numbers
        How much of the level of the innovations is added to the squared floor [-]: larger trusts rough air less.
    level_s : float
        Mean of that level [s].
    most : float
        Largest normalised square that one sample may add [-].
    differ_deg_s, differ_per_roll : float
        Distance between sensors at which evidence is gathered [deg/s], and its part per roll rate [-].
    differ_s : float
        Mean of the distances [s].
    offset_s, offset_deg_s : float
        Time constant at which offsets between healthy sensors are learned [s], and how large they may be [deg/s].
    rest_s : float
        How long sensors must agree again before evidence is forgotten [s].
    memory_s : float
        Time constant at which evidence is forgotten while sensors differ [s].
    evidence_one, evidence_two : float
        Evidence that declares a sensor, alone or as one of two [-].
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    THRESHOLDS: ClassVar[Mapping[str, str]] = {"differ_deg_s": "up", "evidence_one": "up", "evidence_two": "up"}

    sample_s: Positive
    table: LateralTable
    beta_lag_s: NonNegative
    yaw_gain: Annotated[tuple[Number, ...], Field(min_length=2, max_length=2)]
    slip_gain: Annotated[tuple[Number, ...], Field(min_length=3, max_length=3)]
    keeps: Annotated[tuple[Annotated[float, Field(ge=0.0, le=1.0)], ...], Field(min_length=3, max_length=3)]
    smooth_s: Positive
    floor_deg_s: Positive
    floor_deg: Positive
    level_ratio: Annotated[tuple[NonNegative, ...], Field(min_length=2, max_length=2)]
    level_s: Positive
    most: Positive
    differ_deg_s: Positive
    differ_per_roll: NonNegative
    differ_s: Positive
    offset_s: Positive
    offset_deg_s: NonNegative
    rest_s: Positive
    memory_s: Positive
    evidence_one: Positive
    evidence_two: Positive
