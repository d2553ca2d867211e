"""What a benchmark and its plants must offer."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from fddbench.interfaces.fault import Fault
from fddbench.interfaces.loop import Loop
from fddbench.interfaces.site import Site

__all__ = [
    "Benchmark",
    "Choice",
    "Detectability",
    "Options",
    "Parameter",
    "Plant",
    "Response",
    "SinglePlant",
    "default_choices",
]


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """A number that differs from flight to flight; its name carries its unit.

    Attributes
    ----------
    name, about : str
        As in campaigns (``mass_kg``) and as explained by ``fddbench list``.
    default : float
        Where a campaign does not disperse it.
    low, high : float
        What a campaign may ask for, in the unit of the name.
    whole : bool
        A number that counts: whole, and listed in a grid or a sequence, never drawn.
    """

    name: str
    about: str
    default: float
    low: float
    high: float
    whole: bool = False


@dataclass(frozen=True, kw_only=True)
class Choice:
    """Something that a campaign may choose on a benchmark, by a key of its own (``voter: median``).

    Attributes
    ----------
    about : str
        What is chosen.
    options : mapping of str to object
        What there is, by name; the first is the default.
    family : str
        Family of kinds whose registered members (``fddbench.<family>s``) and files (``mine.py:Mine``) may be chosen too; "":
        only the options.
    needs : sequence of str
        What a member of that family must have.
    reads : callable, optional
        Makes an option of a YAML file beside the campaign that is named instead (``plant: mine.yaml``), from its path; raises
        FddbenchError for one that is none. None: files of data are nothing to choose here. An option that stands on
        more files has them as ``files``, content by name in the folder of its own.
    says : mapping of str to str
        What each option is, for those that do not say so themselves (by an ``about``).
    """

    about: str
    options: Mapping[str, Any]
    family: str = ""
    needs: Sequence[str] = ()
    reads: Callable[[Path], Any] | None = None
    says: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Options:
    """What a loop is built from.

    Attributes
    ----------
    chosen : mapping of str to object
        What was chosen, by the keys of `Benchmark.choices`.
    sample_s, substeps : float, int
        Clock [s], and integration steps in a sample.
    faults : sequence of sequences of Fault
        Faults of every scenario that will fly: the loop holds the kinds that are used, where they are used.
    """

    chosen: Mapping[str, Any]
    sample_s: float = 0.01
    substeps: int = 1
    faults: Sequence[Sequence[Fault]] = field(default=())


@dataclass(frozen=True, kw_only=True)
class Detectability:
    """A map that the report draws: the smallest fault of a site that is found, over two parameters.

    Attributes
    ----------
    site : str
        The map is of faults of this site alone.
    size : str
        Their size as their kind writes it, ``loss_percent``; a scenario is on the map if it draws or sweeps it.
    axes : (str, str)
        What varies along the horizontal and the vertical axis: parameters of the plant, or what `derived` gives.
    times : str
        By whose magnitude a size is multiplied, what `derived` gives or a parameter; "" for nothing. A size in percent is a
        share of it, and the product has its unit.
    hatch_below : float
        Where the median of that magnitude is smaller the map is hatched: all of it would be a small fault.
    """

    site: str
    size: str
    axes: tuple[str, str]
    times: str = ""
    hatch_below: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Response:
    """A panel of the pictures of a manoeuvre: how the aircraft answers what it is asked for.

    Attributes
    ----------
    signal : str
        Measured or true signal; a row of one of several is numbered from 1, ``r_deg_s_2``.
    command : str
        Signal that it should follow; "" for none.
    limits : sequence of str
        Signals that it should not pass.
    """

    signal: str
    command: str = ""
    limits: Sequence[str] = ()


class Plant(Protocol):
    """What flies: its parameters, what it refuses, what it can do; a benchmark with a single one may be its own plant.

    For the report it may have ``responses``, the `Response` panels of the pictures of its flights, where a campaign asks for
    bands (what the benchmark shows).

    One that flies what was recorded may have more: ``longest_s(parameters)``, how long flights last, (n_cases,) [s], none
    longer than ``manoeuvres`` say; ``labelled(parameters, sample_s)``, the `LoggedFaults` faults that are in what it flies, and
    ``n_labelled()``, the most that a flight has; ``notes(sample_s)``, what there is to say of each log; ``files``, what
    besides an option of data travels with a campaign, by name beside that option; ``shown``, instead of the benchmark's.
    """

    sites: tuple[Site, ...]
    parameters: tuple[Parameter, ...]
    refused_parameters: Mapping[str, str]
    manoeuvres: Mapping[str, float]
    """Manoeuvre → length of a healthy flight [s]."""


class Benchmark(Protocol):
    """An aircraft or engine with its fault sites, manoeuvres and requirements; registered under ``fddbench.benchmarks``.

    `choices` are the keys by which a campaign chooses; `shown` names the signals in the pictures of the report, `limits_from`
    says where the time limits come from.

    ``fddbench list`` draws of each manoeuvre what it commands: signals named so, and those in ``commands`` (none).

    For the report it may have more, and has these otherwise: ``envelope_axes``, pairs of parameters that belong on the two
    axes of a picture (none); ``published``, the printed table that stands beside its results unless a campaign names another,
    and ``iterations``, the printed course of an optimisation: files of ``reports/published`` by their names ("": none);
    ``detectability``, the `Detectability` maps that are drawn (none); a method ``derived(chosen, parameters)``, more numbers of
    flights by name with unit, (n_cases,) arrays (a trim, say), of the chosen options by key and of the parameters of flights,
    (n_cases,) arrays by name (none); a method ``ideal(chosen, parameters, sample_s)``, by name the `IdealModel` of such
    flights that the bound stands on, the best known first, or in a sentence why there is none (none).
    """

    name: str
    about: str
    choices: Mapping[str, Choice]
    shown: tuple[str, ...]
    limits_from: str

    def plant(self, chosen: Mapping[str, Any]) -> Plant:
        """What flies with these choices."""
        ...

    def loop(self, options: Options) -> Loop:
        """Closed loop for these options; raises `FddbenchError` for a choice it does not have."""
        ...


def default_choices(benchmark: Benchmark) -> dict[str, Any]:
    """What is chosen on a benchmark when a campaign says nothing."""
    return {key: next(iter(choice.options.values())) for key, choice in benchmark.choices.items()}


class SinglePlant:
    """Base of a benchmark that is its own plant and offers no choices; any of these may be overridden."""

    choices: Mapping[str, Choice] = {}
    refused_parameters: Mapping[str, str] = {}
    parameters: tuple[Parameter, ...] = ()
    shown: tuple[str, ...] = ()
    limits_from = "the author of the benchmark"
    envelope_axes: Sequence[tuple[str, str]] = ()
    detectability: Sequence[Detectability] = ()
    published = ""
    iterations = ""

    def plant(self, chosen: Mapping[str, Any]) -> Any:
        """The benchmark itself."""
        del chosen
        return self
