"""The statements of a program as C: what is kept gets the name its author gave it, what is used once is written in place."""

import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby

from fddbench.blocks.operations import OPERATIONS
from fddbench.blocks.program import Program
from fddbench.exported.constants import Constants
from fddbench.exported.naming import OPERATION_WORDS, Names, words_of_class
from fddbench.exported.rolling import Assignment
from fddbench.exported.sections import Cut, Line, Section
from fddbench.exported.spelling import Spelling, Text
from fddbench.exported.statements import Statement

__all__ = ["Body", "Group", "Written", "WrittenSection"]

_IN_PLACE, _CHAIN = 9, 48
"""Names in an expression above which it gets a name; of a sum, which reads well when it is long."""
_OUTSIDE = -1
_PLAIN = re.compile(r"[\w.]+ [-+*/] [\w.]+")


@dataclass(frozen=True)
class Group:
    """Results of one kind of a statement: one number, or an array of them; `kept` ones are seen by other blocks."""

    name: str
    nodes: tuple[int, ...]
    boolean: bool
    kept: bool

    @property
    def rows(self) -> int:
        """Length of the array, 0 for a single number."""
        return len(self.nodes) if len(self.nodes) > 1 else 0


@dataclass(frozen=True)
class Written:
    """A statement in C: what it declares, and what it assigns."""

    statement: Statement
    groups: tuple[Group, ...]
    assignments: tuple[Assignment, ...]


@dataclass
class WrittenSection:
    """A section in C."""

    block: str
    statements: list[Written] = field(default_factory=list)

    @property
    def groups(self) -> list[Group]:
        """Everything it gives a name."""
        return [group for written in self.statements for group in written.groups]


