"""One stage of faults on the sites of one signal: a line of the scenarios, the kinds that a campaign uses there."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from fddbench.blocks.block import Part
from fddbench.blocks.consumers import fault_number
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, mapped, record
from fddbench.faults.timing import NEVER
from fddbench.interfaces import Fault, FaultBlock, Instant

__all__ = ["Numbers", "Slot", "SlotConstants", "SlotState"]


@record
class SlotConstants:
    """When and on which sites a fault acts, and with which sign; which kind it is of; constants of every kind in use.

    `stands` and `freezes` are 1 where a held value, or the last reading, stands in place of the signal.
    """

    first: Rows
    last: Rows
    sign: Rows
    stands: Rows
    freezes: Rows
    held: Rows
    independent: Row
    kind: Row
    kinds: tuple[Part, ...]


@record
class SlotState:
    """Reading at which a frozen site stands, and what the kinds keep."""

    frozen: Rows
    kinds: tuple[Part, ...]


@record
class Numbers:
    """Normal numbers of a slot: one for all sites, and one for each."""

    common: Row
    own: tuple[Row, ...]


class Slot:
    """A slot mixes kinds: each flight has one of them, or none; what another kind computes there is not used.

    Several slots may stand for one line, see `fddbench.faults.order`; they draw the same numbers and a site's fault acts in
    one of them.

    Parameters
    ----------
    slot : int
        Number of the slot: the place of the fault in its scenario.
    faults : sequence of Fault
        Those that scenarios have in this slot on these sites, as they are written.
    sites : tuple of int
        Positions of the sites in the benchmark; the first four have numbers of their own since the beginning.
    """

    def __init__(self, slot: int, faults: Sequence[Fault], sites: tuple[int, ...], sample_s: float) -> None:
        n = len(sites)
        self.kinds, self.n_sites, self.sample_s = _kinds_of(faults), n, sample_s
        self.freezes = any(fault.freeze for fault in faults)
        own = {kind: [fault for fault in faults if type(fault) is kind] for kind in self.kinds}
        self.blocks: tuple[FaultBlock, ...] = tuple(kind.block_for(own[kind], n, sample_s) for kind in self.kinds)
        kept = tuple(block.states.shape for block in self.blocks)
        self.states = Layout(SlotState(frozen=n if self.freezes else Nothing(), kinds=kept))
        self.constants = Layout(
            SlotConstants(
                first=n, last=n, sign=n, stands=n, freezes=n, held=n, independent=ROW, kind=ROW,
                kinds=tuple(block.constants.shape for block in self.blocks),
            )
        )  # fmt: skip
        self.random = any(kind.random for kind in self.kinds)
        names: Any = Numbers(common=_draw(slot, 0), own=tuple(_draw(slot, site) for site in sites))
        self.draws: Draws[Any] = Draws(names if self.random else Nothing())

    def start(self, c: SlotConstants) -> SlotState:
        """Nothing frozen."""
        return SlotState(
            frozen=0.0 if self.freezes else Nothing(),
            kinds=tuple(block.start(own) for block, own in zip(self.blocks, c.kinds, strict=True)),
        )

    def step(
        self, x: SlotState, c: SlotConstants, n: Any, signal: Rows, before: Rows, sample: Row, free: Rows = None
    ) -> tuple[SlotState, Rows]:
        """State at the next sample, and the signal with this fault, (n_sites, n_cases).

        `before` is what the sites showed at the sample before, with all faults; used only where something freezes.
        `free` is what they would show if they floated; only kinds that come loose need it.
        """
        since = sample - c.first
        active = (since >= 0.0) & (sample <= c.last)
        now = Instant(
            since_samples=since,
            time_s=np.where(active, since, 0.0) * self.sample_s,
            active=active,
            sign=c.sign,
            random=np.where(c.independent > 0.0, np.stack(n.own), n.common) if self.random else None,
            sample=sample,
            free=free,
        )
        frozen = self._frozen(x, signal, before, since, sample)
        stands = np.where(c.freezes > 0.0, frozen, c.held) if self.freezes else c.held
        reading = np.where(c.stands > 0.0, stands, signal)
        kept, shown = self._kinds(x, c, reading, now)
        return SlotState(frozen=frozen, kinds=kept), np.where(active, shown, signal)

    def _frozen(self, x: SlotState, signal: Rows, before: Rows, since: Rows, sample: Row) -> Rows:
        """Where a frozen site stands: at its last reading; one that freezes at the first sample at that sample's own."""
        if not self.freezes:
            return x.frozen
        return np.where(since == 0.0, np.where(sample > 0.0, before, signal), x.frozen)

    def _kinds(self, x: SlotState, c: SlotConstants, reading: Rows, now: Instant) -> tuple[tuple[Part, ...], Rows]:
        """What every kind keeps, and what that of the flight shows."""
        kept, shown = [], reading
        for number, (block, own, constants) in enumerate(zip(self.blocks, x.kinds, c.kinds, strict=True)):
            after, rows = block.step(own, constants, reading, now)
            kept.append(after)
            shown = rows if number == 0 else np.where(c.kind == float(number), rows, shown)
        return tuple(kept), shown

    def nothing(self) -> SlotConstants:
        """Constants of a flight without a fault in this slot."""
        return replace(mapped(lambda _: 0.0, self.constants.shape), first=NEVER)


def _kinds_of(faults: Sequence[Fault]) -> tuple[type[Fault], ...]:
    # a kind in two units is two classes of one name: those stay in the order of the scenarios, a set has none
    found = dict.fromkeys(type(fault) for fault in faults)
    return tuple(sorted(found, key=lambda kind: (kind.__module__, kind.__qualname__)))


def _draw(slot: int, site: int) -> Draw:
    consumer, place = fault_number(slot, site)
    return Draw(consumer, place, stream="scenario", shared=True)
