"""Writes nodes of a program as straight stretches of a plan: what kernels and repeated bodies have in common."""

from itertools import count
from typing import Any

from fddbench.blocks import search
from fddbench.blocks.plan import NOTHING, Instruction, Repeated
from fddbench.blocks.program import Program
from fddbench.blocks.repeat import Loop
from fddbench.blocks.rewrite import depends_only_on
from fddbench.blocks.schedule import latency, longest_first
from fddbench.blocks.table import Table

__all__ = ["Shared", "Writer"]


Known = tuple[dict[int, int], dict[tuple[int, int], int], dict[Any, int]]


class Shared:
    """Tables and functions of a kernel, by number."""

    def __init__(self) -> None:
        self.tables: dict[Table, int] = {}
        self.repeats: list[Repeated] = []
        self.numbers: dict[Loop, int] = {}

    def table(self, table: Table) -> int:
        """Number of a table."""
        return self.tables.setdefault(table, len(self.tables))

    def repeat(self, loop: Loop) -> int:
        """Number of the function of a loop."""
        if loop not in self.numbers:
            repeated = _Body(loop, self).repeated()  # may need others first
            self.numbers[loop] = len(self.repeats)
            self.repeats.append(repeated)
        return self.numbers[loop]


class Writer:
    """Writer of a program's nodes into straight stretches of instructions.

    Attributes
    ----------
    slots : int
        Vectors of workspace in use so far.
    registers, indices : dict
        Register of each node written, and of each place in a table of some length.
    """

    def __init__(self, program: Program, shared: Shared, slots: int) -> None:
        self.program, self.shared, self.slots = program, shared, slots
        self.registers: dict[int, int] = {}
        self.indices: dict[tuple[int, int], int] = {}
        self._leaves: dict[Any, int] = {}
        self._numbers = count()
        self._lines: list[Instruction] = []
        self._areas: dict[int, int] = {}

    def taken(self) -> tuple[Instruction, ...]:
        """Lines written since the last time."""
        lines, self._lines = tuple(self._lines), []
        return lines

    def let(self, op: str, *arguments: int, value: Any = None) -> int:
        """Register of a new result."""
        self._lines.append(Instruction(op, next(self._numbers), arguments, value))
        return self._lines[-1].result

    def do(self, op: str, *arguments: int, value: Any = None) -> None:
        """Write an instruction without a result."""
        self._lines.append(Instruction(op, NOTHING, arguments, value))

    def leaf(self, op: str, value: Any) -> int:
        """Register of a number or flag, written once."""
        key = op, repr(value)
        if key not in self._leaves:
            self._leaves[key] = self.let(op, value=value)
        return self._leaves[key]

    def forget(self) -> None:
        """Begin a stretch that shares no register with the one before."""
        self.recall(({}, {}, {}))

    def known(self) -> Known:
        """All registers so far."""
        return self.registers.copy(), self.indices.copy(), self._leaves.copy()

    def recall(self, known: Known) -> None:
        """Go on with these registers alone."""
        self.registers, self.indices, self._leaves = known

    def value(self, j: int) -> int:
        """Register of a node; written when first asked for."""
        if j not in self.registers:
            self.registers[j] = self.written(j)
        return self.registers[j]

    def written(self, j: int) -> int:
        """Register of a node, written now."""
        op, arguments, value = self.program.nodes[j]
        if op in {"literal", "flag"}:
            return self.leaf(op, value)
        if op == "input":
            return self.input(*value)
        if op == "row":
            self.value(arguments[0])
            return self.let("load", value=self._areas[arguments[0]] + value)
        if op == "repeat":
            return self._call(j, value, arguments)
        if op == "rarely":
            return self.value(arguments[0])
        if op == "locate":
            return search.locate(self, value, self.value(arguments[0]))
        if op == "gather":
            return search.gather(self, value, self.value(arguments[0]))
        return self.let(op, *(self.value(a) for a in arguments))

    def input(self, name: str, row: int) -> int:
        """Register of a row of an input."""
        raise NotImplementedError

    def _call(self, j: int, loop: Loop, arguments: tuple[int, ...]) -> int:
        """Call of a repeat on an area of its own."""
        number = self.shared.repeat(loop)
        area = self._areas[j] = self.slots
        self.slots += self.shared.repeats[number].slots
        for place, argument in enumerate(arguments):
            self.do("store", self.value(argument), value=area + place)
        self.do("call", value=(number, area))
        return NOTHING


class _Body(Writer):
    """Writer of a repeated body: x in the first vectors of its area, what is fixed behind."""

    def __init__(self, loop: Loop, shared: Shared) -> None:
        super().__init__(loop.body, shared, loop.rows + loop.body.inputs["fixed"])
        self.loop = loop

    def repeated(self) -> Repeated:
        """The function."""
        once, rows = depends_only_on(self.program, {"fixed"}), self.program.outputs["x"]
        for j, known in enumerate(once):
            if known:
                self.value(j)
        before = self.taken()
        inside = [j for j, known in enumerate(once) if not known]
        for j in longest_first(inside, lambda j: self.program.nodes[j].arguments, lambda j: latency(self.program, j)):
            self.value(j)
        for row, node in enumerate(rows):
            self.do("store", self.value(node), value=row)
        return Repeated(before=before, each=self.taken(), count=self.loop.count, slots=self.slots)

    def input(self, name: str, row: int) -> int:
        """Register of a row of x or of what is fixed."""
        return self.let("load", value=row if name == "x" else self.loop.rows + row)
