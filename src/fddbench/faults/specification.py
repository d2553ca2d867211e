"""What all faults have in common in a campaign: sites, times, mode, correlation, and sizes with explicit units.

The sizes are called ``amplitude``, ``rate``, ``variance`` and ``hold_value`` here. A campaign writes them with the unit of
its benchmark's fault sites, ``amplitude_deg_s`` or plain ``amplitude``: `FaultSpecification.in_unit` is the same kind with
other keys, so a key of another benchmark's unit is an unknown key.
"""

from dataclasses import dataclass, field
from functools import cache
from typing import Annotated, ClassVar, Literal, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

from fddbench.interfaces import FaultUnits

__all__ = ["FaultSpecification", "FaultWave", "Finite", "NonNegative", "one_of"]

Finite = Annotated[float, Field(allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]

_KEYS = {
    "deg/s": {"amplitude": "_deg_s", "hold_value": "_deg_s", "rate": "_deg_s2", "variance": "_deg2_s2"},
    "": {"amplitude": "", "hold_value": "", "rate": "_per_s", "variance": ""},
}
"""What a key carries behind the name of a size, by the unit of the fault sites (`FaultUnits.unit`)."""


def _key(name: str) -> str:
    """Key of a size in the default unit.

    >>> _key("amplitude"), _key("rate"), _key("rate_percent_s")
    ('amplitude_deg_s', 'rate_deg_s2', 'rate_percent_s')
    """
    return name + _KEYS["deg/s"].get(name, "")


@dataclass(frozen=True, kw_only=True)
class FaultWave:
    """The one fault signal: ``keep y + hold y_onset + hold_value + offset + ramp + sine + noise + bits``, clipped.

    All sizes are in the unit of the fault sites.

    Attributes
    ----------
    keep, hold : float
        Share of the healthy and of the frozen signal [-].
    hold_value : float
        What stands in place of the healthy signal; the same on all sites, whatever the correlation.
    offset, ramp_limit, clip : float
        Constant part, where the ramp stops, and where the sum is clipped; infinite for never.
    rate : float
        Slope of the ramp [1/s].
    amplitude, frequency_rad_s, phase_rad, phase_uniform : float
        Sine; its phase at the onset, or 1 to draw it uniformly per case.
    sigma : float
        White noise per sample, one sigma.
    bit, bit_s : float
        Random plus or minus, and how long each lasts.
    """

    keep: float = 1.0
    hold: float = 0.0
    hold_value: float = 0.0
    offset: float = 0.0
    rate: float = 0.0
    ramp_limit: float = field(default=float("inf"))
    clip: float = field(default=float("inf"))
    amplitude: float = 0.0
    frequency_rad_s: float = 0.0
    phase_rad: float = 0.0
    phase_uniform: float = 0.0
    sigma: float = 0.0
    bit: float = 0.0
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
    hold_value, hold_value_percent : float
        With ``replace``: the value the fault signal is added to (0 by default).
    """

    model_config = ConfigDict(extra="forbid", frozen=True, alias_generator=_key)
    about: ClassVar[str] = ""

    kind: str
    mode: Literal["add", "replace"] = "add"
    sites: Annotated[tuple[str, ...], Field(min_length=1), AfterValidator(_distinct)]
    onset_s: NonNegative
    end_s: NonNegative | None = None
    correlation: Literal["identical", "independent", "opposite"] = "identical"
    delay_s: NonNegative = 0.0
    freeze: bool = False
    hold_value: Finite | None = None
    hold_value_percent: Finite | None = None

    @model_validator(mode="after")
    def _consistent(self) -> "FaultSpecification":
        if self.end_s is not None and self.end_s <= self.onset_s:
            raise ValueError(f"end_s must lie after onset_s = {self.onset_s}, got {self.end_s}")
        held = [self.freeze, self.hold_value is not None, self.hold_value_percent is not None]
        if any(held) and self.mode == "add":
            raise ValueError("freeze and hold_value_* need mode: replace")
        if sum(held) > 1:
            raise ValueError(f"give one of freeze, {self.key('hold_value')}, hold_value_percent")
        self.wave(FaultUnits(unit="", admissible=1.0, sensor_range=1.0))
        return self

    @classmethod
    def in_unit(cls, unit: str) -> type[Self]:
        """Return this kind with the keys of a benchmark whose fault sites have the unit "deg/s", or "" for none."""
        return _in_unit(cls, unit)  # type: ignore[return-value]

    @classmethod
    def key(cls, name: str) -> str:
        """Key of a field as a campaign writes it."""
        return cls.model_fields[name].alias or name

    def size(self, name: str, percent: str, units: FaultUnits) -> float:
        """Size given in the unit of the sites or in percent of the admissible range, whichever is given; one must be."""
        share = getattr(self, percent)
        of_range = None if share is None else share / 100.0 * units.admissible
        return one_of(**{percent: of_range, self.key(name): getattr(self, name)})

    def wave(self, units: FaultUnits) -> FaultWave:
        """Signal of this fault in the units of a benchmark; raises ValueError when a size is missing or given twice."""
        raise NotImplementedError

    def base(self, units: FaultUnits) -> dict[str, float]:
        """Wave fields that follow from the mode: what remains of the healthy signal."""
        if self.mode == "add":
            return {}
        if self.freeze:
            return {"keep": 0.0, "hold": 1.0}
        percent = (self.hold_value_percent or 0.0) / 100.0 * units.admissible
        return {"keep": 0.0, "hold_value": percent + (self.hold_value or 0.0)}


@cache
def _in_unit(kind: type[FaultSpecification], unit: str) -> type[FaultSpecification]:
    """Kind with the keys of a unit; always the same class for the same kind."""
    if unit == "deg/s":
        return kind
    config = ConfigDict(alias_generator=lambda name: name + _KEYS[unit].get(name, ""))
    namespace = {"model_config": config, "__module__": kind.__module__, "__doc__": kind.__doc__}
    return type(kind.__name__, (kind,), namespace)
