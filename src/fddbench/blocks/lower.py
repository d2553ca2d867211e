"""From a program to a plan: where everything lives, what is computed once, and in which order."""

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from itertools import count

from fddbench.blocks import rings
from fddbench.blocks.operations import OPERATIONS
from fddbench.blocks.pending import Pending
from fddbench.blocks.philox import PER_DRAW
from fddbench.blocks.plan import Plan
from fddbench.blocks.program import Program
from fddbench.blocks.rare import Region, region
from fddbench.blocks.rewrite import depends_only_on
from fddbench.blocks.schedule import latency, longest_first
from fddbench.blocks.seldom import Update, independent, updates
from fddbench.blocks.stretch import Shared, Writer

__all__ = ["Spec", "lower"]


@dataclass(frozen=True, kw_only=True)
class Spec:
    """What a kernel is made of.

    Attributes
    ----------
    program : Program
        In primitives, with ``uniforms`` in place of ``normals`` (`draws.with_draws`).
    streams : tuple of (int, str)
        Consumer number of each draw and whose stream it takes, ``flight`` or ``scenario``.
    recorded : tuple of str
        Outputs stored at every sample.
    """

    program: Program
    streams: tuple[tuple[int, str], ...]
    recorded: tuple[str, ...] = ()


def lower(spec: Spec) -> Plan:
    """Plan of a kernel."""
    shared = Shared()
    kernel = _Kernel(spec, shared)
    kernel.prologue()
    prologue = kernel.taken()
    finished = kernel.sample()
    return Plan(
        n_state=len(spec.program.outputs["state"]),
        n_recorded=len(kernel.recorded),
        prologue=prologue,
        sample=kernel.taken(),
        finished=finished,
        slots=kernel.slots + 1,
        tables=tuple(shared.tables),
        repeats=tuple(shared.repeats),
    )


