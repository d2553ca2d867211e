"""Signals of flights that were flown again."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from fddbench.interfaces.floats import Floats

__all__ = ["QUANTILES", "Bands", "Recording"]

QUANTILES = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)
"""What `Bands` keep of all flights at each time."""


@dataclass(frozen=True, kw_only=True)
class Recording:
    """Signals of re-flown cases of one scenario, for pictures; NaN after the end of a flight.

    Attributes
    ----------
    scenario : str
        Name of the scenario.
    cases : tuple of str
        Names of the cases, ``jam_a/3/0/17``, as the column ``case`` has them.
    time_s : (n_time,) array
        Time since the start [s].
    onset_s : (n_cases,) array or None
        First faulty sample of each [s], NaN for a healthy one among others; None: healthy flights.
    signals : mapping of str to (n_time, n_cases) arrays
        Measured and true signals by name with unit; a signal of several rows is numbered from 1 (``r_deg_s_1``).
    detectors : mapping of str to mapping of str to (n_time, n_cases) arrays
        Per detector ``n_declared``, ``alarm``, ``residual`` and what it announced in ``recorded``.
    declared : mapping of str to mapping of str to (n_time, n_cases) arrays
        Per detector and fault site 1 where it is declared, else 0.
    errors : mapping of str to (n_cases,) sequences of str
        Per detector why it did not come to the end of each flight, "" where it did; of detectors that always did nothing.
    """

    scenario: str
    cases: tuple[str, ...]
    time_s: Floats
    onset_s: Floats | None
    signals: Mapping[str, Floats]
    detectors: Mapping[str, Mapping[str, Floats]]
    declared: Mapping[str, Mapping[str, Floats]] = field(default_factory=dict)
    errors: Mapping[str, Sequence[str]] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Bands:
    """Signals of all flights of one scenario as quantiles over time, and those of one flight; NaN where none flies any more.

    Attributes
    ----------
    scenario, manoeuvre : str
        Its name, and what is flown.
    flights, of : int
        How many flights there are in the quantiles, and how many were flown: a seeded sample of very many.
    case : str
        The flight that is kept by itself: the first of that sample.
    time_s : (n_time,) array
        Time since the start [s], coarser than the flight.
    onset_s : float or None
        Earliest first faulty sample [s]; None: healthy flights.
    signals : mapping of str to (n_quantile, n_time) arrays
        Measured and true signals by name with unit, rows of one numbered from 1: `QUANTILES`, observed values.
    one : mapping of str to (n_time,) arrays
        The same signals of that flight.
    detectors : mapping of str to mapping of str to (n_quantile, n_time) arrays
        Per detector what it announced in ``recorded``, and ``residual``.
    declared : mapping of str to (n_count, n_time) arrays
        Per detector the share of flights that declare 0, 1, 2, … sites [-].
    """

    scenario: str
    manoeuvre: str
    flights: int
    of: int
    case: str
    time_s: Floats
    onset_s: float | None
    signals: Mapping[str, Floats]
    one: Mapping[str, Floats]
    detectors: Mapping[str, Mapping[str, Floats]]
    declared: Mapping[str, Floats]
