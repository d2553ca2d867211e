"""All faults on the sites of one signal, stage after stage: data rows decide kind, size and time of each flight.

On each site the faults act in the order of its first faulty samples (`fddbench.faults.order`), each on what the earlier ones
made; the stops of the site act last, at every sample. A slot without a fault, and a fault of size zero, leave every bit of
the healthy signal as it was.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Row, Rows, filled, leaves, record
from fddbench.faults.order import orders_of, pattern_of, place, stages
from fddbench.faults.slot import Slot, SlotConstants, SlotState
from fddbench.faults.timing import NEVER, first_samples, last_sample
from fddbench.interfaces import Fault, FlightFaults, Floats, Site

__all__ = ["SignalFaults", "SignalFaultsState"]


@record
class SignalFaultsState:
    """What was read last on every site (only where something can freeze), and what the slots keep."""

    before: Rows
    slots: tuple[SlotState, ...]


class SignalFaults:
    """Faults on the sites of one signal, see `fddbench.blocks.block.Block`.

    Parameters
    ----------
    sites : sequence of Site
        All fault sites of the benchmark, in order: their positions are the addresses of random numbers.
    signal : str
        The signal whose sites these are, in the order of its rows.
    faults : sequence of sequences of Fault
        Faults of every scenario that will fly, as they are written; a kind that none of them uses here costs nothing.
    sample_s : float
        Sample time [s].
    """

    def __init__(self, sites: Sequence[Site], signal: str, faults: Sequence[Sequence[Fault]], sample_s: float) -> None:
        positions = sorted((j for j, site in enumerate(sites) if site.signal == signal), key=lambda j: sites[j].row)
        self.sites = tuple(sites[j] for j in positions)
        self.rows = [site.row for site in self.sites]
        self.positions, self.sample_s = tuple(positions), sample_s
        patterns = [pattern_of(one, site.name, sample_s) for one in faults for site in self.sites]
        self.lines = stages([pattern for pattern in patterns if pattern])
        self.slots = tuple(self._slot(line, faults) for line in self.lines)
        self.freezes = any(slot.freezes for slot in self.slots)
        self.states = Layout(
            SignalFaultsState(
                before=len(self.sites) if self.freezes else Nothing(),
                slots=tuple(slot.states.shape for slot in self.slots),
            )
        )
        self.constants: Layout[tuple[SlotConstants, ...]] = Layout(tuple(slot.constants.shape for slot in self.slots))
        self.draws: Draws[Any] = Draws(tuple(slot.draws.names for slot in self.slots))

    def _here(self, fault: Fault) -> bool:
        return any(site.name in fault.sites for site in self.sites)

    def _slot(self, number: int, faults: Sequence[Sequence[Fault]]) -> Slot:
        here = [one[number] for one in faults if number < len(one) and self._here(one[number])]
        return Slot(number, here, self.positions, self.sample_s)

    def prepare(self, faults: FlightFaults) -> tuple[SlotConstants, ...]:
        """Constants of flights."""
        rows = np.empty((self.constants.size, len(faults.which)))
        for s in np.unique(faults.which).tolist():
            mine = faults.which == s
            rows[:, mine] = self._packed(faults.lists[s], faults.uniform[:, :, mine])
        return self.constants.unpack(rows)

    def _packed(self, faults: Sequence[Fault], uniform: Floats) -> Floats:
        """Constants of flights of one scenario, (n_rows, n_cases)."""
        n_cases = uniform.shape[2]
        acts = self._acts(faults, n_cases)
        found = []
        for stage, (line, slot) in enumerate(zip(self.lines, self.slots, strict=True)):
            fault = faults[line] if acts[:, stage].any() else None
            own = slot.nothing() if fault is None else self._constants(slot, fault, uniform[line], acts[:, stage] > 0.0)
            found.append(slot.constants.pack(slot.constants.spread(own, n_cases), n_cases))
        packed: Floats = np.concatenate([*found, np.zeros((0, n_cases))])
        return packed

    def _acts(self, faults: Sequence[Fault], n_cases: int) -> Floats:
        """1 where the fault of a stage acts on a site, (n_sites, n_stages, n_cases)."""
        found = np.zeros((len(self.sites), len(self.lines), n_cases))
        for row, site in enumerate(self.sites):
            found[row] = place(orders_of(faults, site.name, self.sample_s, n_cases), self.lines)
        return found

    def _constants(self, slot: Slot, fault: Fault, uniform: Floats, acts: npt.NDArray[np.bool_]) -> SlotConstants:
        """Constants of a fault where it acts in a slot, (n_sites, n_cases); the rest stays as without it."""
        kind, names = slot.kinds.index(type(fault)), [site.name for site in self.sites]
        own = uniform if fault.correlation == "independent" else np.broadcast_to(uniform[:1], uniform.shape)
        sizes = [
            fault.numbers(site, own[position]) if site.name in fault.sites else None
            for site, position in zip(self.sites, self.positions, strict=True)
        ]
        signs = {s: -1.0 if fault.correlation == "opposite" and nth % 2 else 1.0 for nth, s in enumerate(fault.sites)}
        held = [fault.held(site) if site.name in fault.sites else 0.0 for site in self.sites]
        n_cases, kinds = uniform.shape[1], list(slot.nothing().kinds)
        kinds[kind] = _stacked(slot.blocks[kind].constants, sizes, n_cases)
        first = _rows(first_samples(fault, names, self.sample_s), n_cases)
        return SlotConstants(
            first=np.where(acts, first, NEVER),
            last=last_sample(fault, self.sample_s),
            sign=_rows([signs.get(name, 0.0) for name in names], n_cases),
            stands=float(fault.mode == "replace"),
            freezes=float(fault.freeze),
            held=_rows(held, n_cases),
            independent=float(fault.correlation == "independent"),
            kind=float(kind),
            kinds=tuple(kinds),
        )

    def start(self, c: tuple[SlotConstants, ...]) -> SignalFaultsState:
        """Nothing read, nothing frozen."""
        slots = tuple(slot.start(own) for slot, own in zip(self.slots, c, strict=True))
        return SignalFaultsState(before=0.0 if self.freezes else Nothing(), slots=slots)

    def step(
        self,
        x: SignalFaultsState,
        c: tuple[SlotConstants, ...],
        n: Any,
        healthy: Rows,
        sample: Row,
        *,
        free: Rows = None,
    ) -> tuple[SignalFaultsState, Rows]:
        """State at the next sample, and the faulty signal, (n_sites, n_cases), of the healthy one; `sample` is its number.

        `free`, (n_sites, n_cases), is what the sites would show if they floated: a loop hands it over where one of its sites
        says `floats`, and anything finite on the rows of those that do not.
        """
        signal, kept = healthy, []
        for slot, own, constants, numbers in zip(self.slots, x.slots, c, n, strict=True):
            after, signal = slot.step(own, constants, numbers, signal, x.before, sample, free)
            kept.append(after)
        signal = self._within_stops(signal)
        return SignalFaultsState(before=signal if self.freezes else Nothing(), slots=tuple(kept)), signal

    def _within_stops(self, signal: Rows) -> Rows:
        """The signal within the stops of its sites; a site without any is left alone."""
        if not any(np.isfinite(site.stops).any() for site in self.sites):
            return signal
        rows = []
        for row, site in zip(signal, self.sites, strict=True):
            low, high = site.stops
            row = np.maximum(row, low) if np.isfinite(low) else row
            rows.append(np.minimum(row, high) if np.isfinite(high) else row)
        return np.stack(rows)


def _rows(values: Sequence[Any], n_cases: int) -> Floats:
    """A number or an (n_cases,) array a site as (n_sites, n_cases)."""
    return np.array([np.broadcast_to(value, (n_cases,)) for value in values], dtype=np.float64)


def _stacked(layout: Layout[Any], sizes: Sequence[Any], n_cases: int) -> Any:
    """Constants of a kind from those of every site (None: not faulty, all zero), the sites below each other."""
    each = [None if size is None else dict(leaves(size)) for size in sizes]
    found = []
    for path, rows in layout.counts.items():
        shape = (rows // len(sizes), n_cases)
        found.append(np.concatenate([np.broadcast_to(0.0 if own is None else own[path], shape) for own in each]))
    return filled(layout.shape, iter(found))
