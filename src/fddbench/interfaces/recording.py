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
    cases : tuple of int
        Case numbers, as in the rows.
    time_s : (n_time,) array
        Time since the start [s].
    onset_s : float or None
        First faulty sample [s].
    signals : mapping of str to (n_time, n_cases) arrays
        Measured and true signals by name with unit; a signal of several rows is numbered from 1 (``r_deg_s_1``).
    detectors : mapping of str to mapping of str to (n_time, n_cases) arrays
        Per detector ``n_declared``, ``residual`` and what it announced in ``recorded``.
    """

    scenario: str
    cases: tuple[int, ...]
    time_s: Floats
    onset_s: float | None
    signals: Mapping[str, Floats]
    detectors: Mapping[str, Mapping[str, Floats]]
