"""The plug-in protocols on one page: what a benchmark, a voter and a detector must offer.

A step is a function of one sample in plain NumPy on rows of numbers, (n_rows, n_cases), without a data-dependent ``if``;
see ``blocks`` for the operations it may use. It runs on many flights at once and sees one sample, so it cannot look ahead.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from fddbench.blocks.layout import Layout, Rows

__all__ = [
    "Benchmark",
    "Bus",
    "Detector",
    "FaultUnits",
    "Flights",
    "Floats",
    "Loop",
    "Options",
    "Parameter",
    "Recording",
    "Start",
    "Tunable",
    "Verdict",
    "Voter",
]

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Bus:
    """What a detector can see and what it must name.

    Attributes
    ----------
    sample_s : float
        Time between two samples [s].
    sites : tuple of str
        Fault sites in their order, e.g. ``("r1", "r2", "r3")``.
    signals : mapping of str to int
        Measured signals by name with unit; rows of each, 0 for a single signal seen as (n_cases,).
    """

    sample_s: float
    sites: tuple[str, ...]
    signals: Mapping[str, int]


@dataclass(frozen=True)
class Verdict:
    """What a detector declares at one sample.

    Attributes
    ----------
    declared : (n_sites, n_cases) rows
        1 where a site is declared faulty, else 0.
    ratio : (n_cases,) row
        Residual over threshold [-]; above 1 the detector suspects a fault.
    signals : mapping of str to (n_cases,) rows
        What the detector shows of its inside, by name with unit, as announced in `Detector.recorded`.
    """

    declared: Rows
    ratio: Rows
    signals: Mapping[str, Rows] = field(default_factory=dict)


class Detector(Protocol):
    """A tuned detector: immutable numbers, its state passed in and out.

    A class registered under ``fddbench.detectors`` has besides: ``Gains``, the pydantic model of its numbers, and
    ``from_design(gains, bus)``, which makes the detector for a bus or raises `DesignError`.
    """

    states: Layout
    recorded: tuple[str, ...]

    def start(self, n_cases: int) -> Floats:
        """State before the first sample, (n_state, n_cases)."""
        ...

    def step(self, state: Rows, measured: SimpleNamespace) -> tuple[Rows, Verdict]:
        """State after this sample, and the verdict on it; `measured` has the signals of the bus as attributes."""
        ...


@runtime_checkable
class Tunable(Detector, Protocol):
    """A detector whose thresholds ``fddbench tune`` can choose; its ``Gains`` have ``thresholds``, one per signal.

    It alarms when one of the `evaluated` signals has stayed above its threshold for `confirm_samples` samples.
    """

    evaluated: tuple[str, ...]
    confirm_samples: float


class Voter(Protocol):
    """Makes one signal of redundant sensors; a class without arguments registered under ``fddbench.voters``."""

    def vote(self, sensors: Rows) -> Rows:
        """Voted signal, (n_cases,), of the sensors, (n_sensors, n_cases); same unit."""
        ...


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
    """

    name: str
    about: str
    default: float
    low: float
    high: float


@dataclass(frozen=True, kw_only=True)
class FaultUnits:
    """What the sizes of faults mean on a benchmark.

    Attributes
    ----------
    unit : {"deg/s", ""}
        Unit of the fault sites, carried by the keys of a campaign; "": plain numbers, keys ``amplitude``, ``rate_per_s``.
    admissible, sensor_range : float
        In this unit: what percent is of, and where a runaway stops (infinite: nowhere).
    """

    unit: str
    admissible: float
    sensor_range: float


@dataclass(frozen=True, kw_only=True)
class Options:
    """The choices of a campaign that a benchmark builds its loop from; "" where the benchmark has none to offer."""

    plant: str
    voter: str
    sensors: str
    wind: str
    sample_s: float
    substeps: int
    fault_slots: int


