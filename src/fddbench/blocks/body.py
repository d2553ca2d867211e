"""LLVM text of one sample of a step: values in registers, state and what is constant in a workspace."""

from dataclasses import dataclass

from fddbench.blocks import draws, rings
from fddbench.blocks.emit import Vectors
from fddbench.blocks.operations import OPERATIONS
from fddbench.blocks.philox import PER_DRAW
from fddbench.blocks.program import Program
from fddbench.blocks.rewrite import depends_only_on
from fddbench.blocks.schedule import LATENCIES, longest_first

__all__ = ["Body", "Spec"]

_DRAW, _LOAD = 60, 3  # cycles: the ten rounds of Philox; a vector of the workspace


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

    @property
    def n_state(self) -> int:
        """Rows of the state."""
        return len(self.program.outputs["state"])

    @property
    def slots(self) -> int:
        """Vectors of workspace: the state, whatever depends on the constants alone, and one to write to in vain."""
        return self.n_state + len(self.program.nodes) + 1

    @property
    def recorded_nodes(self) -> list[int]:
        """Nodes stored at every sample."""
        return [node for name in self.recorded for node in self.program.outputs[name]]


class Body:
    """Writer of a step's operations.

    Parameters
    ----------
    spec : Spec
        Workspace slot j holds state row j; those behind hold what `prologue` computes.
    out : Vectors
        Where instructions go.
    """

    def __init__(self, spec: Spec, out: Vectors) -> None:
        self.spec, self.out = spec, out
        self._once = depends_only_on(spec.program, {"constants"})
        self._slots: dict[int, int] = {}
        self._names: dict[int, str] = {}
        self._words: dict[int, list[str]] = {}
        self._reads = rings.reads(spec.program)
        self._writes = rings.writes(spec.program)

    def prologue(self) -> None:
        """Compute what depends on the constants alone, once a block."""
        o, nodes = self.out, self.spec.program.nodes
        used = {a for j, node in enumerate(nodes) if not self._once[j] for a in node.arguments}
        used.update(node for rows in self.spec.program.outputs.values() for node in rows)
        kept = [j for j, node in enumerate(nodes) if self._once[j] and node.op not in {"literal", "flag"}]
        for j in kept:
            name = self.value(j)
            if j in used:
                number = o.operation("number", name) if _boolean(nodes[j].op) else name
                slot = self.spec.n_state + len(self._slots)
                self._slots[j] = slot
                o.do(f"store {o.V} {number}, ptr {self._slot(str(slot))}, align {o.bytes}")
        self._names.clear()

    def sample(self) -> None:
        """One sample: new state in the workspace, recorded rows in the tile."""
        o, state = self.out, self.spec.program.outputs["state"]
        for j in self._order():
            self.value(j)
        ringed = {row for ring in self._writes for row in range(ring.first, ring.first + ring.depth)}
        for row, node in enumerate(state):
            if row not in ringed and self.spec.program.nodes[node].value != ("state", row):
                o.do(f"store {o.V} {self.value(node)}, ptr {self._slot(str(row))}, align {o.bytes}")
        for ring in self._writes:
            o.do(f"store {o.V} {self.value(ring.value)}, ptr {self._slot(self._turn(ring))}, align {o.bytes}")
        for number, node in enumerate(self.spec.recorded_nodes):
            self._record(number, node)

    def value(self, j: int) -> str:
        """Name of the value of a node; written when first asked for."""
        op, arguments, literal = self.spec.program.nodes[j]
        o = self.out
        if op == "literal":
            return o.number(literal)
        if op == "flag":
            return o.flag(bool(literal))
        if j not in self._names:
            if j in self._slots:
                name = self._load(str(self._slots[j]))
                name = o.operation("ne", name, o.number(0.0)) if _boolean(op) else name
            elif op == "input":
                name = self._input(*literal)
            elif j in self._reads:
                name = self._load(self._place(self._reads[j]))
            else:
                name = o.operation(op, *(self.value(a) for a in arguments))
            self._names[j] = name
        return self._names[j]

    def _order(self) -> list[int]:
        """Nodes that a sample needs, in the order they are written."""
        program, seen = self.spec.program, set[int]()
        ringed = {row for ring in self._writes for row in range(ring.first, ring.first + ring.depth)}
        left = [node for row, node in enumerate(program.outputs["state"]) if row not in ringed]
        left += [node for ring in self._writes for node in (ring.index, ring.value)]
        left += [*program.outputs.get("finished", ()), *self.spec.recorded_nodes]
        while left:
            node = left.pop()
            if node not in seen:
                seen.add(node)
                left.extend(self._arguments(node))
        return longest_first(seen, self._arguments, self._latency)

    def _latency(self, node: int) -> int:
        """Cycles until a node's value can be used."""
        op, _, value = self.spec.program.nodes[node]
        if op == "input" and value[0] == "uniforms":
            return _DRAW
        return _LOAD if op == "input" or node in self._slots else LATENCIES.get(op, 2)

    def _arguments(self, node: int) -> tuple[int, ...]:
        """What a node needs inside the loop over samples."""
        if node in self._slots:
            return ()
        return (self._reads[node].index,) if node in self._reads else self.spec.program.nodes[node].arguments

    def _input(self, name: str, row: int) -> str:
        o = self.out
        if name == "state":
            return self._load(str(row))
        if name == "sample":
            return o.spread("double", "%time")
        if name == "constants":
            index = o.let(f"add i64 {o.let(f'mul i64 %n, {row}')}, %o")
            return o.let(
                f"load {o.V}, ptr {o.let(f'getelementptr inbounds double, ptr %constants, i64 {index}')}, align 8"
            )
        draw, word = divmod(row, PER_DRAW)
        if draw not in self._words:
            self._words[draw] = draws.words(o, *self.spec.streams[draw])
        return draws.uniform(o, self._words[draw][word])

    def _slot(self, number: str) -> str:
        """Address of a vector of the workspace."""
        return self.out.let(f"getelementptr inbounds {self.out.V}, ptr %work, i64 {number}")

    def _load(self, number: str) -> str:
        return self.out.let(f"load {self.out.V}, ptr {self._slot(number)}, align {self.out.bytes}")

    def _whole(self, index: int) -> tuple[str, str]:
        """Index of all lanes as a double and as an integer."""
        double = self.out.let(f"extractelement {self.out.V} {self.value(index)}, i64 0")
        return double, self.out.let(f"fptosi double {double} to i64")

    def _place(self, ring: rings.Ring) -> str:
        """State row to read: the first or last one outside the ring."""
        o = self.out
        _, whole = self._whole(ring.index)
        for comparison, limit in (("sgt", 0), ("slt", ring.depth - 1)):
            whole = o.let(f"select i1 {o.let(f'icmp {comparison} i64 {whole}, {limit}')}, i64 {whole}, i64 {limit}")
        return o.let(f"add i64 {whole}, {ring.first}")

    def _turn(self, ring: rings.Ring) -> str:
        """State row to write: the slot nobody reads when it is no row's turn."""
        o = self.out
        double, whole = self._whole(ring.index)
        equal = o.let(f"fcmp oeq double {o.let(f'sitofp i64 {whole} to double')}, {double}")
        inside = o.let(f"and i1 {equal}, {o.let(f'icmp ult i64 {whole}, {ring.depth}')}")
        row = o.let(f"add i64 {whole}, {ring.first}")
        return o.let(f"select i1 {inside}, i64 {row}, i64 {self.spec.slots - 1}")

    def _record(self, number: int, node: int) -> None:
        """Store a recorded row, not-a-number where the flight is over."""
        o = self.out
        value = o.let(f"select {o.M} %active, {o.V} {self.value(node)}, {o.V} {o.number(float('nan'))}")
        time = o.let(f"mul i64 {o.let('sub i64 %k, %first')}, {len(self.spec.recorded_nodes)}")
        line = o.let(f"add i64 {time}, {number}")
        index = o.let(f"add i64 {o.let(f'mul i64 {line}, %n')}, %o")
        o.do(f"store {o.V} {value}, ptr {o.let(f'getelementptr inbounds double, ptr %tile, i64 {index}')}, align 8")


def _boolean(op: str) -> bool:
    return OPERATIONS[op].result == "b"
