"""What all faults have in common in a campaign: sites, times, mode, correlation, and sizes with explicit units."""

from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

__all__ = ["FaultSpecification", "FaultWave", "Finite", "SensorUnits", "one_of"]

Finite = Annotated[float, Field(allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]


@dataclass(frozen=True, kw_only=True)
class SensorUnits:
    """Ranges of the faulty signal: percent is of `admissible_deg_s`, a runaway stops at `sensor_range_deg_s` [deg/s]."""

    admissible_deg_s: float
    sensor_range_deg_s: float


@dataclass(frozen=True, kw_only=True)
class FaultWave:
    """The one fault signal: ``keep y + hold y_onset + hold_value + offset + ramp + sine + noise + bits``, clipped.

    Attributes
    ----------
    keep, hold : float
        Share of the healthy and of the frozen signal [-].
    hold_value_deg_s : float
        What stands in place of the healthy signal [deg/s]; the same on all sites, whatever the correlation.
    offset_deg_s, ramp_limit_deg_s, clip_deg_s : float
        Constant part, where the ramp stops, and where the sum is clipped [deg/s]; infinite for never.
    rate_deg_s2 : float
        Slope of the ramp [deg/s^2].
    amplitude_deg_s, frequency_rad_s, phase_rad, phase_uniform : float
        Sine; its phase at the onset, or 1 to draw it uniformly per case.
    sigma_deg_s : float
        White noise per sample, one sigma [deg/s].
    bit_deg_s, bit_s : float
        Random plus or minus, and how long each lasts.
    """

    keep: float = 1.0
    hold: float = 0.0
    hold_value_deg_s: float = 0.0
    offset_deg_s: float = 0.0
    rate_deg_s2: float = 0.0
    ramp_limit_deg_s: float = field(default=float("inf"))
    clip_deg_s: float = field(default=float("inf"))
    amplitude_deg_s: float = 0.0
    frequency_rad_s: float = 0.0
    phase_rad: float = 0.0
    phase_uniform: float = 0.0
    sigma_deg_s: float = 0.0
    bit_deg_s: float = 0.0
    bit_s: float = 1.0


def one_of(**options: float | None) -> float:
    """Value of the only option that is given.

    Raises
    ------
    ValueError
        None or several are given; the message lists the keys.
    """
    given = [name for name, value in options.items() if value is not None]
    if len(given) != 1:
        raise ValueError(f"need exactly one of {' | '.join(options)}, got {', '.join(given) or 'none'}")
    value = options[given[0]]
    assert value is not None
    return value


def _distinct(sites: tuple[str, ...]) -> tuple[str, ...]:
    if len(set(sites)) < len(sites):
        raise ValueError("a site is named twice; name each faulty sensor once")
    return sites


class FaultSpecification(BaseModel):
    """A fault as a campaign writes it; each kind adds its sizes and says what wave they make.

    Attributes
    ----------
    mode : {"add", "replace"}
        Added to the healthy signal (the published cases), or put in its place.
    sites : tuple of str
        Faulty sensors, by the names of the benchmark.
    onset_s, end_s : float, float or None
        First faulty sample, and first healthy one again (None: never) [s].
    correlation : {"identical", "independent", "opposite"}
        One signal on all sites (the published two-sensor cases), random parts drawn per site, or alternating sign.
    delay_s : float
        Later onset of the second site, twice that for the third [s].
    freeze : bool
        With ``replace``: the signal stands at its last healthy value.
    hold_value_deg_s, hold_value_percent : float
        With ``replace``: the value the fault signal is added to (0 by default).
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    about: ClassVar[str] = ""

    kind: str
    mode: Literal["add", "replace"] = "add"
    sites: Annotated[tuple[str, ...], Field(min_length=1), AfterValidator(_distinct)]
    onset_s: NonNegative
    end_s: NonNegative | None = None
    correlation: Literal["identical", "independent", "opposite"] = "identical"
    delay_s: NonNegative = 0.0
    freeze: bool = False
    hold_value_deg_s: Finite | None = None
    hold_value_percent: Finite | None = None

    @model_validator(mode="after")
    def _consistent(self) -> "FaultSpecification":
        if self.end_s is not None and self.end_s <= self.onset_s:
            raise ValueError(f"end_s must lie after onset_s = {self.onset_s}, got {self.end_s}")
        held = [self.freeze, self.hold_value_deg_s is not None, self.hold_value_percent is not None]
        if any(held) and self.mode == "add":
            raise ValueError("freeze and hold_value_* need mode: replace")
        if sum(held) > 1:
            raise ValueError("give one of freeze, hold_value_deg_s, hold_value_percent")
        self.wave(SensorUnits(admissible_deg_s=1.0, sensor_range_deg_s=1.0))
        return self

    def wave(self, units: SensorUnits) -> FaultWave:
        """Signal of this fault in the units of a benchmark; raises ValueError when a size is missing or given twice."""
        raise NotImplementedError

    def base(self, units: SensorUnits) -> dict[str, float]:
        """Wave fields that follow from the mode: what remains of the healthy signal."""
        if self.mode == "add":
            return {}
        if self.freeze:
            return {"keep": 0.0, "hold": 1.0}
        percent = (self.hold_value_percent or 0.0) / 100.0 * units.admissible_deg_s
        return {"keep": 0.0, "hold_value_deg_s": percent + (self.hold_value_deg_s or 0.0)}
