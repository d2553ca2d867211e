"""The file that says what is in logs: which column is which signal, in which unit, and where faults can sit."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, Self

import yaml
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError, model_validator

from fddbench.errors import FddbenchError, did_you_mean
from fddbench.units import FACTORS

__all__ = ["ChannelMap", "Log", "Mapped", "SitesOn", "TimeOf", "read_mapping"]

ENDINGS = (".csv", ".parquet", ".ulg")
_LARGEST = 1_000_000

Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,59}$")]
Number = Annotated[float, Field(allow_inf_nan=False)]


def _inside(name: str) -> str:
    path = Path(name)
    if path.is_absolute() or ".." in path.parts or not path.name:
        raise ValueError("need a file in the folder of this mapping or below it, without '..'; put it there")
    return name


def _log_file(name: str) -> str:
    if not name.endswith(ENDINGS):
        raise ValueError(f"cannot tell from the name what it is; let it end in {', '.join(ENDINGS)}")
    return _inside(name)


def _unit(name: str) -> str:
    if name not in FACTORS:
        hint = " ".join(filter(None, (did_you_mean(name, FACTORS), f"Known: {', '.join(filter(None, FACTORS))}")))
        raise ValueError(f"no such unit. {hint}")
    return name


UnitName = Annotated[str, AfterValidator(_unit)]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)


class Log(_Strict):
    """A log.

    Attributes
    ----------
    name, file : str
        As tables of faults call it, and where it lies.
    start_s, end_s : float, optional
        Which piece of it is flown, in its own time [s]; all that every channel covers by default.
    """

    name: Name
    file: Annotated[str, AfterValidator(_log_file)]
    start_s: Number | None = None
    end_s: Number | None = None


class TimeOf(_Strict):
    """Column of the time in tables, and its unit; a ULog has a time of its own."""

    column: str = "time_s"
    unit: UnitName | None = None


class Mapped(_Strict):
    """Where a signal comes from: columns of the log, a number, or a vote.

    Attributes
    ----------
    channels : str or tuple of str
        Column of a table, ``topic.field`` of a ULog; several are the rows of one signal.
    unit : str, optional
        What the log is in; the unit that the signal's name carries by default.
    value : float or tuple of float
        Instead: what no log says, a constant in the unit of the signal's name.
    vote : str
        Instead: the signal whose rows are voted.
    true : str
        Of a voted signal, the true one it estimates, for errors of estimates.
    largest_gap_s : float
        Instead of what holds for all signals [s].
    """

    channels: str | tuple[str, ...] | None = Field(default=None, alias="from")
    unit: UnitName | None = None
    value: Number | tuple[Number, ...] | None = None
    vote: str | None = None
    true: str | None = None
    largest_gap_s: Annotated[float, Field(gt=0.0, allow_inf_nan=False)] | None = None

    @model_validator(mode="after")
    def _one(self) -> Self:
        given = [
            key for key, own in (("from", self.channels), ("value", self.value), ("vote", self.vote)) if own is not None
        ]
        if len(given) != 1:
            raise ValueError(f"need exactly one of from | value | vote, got {', '.join(given) or 'none'}")
        if self.channels == () or self.value == ():
            raise ValueError(f"{given[0]} names nothing")
        if self.unit is not None and self.channels is None:
            raise ValueError("unit is that of a channel; a value is in the unit of the signal's name")
        if self.true is not None and self.vote is None:
            raise ValueError("true belongs to a voted signal")
        return self

    @property
    def columns(self) -> tuple[str, ...]:
        """Channels, a row each; none for a value or a vote."""
        return (self.channels,) if isinstance(self.channels, str) else self.channels or ()

    @property
    def rows(self) -> int:
        """Rows of the signal on the bus, 0 for a single one."""
        many = self.value if self.channels is None else self.channels
        return len(many) if isinstance(many, tuple) else 0


class SitesOn(_Strict):
    """Fault sites on one signal; every key in the unit of the signal, which stands behind it (``admissible_deg_s``).

    Attributes
    ----------
    signal, names : str, tuple of str
        Which signal, and a site a row.
    admissible : float
        What percent is of.
    stops : (low, high), optional
        What the sites cannot pass.
    limits_s : tuple of float
        How soon one, two, … faulty sites must be found [s].
    """

    signal: str
    names: Annotated[tuple[Name, ...], Field(min_length=1)]
    kind: Literal["sensor", "actuator", "component"] = "sensor"
    admissible: Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
    stops: Annotated[tuple[Number, ...], Field(min_length=2, max_length=2)] | None = None
    limits_s: Annotated[tuple[Annotated[float, Field(gt=0.0, allow_inf_nan=False)], ...], Field(min_length=1)]


class ChannelMap(_Strict):
    """A mapping as it is written.

    Attributes
    ----------
    between : {"previous", "linear"}
        What a sample between two rows of a log shows: the row before, as a bus does, or straight from row to row.
    largest_gap_s : float
        A log with a longer gap between two rows is refused [s].
    missing : {"refuse", "skip"}
        Empty and not-a-number cells: an error, or rows that this channel does not have.
    faults : str, optional
        CSV beside it with the faults that are in the logs: log, sites, onset_s, end_s.
    """

    about: str = ""
    logs: Annotated[tuple[Log, ...], Field(min_length=1)]
    time: TimeOf = TimeOf()
    between: Literal["previous", "linear"] = "previous"
    largest_gap_s: Annotated[float, Field(gt=0.0, allow_inf_nan=False)] = 0.25
    missing: Literal["refuse", "skip"] = "refuse"
    signals: Annotated[dict[Name, Mapped], Field(min_length=1)]
    truth: dict[Name, Mapped] = Field(default_factory=dict)
    sites: Annotated[tuple[SitesOn, ...], Field(min_length=1)]
    faults: Annotated[str, AfterValidator(_inside)] | None = None


def read_mapping(path: Path) -> ChannelMap:
    """Mapping of a YAML file.

    Raises
    ------
    FddbenchError
        A line for each mistake: the file, the key, what was received and what is allowed.
    """
    data = _data(path)
    try:
        return ChannelMap.model_validate(_without_units(data))
    except ValidationError as error:
        raise FddbenchError("\n".join(f"{path}: {_line(each)}" for each in error.errors())) from None


class _Once(yaml.SafeLoader):
    """Refuses a key that stands twice in a block, of which YAML would keep the last."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        """Block as a dict."""
        first: dict[str, Any] = {}
        for key, _ in node.value:
            if isinstance(key, yaml.ScalarNode) and first.setdefault(key.value, key) is not key:
                problem = f"key {key.value!r} stands twice in this block, first at line {first[key.value].start_mark.line + 1}"
                raise yaml.constructor.ConstructorError(problem=problem, problem_mark=key.start_mark)
        return super().construct_mapping(node, deep)


def _data(path: Path) -> dict[str, Any]:
    try:
        raw = path.read_bytes()
        if len(raw) > _LARGEST:
            raise FddbenchError(f"{path}: larger than {_LARGEST / 1e6:g} MB; a mapping of logs is a page of text")
        data = yaml.load(raw.decode("utf-8-sig"), Loader=_Once)
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        said = " ".join(str(error).split())
        raise FddbenchError(f"{path}: cannot be read as YAML: {said}") from error
    if not isinstance(data, dict):
        raise FddbenchError(f"{path}: a mapping of logs has keys (logs, signals, sites), got {type(data).__name__}")
    return data


def _without_units(data: dict[str, Any]) -> dict[str, Any]:
    """The same with ``admissible`` and ``stops`` for keys that carry the unit of their signal."""
    from fddbench.units import suffix_of_name

    sites = data.get("sites")
    if not isinstance(sites, list):
        return data
    found = []
    for entry in sites:
        if isinstance(entry, dict) and isinstance(entry.get("signal"), str):
            suffix = suffix_of_name(entry["signal"])
            renamed = {f"{key}{suffix}": key for key in ("admissible", "stops")}
            spoilt = {key: f"{key} (write {key}{suffix})" for key in ("admissible", "stops")} if suffix else {}
            entry = {renamed.get(key, spoilt.get(key, key)): value for key, value in entry.items()}
        found.append(entry)
    return {**data, "sites": found}


def _line(error: Mapping[str, Any]) -> str:
    """One mistake in the words of its author."""
    name = ".".join(str(part) for part in _place(error["loc"]))
    if error["type"] == "missing":
        return f"{name} is missing"
    if error["type"] == "extra_forbidden":
        return f"{name} is no key of a mapping here"
    text = str(error["msg"]).removeprefix("Value error, ")
    return f"{name}: {text}, got {error.get('input')!r:.60}" if name else text


def _place(loc: tuple[Any, ...]) -> Iterator[Any]:
    """Place without what pydantic calls the members of unions."""
    yield from (part for part in loc if not (isinstance(part, str) and ("[" in part or part in {"str", "float"})))
