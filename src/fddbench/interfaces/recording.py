"""Signals of flights that were flown again."""

from collections.abc import Mapping
from dataclasses import dataclass

from fddbench.interfaces.floats import Floats

__all__ = ["Recording"]


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
        First faulty sample of each [s]; None: healthy flights.
    signals : mapping of str to (n_time, n_cases) arrays
        Measured and true signals by name with unit; a signal of several rows is numbered from 1 (``r_deg_s_1``).
    detectors : mapping of str to mapping of str to (n_time, n_cases) arrays
        Per detector ``n_declared``, ``residual`` and what it announced in ``recorded``.
    """

    scenario: str
    cases: tuple[str, ...]
    time_s: Floats
    onset_s: Floats | None
    signals: Mapping[str, Floats]
    detectors: Mapping[str, Mapping[str, Floats]]
