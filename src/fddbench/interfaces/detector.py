"""What a detector and a voter must offer."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any, Protocol, runtime_checkable

from fddbench.blocks.layout import Layout, Row, Rows

__all__ = ["Detector", "Tunable", "Verdict", "Voter"]


@dataclass(frozen=True)
class Verdict:
    """What a detector decides at one sample.

    Attributes
    ----------
    declared : (n_watched, n_cases) rows or None
        1 where a watched site is declared faulty, else 0, in the order of `Detector.watches`; None for a detector that only
        detects.
    residual : (n_cases,) row
        Largest residual over its threshold [-]; above 1 the detector suspects a fault.
    signals : mapping of str to (n_cases,) rows
        What the detector shows of its inside, by name with unit, as announced in `Detector.recorded`.
    alarm : (n_cases,) row or None
        1 where something is wrong, else 0; None: where any site is declared. It holds wherever a site is declared.
    estimate : (n_watched, n_cases) rows, (n_cases,) row or None
        Size of the fault in the unit of its site: of every watched site, or of the voted signal that `estimates` names.
    """

    declared: Rows
    residual: Row
    signals: Mapping[str, Row] = field(default_factory=dict)
    alarm: Row = None
    estimate: Rows = None


class Detector(Protocol):
    """A tuned detector: immutable numbers, its state passed in and out.

    A class registered under ``fddbench.detectors`` has besides: ``Gains``, the pydantic model of its numbers, and
    ``from_design(gains, bus)``, which makes the detector for a bus or raises `DesignError`.

    It may have more, and has these otherwise: ``watches``, the names of the sites it declares (all sites of the bus);
    ``isolates`` (True; False for one that only detects); ``estimates``, what `Verdict.estimate` is of (None: it gives none):
    "sites", or the name of a voted signal; ``constants`` and ``draws`` (none): a detector that has them is a full block,
    with ``start(c)`` and ``step(x, c, n, measured)``.
    """

    states: Layout[Any]
    recorded: tuple[str, ...]

    def start(self) -> Any:
        """State before the first sample, a record of `states`; plain numbers, since every flight starts alike."""
        ...

    def step(self, x: Any, measured: SimpleNamespace) -> tuple[Any, Verdict]:
        """State after this sample, and the verdict on it; `measured` has the signals of the bus as attributes."""
        ...


@runtime_checkable
class Tunable(Protocol):
    """A detector whose thresholds ``fddbench tune`` can choose; its ``Gains`` have ``thresholds``, one per signal.

    It alarms when one of the `evaluated` signals has stayed above its threshold for `confirm_samples` samples.
    """

    evaluated: tuple[str, ...]
    confirm_samples: float


class Voter(Protocol):
    """Makes one signal of redundant sensors; a class without arguments registered under ``fddbench.voters``."""

    def vote(self, sensors: Rows) -> Row:
        """Voted signal, (n_cases,), of the sensors, (n_sensors, n_cases); same unit."""
        ...
