"""From a program to a plan: where everything lives, what is computed once, and in which order."""

from dataclasses import dataclass

from fddbench.blocks import rings
from fddbench.blocks.operations import OPERATIONS
from fddbench.blocks.philox import PER_DRAW
from fddbench.blocks.plan import Plan
from fddbench.blocks.program import Program
from fddbench.blocks.rewrite import depends_only_on
from fddbench.blocks.schedule import latency, longest_first
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

    def prologue(self) -> None:
        """Compute what depends on the constants alone, and keep what a sample needs of it."""
        nodes = self.program.nodes
        used = {a for j, node in enumerate(nodes) if not self._once[j] for a in node.arguments}
        used.update(node for rows in self.program.outputs.values() for node in rows)
        known = [j for j, node in enumerate(nodes) if self._once[j] and node.op not in {"literal", "flag"}]
        for j in known:
            register = self.value(j)
            if j in used:
                self._kept[j], self.slots = self.slots, self.slots + 1
                number = self.let("number", register) if self._boolean(j) else register
                self.do("store", number, value=self._kept[j])
        self.forget()

    def sample(self) -> tuple[int, ...]:
        """One sample: new state into the workspace, recorded rows into the tile; registers of ``finished``."""
        state = self.program.outputs["state"]
        ringed = {row for ring in self._writes for row in range(ring.first, ring.first + ring.depth)}
        moving = [row for row, node in enumerate(state) if row not in ringed and not self._still(row, node)]
        finished = self.program.outputs.get("finished", ())
        needed = [state[row] for row in moving]
        needed += [node for ring in self._writes for node in (ring.index, ring.value)]
        for j in self._order([*needed, *finished, *self.recorded]):
            self.value(j)
        for row in moving:
            self.do("store", self.value(state[row]), value=row)
        for ring in self._writes:
            self.do("ring_store", self.value(ring.index), self.value(ring.value), value=(ring.first, ring.depth))
        for number, node in enumerate(self.recorded):
            self.do("record", self.value(node), value=number)
        return tuple(self.value(node) for node in finished)

    def written(self, j: int) -> int:
        """Register of a node, written now: what the prologue has kept is loaded."""
        if j in self._kept:
            register = self.let("load", value=self._kept[j])
            return self.let("ne", register, self.leaf("literal", 0.0)) if self._boolean(j) else register
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

    def _still(self, row: int, node: int) -> bool:
        """Whether a state row stays as it is."""
        return bool(self.program.nodes[node].value == ("state", row))

    def _order(self, needed: list[int]) -> list[int]:
        """Nodes that a sample needs, in the order in which they are written."""
        seen = set[int]()
        while needed:
            node = needed.pop()
            if node not in seen:
                seen.add(node)
                needed.extend(self._arguments(node))
        return longest_first(seen, self._arguments, lambda j: latency(self.program, j, loaded=j in self._kept))

    def _arguments(self, node: int) -> tuple[int, ...]:
        """What a node needs inside the loop over samples."""
        if node in self._kept:
            return ()
        return (self._reads[node].index,) if node in self._reads else self.program.nodes[node].arguments

    def _boolean(self, node: int) -> bool:
        return OPERATIONS[self.program.nodes[node].op].result == "b"