class Body:
    """Text of every operation of a program.

    Parameters
    ----------
    program, cut : Program, Cut
        What is written, and where it is cut.
    leaves : mapping of (str, int) to str
        How each input row is read.
    wanted : collection of int
        Nodes that are needed after the last section.
    calls : callable
        Told every operation that is written, so that the functions behind it are there.
    alone : bool
        It is one function, whose results are its own.
    known : mapping of int to str
        Names of nodes that have one already, because they leave the step.
    """

    def __init__(
        self, program: Program, cut: Cut, leaves: Mapping[tuple[str, int], str], wanted: Iterable[int], *,
        constants: Constants, names: Names, spelling: Spelling, calls: Callable[[str], None], alone: bool = False,
        known: Mapping[int, str] | None = None,
    ) -> None:  # fmt: skip
        self.program, self.cut, self.leaves, self.constants = program, cut, leaves, constants
        self.names, self.spelling, self.calls, self.alone = names, spelling, calls, alone
        self._known = {cut.alias[node]: name for node, name in (known or {}).items()}
        self._texts: dict[int, Text] = {}
        self._section_of = {
            j: n for n, section in enumerate(cut.sections) for line in section.lines for j in line.nodes
        }
        lines = [line for section in cut.sections for line in section.lines]
        self._line_of = {j: n for n, line in enumerate(lines) for j in line.nodes}
        self._beside = self._literals_beside()
        self._uses: dict[int, list[int]] = {j: [] for j in range(len(program.nodes))}
        for j in self._line_of:
            for argument in program.nodes[j].arguments:
                self._uses[cut.alias[argument]].append(j)
        for node in wanted:
            self._uses[cut.alias[node]].append(_OUTSIDE)
        self.sections = [self._section(section) for section in cut.sections]

    def text(self, node: int, statement: Statement, beside: Sequence[float] = ()) -> Text:
        """Expression of a node, as a statement writes it."""
        node = self.cut.alias[node]
        op, _, value = self.program.nodes[node]
        if op == "literal":
            return Text(self.constants.text(value, statement, beside))
        if op == "flag":
            return Text("true" if value else "false")
        return Text(self.leaves[value]) if op == "input" else self._texts[node]

    def _literals_beside(self) -> dict[tuple[int, str], tuple[float, ...]]:
        """Numbers that the operations of one kind of a line take."""
        found: dict[tuple[int, str], list[float]] = defaultdict(list)
        for j, line in self._line_of.items():
            op, arguments, _ = self.program.nodes[j]
            kinds = [self.program.nodes[self.cut.alias[a]] for a in arguments]
            found[line, op] += [node.value for node in kinds if node.op == "literal"]
        return {key: tuple(values) for key, values in found.items()}

    def boolean(self, node: int) -> bool:
        """Whether a node is true or false."""
        return OPERATIONS[self.program.nodes[self.cut.alias[node]].op].result == "b"

    def _section(self, section: Section) -> WrittenSection:
        written = WrittenSection(section.block)
        for line in section.lines:
            written.statements.append(self._statement(line, section.block))
        return written

    def _statement(self, line: Line, block: str) -> Written:
        found, forced = None, set[int]()
        while found is None:
            before = self.names.given
            found = self._tried(line, block, forced)
            if found is None:
                self.names.given = before
        return found

    def _tried(self, line: Line, block: str, forced: set[int]) -> Written | None:
        """The statement; None where something must get a name first, which is `forced` then."""
        named: list[int] = []
        values: dict[int, str] = {}
        # first which get a name, then the names, for an expression needs those of all before it
        weight: dict[int, int] = {}
        for j in line.nodes:
            weight[j] = sum(weight.get(self.cut.alias[a], 1) for a in self.program.nodes[j].arguments)
            if j in forced or not self._in_place(j, weight[j]):
                named.append(j)
                weight[j] = 1
        groups = self._groups(named, line, block)
        for j in line.nodes:
            text = self._expression(j, line.statement)
            unclear = self._unclear(j)
            if unclear - forced:
                forced |= unclear
                return None
            if j in groups:
                values[j] = text.text
                group, row = groups[j]
                name = f"s->{group.name}" if group.kept else group.name
                text = Text(f"{name}[{row}U]" if group.rows else name)
            self._texts[j] = text
        ordered = list(dict.fromkeys(group for group, _ in groups.values()))
        return Written(line.statement, tuple(ordered), tuple(Assignment(self._texts[j].text, values[j]) for j in named))

    def _in_place(self, j: int, weight: int) -> bool:
        """Whether an operation is written where it is used: once, in the same statement, and not too long."""
        uses = self._uses[j]
        if len(uses) != 1 or uses[0] == _OUTSIDE or self._line_of[uses[0]] != self._line_of[j]:
            return False
        user = self.program.nodes[uses[0]].op
        if user in {"pick", "repeat", "row"} or self.program.nodes[j].op in {"pick", "repeat", "row"}:
            return False
        chain = self.program.nodes[j].op in {"add", "sub"} and user in {"add", "sub"}
        return weight <= (_CHAIN if chain else _IN_PLACE)

    def _groups(self, named: Sequence[int], line: Line, block: str) -> dict[int, tuple[Group, int]]:
        """Array or number that each named node belongs to, and its row there; the last group has the statement's name."""
        base = line.statement.name or words_of_class(block) or "value"
        kinds = [(kind, tuple(nodes)) for kind, nodes in groupby(named, self._kind)]
        found: dict[int, tuple[Group, int]] = {}
        for number, ((op, known), nodes) in enumerate(kinds):
            last = number == len(kinds) - 1
            name = self.names.new(known or (base if last else f"{base}_{OPERATION_WORDS[op]}"))
            section = self._section_of[nodes[0]]
            uses = [use for j in nodes for use in self._uses[j]]
            kept = not self.alone and any(use == _OUTSIDE or self._section_of[use] != section for use in uses)
            group = Group(name, nodes, self.boolean(nodes[0]), kept)
            found |= {j: (group, row) for row, j in enumerate(nodes)}
        return found

    def _unclear(self, j: int) -> set[int]:
        """Plain sums and products that a choice takes, which checkers of rule 12.1 take for unclear."""
        node = self.program.nodes[j]
        if node.op != "select":
            return set()
        inside = (self.cut.alias[a] for a in node.arguments[1:])
        return {a for a in inside if a in self._texts and _PLAIN.fullmatch(self._texts[a].text)}

    def _kind(self, node: int) -> tuple[str, str]:
        return self.program.nodes[node].op, self._known.get(node, "")

    def _expression(self, j: int, statement: Statement) -> Text:
        op, arguments, value = self.program.nodes[j]
        own = [self.text(a, statement, self._beside[self._line_of[j], op]) for a in arguments]
        self.calls(op)
        if op in {"locate", "gather"}:
            if not len(value):
                return Text(self.spelling.number(0.0))
            return Text(f"fdd_{op}({self.constants.table(value)}, {len(value)}U, {own[0].text})", "", own[0].leaves + 1)
        if op == "pick":
            rows = ", ".join(each.text for each in own[1:])
            return Text(
                f"fdd_pick((const {self.spelling.real}[{len(own) - 1}]){{{rows}}}, {len(own) - 1}U, {own[0].text})"
            )
        return self.spelling.apply(op, own)
