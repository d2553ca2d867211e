"""A program cut into sections, a block of the detector each, and into the statements that its author wrote."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby

from fddbench.blocks.program import Program
from fddbench.exported.statements import Statement, statement_at

__all__ = ["Cut", "Line", "Section", "cut"]


@dataclass(frozen=True)
class Line:
    """Operations of one statement, in order.

    Attributes
    ----------
    statement : Statement
        What was written.
    nodes : tuple of int
        Its operations.
    """

    statement: Statement
    nodes: tuple[int, ...]


@dataclass(frozen=True)
class Section:
    """Operations that one block does at one time.

    Attributes
    ----------
    block : str
        Class of the block whose step was running; "" outside any.
    lines : tuple of Line
        Its statements.
    """

    block: str
    lines: tuple[Line, ...]


@dataclass(frozen=True)
class Cut:
    """A program in sections.

    Attributes
    ----------
    sections : tuple of Section
        In the order in which the detector steps its blocks.
    alias : tuple of int
        For each node the one that holds its value: what is said to be `rarely` true is just true.
    """

    sections: tuple[Section, ...]
    alias: tuple[int, ...]


def cut(program: Program) -> Cut:
    """Sections of a program."""
    alias = list(range(len(program.nodes)))
    for j, node in enumerate(program.nodes):
        if node.op == "rarely":
            alias[j] = alias[node.arguments[0]]
    operations = [j for j, node in enumerate(program.nodes) if node.arguments and node.op != "rarely"]
    origins = program.origins or (None,) * len(program.nodes)

    def of(j: int, what: str) -> str:
        return getattr(origins[j], what, "")

    sections = []
    for name, inside in groupby(operations, lambda j: of(j, "block")):
        lines = (Line(statement_at(where), tuple(nodes)) for where, nodes in groupby(inside, lambda j: of(j, "line")))
        sections.append(Section(name.rsplit(".", 1)[-1], tuple(_merged(lines))))
    return Cut(tuple(sections), tuple(alias))


def _merged(lines: Iterator[Line]) -> Iterator[Line]:
    """Lines, those that take turns for the rows of one statement joined."""
    for _, alike in groupby(lines, lambda line: (line.statement.text, line.statement.place)):
        first, *others = alike
        yield Line(first.statement, sum((line.nodes for line in others), first.nodes))
