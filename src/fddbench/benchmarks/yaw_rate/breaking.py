"""Faults on every signal of an aircraft that has fault sites; a signal without any passes."""

from collections.abc import Callable, Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Row, Rows, record
from fddbench.errors import FddbenchError
from fddbench.faults.injection import SignalFaults
from fddbench.interfaces import Fault, FlightFaults, Site

__all__ = ["Breaking", "Broken"]


@record
class Broken:
    """One part for each signal that may have fault sites."""

    r_deg_s: Any
    p_units_deg_s: Any
    phi_units_deg: Any
    alpha_deg: Any
    n_z_g: Any
    surface_deg: Any
    elevator_deg: Any
    stabiliser_deg: Any


def _of_each(part: Callable[[str], Any]) -> Broken:
    return Broken(**{field.name: part(field.name) for field in fields(Broken)})


class Breaking:
    """Faults of all signals.

    Parameters
    ----------
    sites : tuple of Site
        Fault sites of the plant.
    signals : sequence of str
        Where this aircraft may have fault sites.
    faults : sequence of sequences of Fault
        Of every scenario.
    sample_s : float
        Sample time [s].

    Raises
    ------
    FddbenchError
        A site lies on another signal.
    """

    def __init__(
        self, sites: tuple[Site, ...], signals: Sequence[str], faults: Sequence[Sequence[Fault]], sample_s: float
    ) -> None:
        wrong = [f"{site.name} on {site.signal}" for site in sites if site.signal not in signals]
        if wrong:
            raise FddbenchError(f"fault sites {', '.join(wrong)}: this plant has sites on {', '.join(signals)}")
        self.sites = sites
        self.parts = {field.name: SignalFaults(sites, field.name, faults, sample_s) for field in fields(Broken)}
        self.states = Layout(_of_each(lambda name: self.parts[name].states.shape))
        self.constants = Layout(_of_each(lambda name: self.parts[name].constants.shape))
        self.draws: Draws[Broken] = Draws(_of_each(lambda name: self.parts[name].draws.names))

    def n_sites(self, signal: str) -> int:
        """Fault sites on a signal."""
        return len(self.parts[signal].sites)

    def prepare(self, faults: FlightFaults) -> Broken:
        """Constants of flights."""
        return _of_each(lambda name: self.parts[name].prepare(faults))

    def start(self, c: Broken) -> Broken:
        """Nothing read yet."""
        return _of_each(lambda name: self.parts[name].start(getattr(c, name)))

    def begin(self, x: Broken, c: Broken, n: Broken, sample: Row) -> "_Sample":
        """One sample; signals are handed to it as they come about."""
        return _Sample(self, x, c, n, sample)


class _Sample:
    """Faults of one sample."""

    def __init__(self, all_of_them: Breaking, x: Broken, c: Broken, n: Broken, sample: Row) -> None:
        self._all, self._x, self._c, self._n, self._sample = all_of_them, x, c, n, sample
        self._after: dict[str, Any] = {}
        self._added: dict[str, Rows] = {}

    def broken(self, name: str, healthy: Rows) -> Rows:
        """A signal with its faults; rows without a site pass."""
        part, own = self._all.parts[name], getattr(self._x, name)
        if not part.rows:
            self._after[name] = own
            return healthy
        rows = np.stack([healthy[row] for row in part.rows])
        constants, numbers = getattr(self._c, name), getattr(self._n, name)
        self._after[name], faulty = part.step(own, constants, numbers, rows, self._sample)
        shown = list(healthy)
        for row, value in zip(part.rows, faulty, strict=True):
            shown[row] = value
        stacked = np.stack(shown)
        self._added[name] = stacked - healthy
        return stacked

    def after(self) -> Broken:
        """States at the next sample; a signal that was not handed over keeps its own."""
        return _of_each(lambda name: self._after.get(name, getattr(self._x, name)))

    def added(self) -> Rows:
        """What faults add on every site, (n_sites, n_cases)."""
        return np.stack([self._added[site.signal][site.row] for site in self._all.sites])