class _Kernel(Writer):
    """Writer of a kernel: workspace vector j holds state row j, those behind what the prologue computes."""

    def __init__(self, spec: Spec, shared: Shared) -> None:
        super().__init__(spec.program, shared, len(spec.program.outputs["state"]))
        self.spec = spec
        self.recorded = [node for name in spec.recorded for node in spec.program.outputs[name]]
        self._once = depends_only_on(spec.program, {"constants"})
        self._kept: dict[int, int] = {}
        self._reads = rings.reads(spec.program)
        self._writes = rings.writes(spec.program)
        self._pending = Pending({}, {}, ())
        self._skips = count()
        self._renewed: dict[int, int] = {}  # node -> its state row, where that has its new value already

    def prologue(self) -> None:
        """Compute what depends on the constants alone, and keep what a sample needs of it."""
        nodes = self.program.nodes
        used = {a for j, node in enumerate(nodes) if not self._once[j] for a in node.arguments}
        used.update(node for rows in self.program.outputs.values() for node in rows)
        known = [j for j, node in enumerate(nodes) if self._once[j] and node.op not in {"literal", "flag"}]
        for j in known:
            self.value(j)
            if j in used:
                self._kept[j], self.slots = self.slots, self.slots + 1
                self.do("store", self._as_number(j), value=self._kept[j])
        self.forget()

    def sample(self) -> tuple[int, ...]:
        """One sample: new state into the workspace, recorded rows into the tile; registers of ``finished``."""
        finished = self.program.outputs.get("finished", ())
        outputs = [*finished, *self.recorded, *(node for ring in self._writes for node in (ring.index, ring.value))]
        written = rings.written(self.program)
        ringed = {row for ring in self._writes for row in range(ring.first, ring.first + ring.depth)}
        moving = {row: node for row, node in written.items() if row not in ringed}
        needed = self._needed([*moving.values(), *outputs])
        reads = {j: rows for j in needed if (rows := self._rows_read(j))}
        seldom = updates(self.program, written, needed, self._arguments, outputs, reads)
        behind = {j for update in seldom for j in update.inside}
        always = {row: node for row, node in moving.items() if node not in behind}
        pending = self._pending = Pending(always, reads, needed - behind)
        first = independent(needed, behind, self._arguments)
        self._compute(first, {*always.values(), *outputs, *(a for j in needed - first for a in self._arguments(j))})
        for update in seldom:
            self._write(self._needed(a for j in update.inside for a in self._arguments(j) if a not in update.inside))
            self._pending = Pending({row: moving[row] for row in update.rows}, reads, update.inside)
            self._update(update)
            self._pending = pending
        self._write(self._needed([*always.values(), *outputs]))
        self._store(pending.rest())
        for ring in self._writes:
            self.do("ring_store", self.value(ring.index), self.value(ring.value), value=(ring.first, ring.depth))
        for number, node in enumerate(self.recorded):
            self.do("record", self.value(node), value=number)
        return tuple(self.value(node) for node in finished)

    def written(self, j: int) -> int:
        """Register of a node, written now: what the prologue has kept is loaded."""
        if j in self._kept:
            return self._from_number(j, self.let("load", value=self._kept[j]))
        if j in self._renewed:
            return self.let("load", value=self._renewed[j])
        if j in self._reads:
            ring = self._reads[j]
            return self.let("ring_load", self.value(ring.index), value=(ring.first, ring.depth))
        return super().written(j)

    def input(self, name: str, row: int) -> int:
        """Register of a row of an input."""
        if name == "state":
            return self.let("load", value=row)
        if name == "sample":
            return self.let("time")
        if name == "constants":
            return self.let("constant", value=row)
        draw, word = divmod(row, PER_DRAW)
        return self.let("uniform", self.leaf("draw", self.spec.streams[draw]), value=word)

    def _rows_read(self, j: int) -> Collection[int]:
        """State rows that a node reads from the workspace."""
        if j in self._reads:
            return range(self._reads[j].first, self._reads[j].first + self._reads[j].depth)
        row = rings.state_row(self.program, j)
        return () if row < 0 else (row,)

    def _compute(self, needed: set[int], wanted: Collection[int]) -> None:
        """Write some nodes, what is seldom needed behind a branch."""
        seldom = region(self.program, needed, self._kept, wanted)
        if seldom is not None:
            around = {*seldom.conditions, *(a for j in seldom.inside for a in self._arguments(j))} - seldom.inside
            self._write(self._needed(around))
            self._branch(seldom, needed)
        self._write({j for j in needed if j not in self.registers and (seldom is None or j not in seldom.inside)})

    def _branch(self, seldom: Region, needed: set[int]) -> None:
        """Write a region and the branch around it."""
        for draw in sorted(self._draws(seldom.inside) & self._draws(needed - seldom.inside)):
            self.leaf("draw", self.spec.streams[draw])
        mask = self.value(seldom.conditions[0])
        for condition in seldom.conditions[1:]:
            mask = self.let("or", mask, self.value(condition))
        number, before = next(self._skips), self.known()
        self.do("skip", mask, value=number)
        self._write(seldom.inside, store=False)
        inside = [self._as_number(node) for node in seldom.results]
        self.do("resume", value=number)
        self.recall(before)
        joined = [self.let("join", register, value=number) for register in inside]
        for node, register in zip(seldom.results, joined, strict=True):
            self.registers[node] = self._from_number(node, register)
        for node in seldom.inside:
            self._store(self._pending.ready(node))

    def _update(self, update: Update) -> None:
        """Write state rows that seldom change, and the branch around them."""
        number, before = next(self._skips), self.known()
        self.do("skip", self.value(update.condition), value=number)
        self._write(update.inside)
        self._store(self._pending.rest())
        self.do("resume", value=number)
        self.recall(before)
        self._renewed |= {self.program.outputs["state"][row]: row for row in update.rows}

    def _store(self, rows: Iterable[int]) -> None:
        """Write new state rows into the workspace."""
        for row in rows:
            self.do("store", self.value(self.program.outputs["state"][row]), value=row)

    def _draws(self, nodes: Collection[int]) -> set[int]:
        """Draws that some nodes take numbers of."""
        leaves = (self.program.nodes[j] for j in nodes if self.program.nodes[j].op == "input")
        return {row // PER_DRAW for name, row in (leaf.value for leaf in leaves) if name == "uniforms"}

    def _needed(self, wanted: Iterable[int]) -> set[int]:
        """Nodes that have to be computed in a sample for some of them."""
        left, seen = list(wanted), set[int]()
        while left:
            node = left.pop()
            if node not in seen and node not in self.registers and node not in self._renewed:
                seen.add(node)
                left.extend(self._arguments(node))
        return seen

    def _write(self, nodes: Collection[int], *, store: bool = True) -> None:
        """Write nodes in a good order, and store the state rows that are ready then."""
        nodes = {j for j in nodes if j not in self.registers}
        for j in longest_first(nodes, self._arguments, lambda j: latency(self.program, j, loaded=j in self._kept)):
            self.value(j)
            if store:
                self._store(self._pending.ready(j))

    def _arguments(self, node: int) -> tuple[int, ...]:
        """What a node needs inside the loop over samples."""
        if node in self._kept:
            return ()
        return (self._reads[node].index,) if node in self._reads else self.program.nodes[node].arguments

    def _as_number(self, node: int) -> int:
        """Register of a node's number, true and false as 1 and 0."""
        return self.let("number", self.value(node)) if self._boolean(node) else self.value(node)

    def _from_number(self, node: int, register: int) -> int:
        """The reverse."""
        return self.let("ne", register, self.leaf("literal", 0.0)) if self._boolean(node) else register

    def _boolean(self, node: int) -> bool:
        return OPERATIONS[self.program.nodes[node].op].result == "b"
