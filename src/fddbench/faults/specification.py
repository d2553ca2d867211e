"""What all faults have in common in a campaign: sites, times, mode, correlation, and sizes with explicit units.

The sizes are called ``amplitude``, ``rate``, ``variance`` and ``hold_value`` here. A campaign writes them with the unit of
its sites, ``amplitude_deg_s`` or plain ``amplitude``: `FaultSpecification.in_unit` is the same kind with other keys, so a
key of another unit is an unknown key.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

from fddbench.errors import FddbenchError
from fddbench.faults.key_rules import KeyRule, at_most_one, exactly_one, positive, where
from fddbench.faults.profile import Profile, ProfileBlock
from fddbench.faults.timing import misfits
from fddbench.faults.varied import Number, Varied
from fddbench.interfaces import FaultBlock, Floats, Site
from fddbench.units import UNITS, unit

__all__ = ["FaultSpecification", "Finite", "NonNegative", "Positive", "Time", "WithAmplitude", "one_of"]

# typed Any because in flight each is a number or an (n_cases,) array, and as written it may be `Varied`
Finite = Annotated[Any, Number()]
NonNegative = Annotated[Any, Number(ge=0.0)]
Positive = Annotated[Any, Number(gt=0.0)]
Time = Annotated[Any, Number(ge=0.0, time=True)]

_PERCENT = {"rate": "rate_percent_s"}
"""Keys of sizes in percent that are not called ``<size>_percent``."""
_ANY_SITE = Site(name="any", signal="any", unit_name="", admissible=1.0, stops=(-1.0, 1.0))


def one_of(**options: Any) -> Any:
    """Value of the only option that is given.

    Raises
    ------
    ValueError
        None or several are given; the message lists the keys.
    """
    given = [name for name, value in options.items() if value is not None]
    if len(given) != 1:
        raise ValueError(f"need exactly one of {' | '.join(options)}, got {', '.join(given) or 'none'}")
    return options[given[0]]


def _distinct(sites: tuple[str, ...]) -> tuple[str, ...]:
    if len(set(sites)) < len(sites):
        raise ValueError("a site is named twice; name each faulty sensor once")
    return sites


class FaultSpecification(BaseModel):
    """A fault as a campaign writes it; each kind adds its sizes and says what they do to the signal of a site.

    A kind either has a `profile` (what is added to the signal), or a `block` of its own. Any number may be `Varied`; what
    flies is a copy with numbers, or (n_cases,) arrays of them, see `flown`.

    Attributes
    ----------
    mode : {"add", "replace"}
        Added to the healthy signal (the published cases), or put in its place.
    sites : tuple of str
        Faulty sites, by the names of the benchmark.
    onset_s, end_s : float, float or None
        First faulty sample, and first healthy one again (None: never) [s].
    correlation : {"identical", "independent", "opposite"}
        One signal on all sites (the published two-sensor cases), random parts drawn per site, or alternating sign.
    delay_s : float
        Later onset of the second site, twice that for the third [s].
    freeze : bool
        With ``replace``: the signal stands at its last reading.
    hold_value, hold_value_percent : float
        With ``replace``: the value the fault signal is added to (0 by default).
    """

    model_config = ConfigDict(extra="forbid", frozen=True, alias_generator=UNITS["deg/s"].key)
    about: ClassVar[str] = ""
    random: ClassVar[bool] = False
    """Whether the kind draws a normal number at every sample."""
    profile: ClassVar[type[Profile] | None] = None
    """What is added to the signal, for kinds that need no block of their own."""
    lengths: ClassVar[tuple[str, ...]] = ()
    """Keys of times besides those that all faults have, which last at least a sample."""
    files: ClassVar[tuple[str, ...]] = ()
    """Keys that name files beside the campaign; `with_files` is given what they hold."""
    unit_name: ClassVar[str] = "deg/s"
    """Unit of the sites in which its sizes are written."""

    kind: str
    mode: Literal["add", "replace"] = "add"
    sites: Annotated[tuple[str, ...], Field(min_length=1), AfterValidator(_distinct)]
    onset_s: Time
    end_s: Time | None = None
    correlation: Literal["identical", "independent", "opposite"] = "identical"
    delay_s: Time = 0.0
    freeze: bool = False
    hold_value: Finite | None = None
    hold_value_percent: Finite | None = None

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        plain = not (isinstance(self.end_s, Varied) or isinstance(self.onset_s, Varied))
        if plain and self.end_s is not None and self.end_s <= self.onset_s:
            raise ValueError(f"end_s must lie after onset_s = {self.onset_s}, got {self.end_s}")
        held = [self.freeze, self.hold_value is not None, self.hold_value_percent is not None]
        if any(held) and self.mode == "add":
            raise ValueError("freeze and hold_value_* need mode: replace")
        if sum(held) > 1:
            raise ValueError(f"give one of freeze, {self.key('hold_value')}, hold_value_percent")
        self.flown({name: value.example for name, value in self.varied.items()}).numbers(_ANY_SITE, np.full(1, 0.5))
        return self

    @classmethod
    def in_unit(cls, name: str) -> type[Self]:
        """Return this kind with the keys of sites in a unit, e.g. "deg/s", or "" for plain numbers.

        Raises
        ------
        FddbenchError
            `fddbench.units` has no such unit.
        """
        return _in_unit(cls, name)  # type: ignore[return-value]

    @classmethod
    def key_rules(cls) -> Iterator[KeyRule]:
        """What JSON Schema can say besides of its keys, for editors; a kind adds what its validators refuse."""
        held = at_most_one(cls.key("hold_value"), "hold_value_percent")
        none = {key: {"type": "null"} for key in (cls.key("hold_value"), "hold_value_percent")}
        frozen = where("freeze", True, {"properties": none})
        if cls.model_fields["mode"].default == "add":
            yield where(
                "mode", "replace", {"allOf": [held, frozen]}, {"properties": {"freeze": {"const": False}, **none}}
            )
        if cls.lengths:
            yield positive(*cls.lengths)

    @property
    def times(self) -> tuple[str, ...]:
        """Fields that are times on the clock."""
        return ("onset_s", "end_s", "delay_s", *self.lengths)

    @property
    def varied(self) -> dict[str, Varied]:
        """What differs from flight to flight by the names of its fields, in the alphabetical order of the keys."""
        found = {name: getattr(self, name) for name in sorted(type(self).model_fields, key=self.key)}
        return {name: value for name, value in found.items() if isinstance(value, Varied)}

    def flown(self, values: Mapping[str, Any]) -> Self:
        """Copy with numbers or (n_cases,) arrays in place of what varies, by the names of the fields."""
        return self.model_copy(update=dict(values)) if values else self

    def with_files(self, contents: Mapping[str, bytes]) -> Self:
        """Copy that has read its files, by the keys that name them; a kind that has any brings its own.

        Raises
        ------
        FddbenchError
            With what is wrong in a file.
        """
        del contents
        return self

    def unfit(self, sample_s: float) -> Iterator[tuple[str, str]]:
        """Key and message of every number that a clock of `sample_s` cannot show; a kind may add its own."""
        for key in ("onset_s", "end_s", "delay_s"):
            yield from ((key, f"{key} {wrong}") for wrong in misfits(getattr(self, key), sample_s))
        for key in self.lengths:
            unsaid = "" if key in self.model_fields_set else f". It is the default of {self.kind}; say what you mean"
            yield from ((key, f"{key} {wrong}{unsaid}") for wrong in misfits(getattr(self, key), sample_s, least=1))

    def unfit_on(self, site: Site) -> str:
        """Why it cannot act on a site, in words that follow its name; "": it can. A kind may add its own."""
        del site
        return ""

    @classmethod
    def key(cls, name: str) -> str:
        """Key of a field as a campaign writes it."""
        return cls.model_fields[name].alias or name

    def size(self, name: str, site: Site) -> Any:
        """Size in the unit of a site, given so or in percent of its admissible range; one of the two must be given."""
        percent = _PERCENT.get(name, f"{name}_percent")
        share = getattr(self, percent)
        of_range = None if share is None else share / 100.0 * site.admissible
        return one_of(**{percent: of_range, self.key(name): getattr(self, name)})

    def numbers(self, site: Site, uniform: Floats) -> Any:
        """Constants on one site, see `fddbench.interfaces.Fault.numbers`.

        Raises
        ------
        ValueError
            A size is missing or given twice.
        """
        raise NotImplementedError

    def held(self, site: Site) -> Any:
        """What stands in place of the signal with ``mode: replace``, in the unit of the site."""
        percent, value = (0.0 if v is None else v for v in (self.hold_value_percent, self.hold_value))
        return percent / 100.0 * site.admissible + value

    @classmethod
    def block(cls, n_sites: int, sample_s: float) -> FaultBlock:
        """What flies of this kind on so many sites; the `profile` added to the signal unless the kind has its own."""
        if cls.profile is None:
            raise FddbenchError(f"the fault {cls.__name__} has neither a profile nor a block of its own")
        return ProfileBlock(cls.profile, n_sites, sample_s)

    @classmethod
    def block_for(cls, faults: Sequence[Self], n_sites: int, sample_s: float) -> FaultBlock:
        """`block` for these faults of the kind, as they are written; one whose size depends on them brings its own."""
        del faults
        return cls.block(n_sites, sample_s)


class WithAmplitude(FaultSpecification):
    """A fault whose size is an amplitude, of the admissible range [%] or in the unit of the sites; give one.

    Attributes
    ----------
    amplitude_percent, amplitude : float
        The amplitude.
    """

    amplitude_percent: Finite | None = None
    amplitude: Finite | None = None

    @classmethod
    def key_rules(cls) -> Iterator[KeyRule]:
        """Exactly one amplitude."""
        yield from super().key_rules()
        yield exactly_one("amplitude_percent", cls.key("amplitude"))


@cache
def _in_unit(kind: type[FaultSpecification], name: str) -> type[FaultSpecification]:
    """Kind with the keys of a unit; always the same class for the same kind."""
    if name == "deg/s":
        return kind
    config = ConfigDict(alias_generator=unit(name).key)
    namespace = {"model_config": config, "unit_name": name, "__module__": kind.__module__, "__doc__": kind.__doc__}
    return type(kind.__name__, (kind,), namespace)