@dataclass(frozen=True, kw_only=True)
class Flights:
    """Flights to start together.

    Attributes
    ----------
    parameters : mapping of str to (n_cases,) arrays
        Every parameter of the benchmark, true values.
    manoeuvres : sequence of str
        One name per case.
    faults : (n_fault_rows, n_cases) array
        Data rows of the fault step, see ``faults.injection``.
    normals : (n_start_normals, n_cases) array
        Standard normal numbers for what is random before the first sample (gust at the start, sensor biases).
    """

    parameters: Mapping[str, Floats]
    manoeuvres: Sequence[str]
    faults: Floats
    normals: Floats


@dataclass(frozen=True, kw_only=True)
class Start:
    """Flights ready at sample 0: state (n_state, n_cases), constants (n_constant, n_cases), and per case why not ("": fine)."""

    state: Floats
    constants: Floats
    infeasible_reason: tuple[str, ...]


class Loop(Protocol):
    """A benchmark in closed loop, for one set of options.

    ``consumers`` lists the random consumers drawn every sample from the flight's own stream and ``fault_consumers`` those
    drawn from the scenario's; each yields four normals, stacked in this order into the ``normals`` of `step`.
    """

    bus: Bus
    states: Layout
    constants: Layout
    consumers: tuple[int, ...]
    fault_consumers: tuple[int, ...]
    start_consumers: tuple[int, ...]
    truth: tuple[str, ...]

    def fault_rows(self, faults: Sequence[Any], phases: Floats) -> Floats:
        """Data rows of the faults of one scenario, (n_fault_rows, n_cases).

        `phases`, (n_fault_slots, n_sites, n_cases), are uniform numbers in (0, 1) for faults that draw their phase.
        """
        ...

    def start(self, flights: Flights) -> Start:
        """State and constants before sample 0; vectorised, may iterate (trim)."""
        ...

    def step(
        self, state: Rows, constants: Rows, normals: Rows, sample: Any
    ) -> tuple[Rows, SimpleNamespace, Mapping[str, Rows], Rows]:
        """State at the next sample, measured signals and truth at this one, and which flights have departed (boolean)."""
        ...


class Benchmark(Protocol):
    """An aircraft or engine with its fault sites, manoeuvres and requirements; registered under ``fddbench.benchmarks``.

    Of `plants`, `voters`, `sensors` and `winds` the first is the default; empty where there is nothing to choose.
    `shown` names the signals in the pictures of the report, `limits_from` says where the time limits come from.
    """

    name: str
    about: str
    sites: tuple[str, ...]
    parameters: tuple[Parameter, ...]
    refused_parameters: Mapping[str, str]
    plants: tuple[str, ...]
    voters: tuple[str, ...]
    sensors: tuple[str, ...]
    winds: tuple[str, ...]
    manoeuvres: Mapping[str, float]
    fault_units: FaultUnits
    shown: tuple[str, ...]
    limits_from: str

    def detection_time_limit_s(self, n_faulty: int) -> float:
        """Requirement by number of faulty sites [s]."""
        ...

    def loop(self, options: Options) -> Loop:
        """Closed loop for these options; raises `FddbenchError` for a choice it does not have."""
        ...


@dataclass(frozen=True, kw_only=True)
class Recording:
    """Signals of re-flown cases of one scenario, for pictures; NaN after the end of a flight.

    Attributes
    ----------
    scenario : str
        Name of the scenario.
    cases : tuple of int
        Case numbers, as in the rows.
    time_s : (n_time,) array
        Time since the start [s].
    onset_s : float or None
        First faulty sample [s].
    signals : mapping of str to (n_time, n_cases) arrays
        Measured and true signals by name with unit; a signal of several rows is numbered from 1 (``r_deg_s_1``).
    detectors : mapping of str to mapping of str to (n_time, n_cases) arrays
        Per detector ``n_declared``, ``ratio`` and what it announced in ``recorded``.
    """

    scenario: str
    cases: tuple[int, ...]
    time_s: Floats
    onset_s: float | None
    signals: Mapping[str, Floats]
    detectors: Mapping[str, Mapping[str, Floats]]
