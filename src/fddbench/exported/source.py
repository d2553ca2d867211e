"""The source file: constants, functions of the language that C lacks, then the detector block by block, then the step."""

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from fddbench.exported.body import Body, Group, WrittenSection
from fddbench.exported.constants import Constants
from fddbench.exported.elementary import elementary, with_those_inside
from fddbench.exported.guards_c import guards_text
from fddbench.exported.interface import Interface
from fddbench.exported.layout_c import assignments_text, banner, comment, signature
from fddbench.exported.members import Members
from fddbench.exported.naming import Names, spoken, words_of_class
from fddbench.exported.primitives_c import primitives
from fddbench.exported.renewal import renewal
from fddbench.exported.rolling import Assignment
from fddbench.exported.sections import cut
from fddbench.exported.spelling import Spelling
from fddbench.exported.statements import Statement

__all__ = ["source_text"]

_NOBODY = Statement("", "", "")


def source_text(interface: Interface, members: Members, spelling: Spelling, *, head: Sequence[str]) -> str:
    """Text of the source file of a detector."""
    return "\n".join(_Source(interface, members, spelling).text(head)) + "\n"


@dataclass(frozen=True)
class _Function:
    """A static function of a block, and how it is called."""

    lines: tuple[str, ...]
    call: str


class _Source:
    def __init__(self, interface: Interface, members: Members, spelling: Spelling) -> None:
        self.interface, self.members, self.spelling = interface, members, spelling
        self.names, self.ops = Names(), set[str]()
        for taken in ("signals", *(f"{interface.name}_{each}" for each in ("init", "step", "usable", "sound"))):
            self.names.new(taken)
        self.constants = Constants(members, self.names, spelling)
        program = interface.program
        wanted = [node for rows in program.outputs.values() for node in rows]
        self.body = Body(
            program, cut(program), interface.leaves, wanted, constants=self.constants, names=self.names,
            spelling=spelling, calls=self.ops.add, known=_known(interface),
        )  # fmt: skip

    def text(self, head: Sequence[str]) -> Iterator[str]:
        """Lines of the file."""
        name, sections = self.interface.name, self.body.sections
        functions = list(self._functions(sections))
        functions += [self._outputs(), self._keep()]
        before, functions = self._placed(functions)
        if any("fdd_from_bits" in line for each in functions for line in each.lines):
            self.ops.add("from_bits")
        used = with_those_inside(self.ops)
        yield from head
        yield from (f'#include "{name}.h"', "", "#include <math.h>", "#include <string.h>", "")
        yield from _GUARDS
        if before:
            yield from ("", *banner("Constants of the design that several blocks need", []), "", *before)
        yield from ("", *self._signals(sections), "")
        for text in (*primitives(used, self.spelling), *elementary(used, self.spelling)):
            yield from (*text.split("\n"), "")
        for each in functions:
            yield from (*each.lines, "")
        yield from self._init()
        yield ""
        yield from guards_text(self.interface, self.spelling)
        yield ""
        yield from self._step(functions)

    def _placed(self, functions: Sequence[_Function]) -> tuple[list[str], list[_Function]]:
        """Constants that several functions need, and the functions with their own constants inside."""
        shared: list[str] = []
        inside: dict[int, list[str]] = {}
        texts = [re.sub(r"/\*.*?\*/", "", "\n".join(each.lines), flags=re.DOTALL) for each in functions]
        for name, lines in self.constants.definitions().items():
            users = [n for n, text in enumerate(texts) if re.search(rf"\b{name}\b", text)]
            if len(users) == 1:
                inside.setdefault(users[0], []).extend(f"    {line}" for line in lines)
            else:
                shared += lines
        placed = []
        for n, each in enumerate(functions):
            brace = each.lines.index("{") + 1
            own = [*inside[n], ""] if n in inside else []
            placed.append(_Function((*each.lines[:brace], *own, *each.lines[brace:]), each.call))
        return shared, placed

    def _signals(self, sections: Iterable[WrittenSection]) -> Iterator[str]:
        """Struct of what blocks hand to each other."""
        yield from banner("What the blocks of one step hand to each other, in the order in which it is computed", [])
        yield "typedef struct"
        yield "{"
        groups = [(section.block, group) for section in sections for group in section.groups if group.kept]
        for block, group in groups:
            kind = "bool" if group.boolean else self.spelling.real
            size = f"[{group.rows}]" if group.rows else ""
            yield f"    {kind} {group.name}{size}; /* {spoken(block).lower()} */"
        if not groups:
            yield f"    {self.spelling.real} nothing;"
        yield f"}} {self.interface.name}_signals_t;"

    def _functions(self, sections: Sequence[WrittenSection]) -> Iterator[_Function]:
        blocks, told = [section.block for section in sections], set[str]()
        for section in sections:
            base = "verdict" if section.block == "Adapted" else words_of_class(section.block) or "step"
            if blocks.count(section.block) > 1 and section.groups:
                base = f"{base}_{section.groups[-1].name}"
            lines = list(self._statements(section))
            title = "Alarm" if section.block == "Adapted" else spoken(section.block)
            if section.block == "Adapted":
                about = ["It is on while a site is declared faulty."]
            elif section.block in told:
                about = [f"Continued: {section.groups[-1].name.replace('_', ' ')}."]
            else:
                about = self.members.about(section.block)
            told.add(section.block)
            yield self._function(self.names.new(base), [title, *about], lines)

    def _statements(self, section: WrittenSection) -> Iterator[str]:
        for number, written in enumerate(section.statements):
            if not written.assignments:
                continue
            if number:
                yield ""
            text = written.statement.text
            yield from comment(f"{text} [{written.statement.place}]" if text else written.statement.place)
            declared: dict[str, str] = {}
            for group in written.groups:
                yield from self._declared(group, declared)
            yield from assignments_text(written.assignments, "    ", declared)

    def _declared(self, group: Group, declared: dict[str, str]) -> Iterator[str]:
        kind = "bool" if group.boolean else self.spelling.real
        if not group.kept and group.rows:
            yield f"    {kind} {group.name}[{group.rows}];"
        elif not group.kept:
            declared[group.name] = kind

    def _function(self, name: str, about: Sequence[str], lines: Sequence[str]) -> _Function:
        """A function of what its lines read and write."""
        own, text = self.interface.name, "\n".join(lines)
        writes_signals = any(
            " s->" in line.split(" = ")[0] or line.strip().startswith("s->") for line in lines if " = " in line
        )
        writes_state = any(line.strip().startswith("x->") for line in lines)
        parameters = {
            f"const {own}_inputs_t *in": "in" if "in->" in text else "",
            f"{'' if writes_state else 'const '}{own}_state_t *x": "x" if "x->" in text else "",
            f"{'' if writes_signals else 'const '}{own}_signals_t *s": "&s" if "s->" in text else "",
            f"{own}_outputs_t *out": "out" if "out->" in text else "",
        }
        used = {parameter: argument for parameter, argument in parameters.items() if argument}
        head = signature(f"static void {name}", list(used))
        counter = ["    uint32_t i;", ""] if "for (i" in text else []
        return _Function(
            (*banner(about[0], about[1:]), *head, "{", *counter, *lines, "}"), f"{name}({', '.join(used.values())});"
        )

    def _outputs(self) -> _Function:
        found = []
        for member in self.interface.outputs:
            for row, node in enumerate(self.interface.program.outputs[member.source]):
                found.append(Assignment(f"out->{member.at(row)}", self.body.text(node, _NOBODY).text))
        lines = list(assignments_text(found, "    ", {}))
        return self._function(self.names.new("give_outputs"), ["What the step gives"], lines)

    def _keep(self) -> _Function:
        rows = self.interface.program.outputs["state"]
        values = [self.body.text(node, _NOBODY).text for node in rows]
        lines = list(assignments_text(renewal(self.interface.state_places, values), "    ", {}))
        return self._function(self.names.new("keep_state"), ["What the next step needs"], lines)

    def _init(self) -> Iterator[str]:
        name = self.interface.name
        yield from banner("State before the first sample", [])
        yield f"void {name}_init({name}_state_t *x)"
        yield "{"
        start = [self.spelling.number(value) for value in self.interface.start.tolist()]
        lines = list(assignments_text(map(Assignment, self.interface.state_places, start), "    ", {}))
        if any("for (i" in line for line in lines):
            yield from ("    uint32_t i;", "")
        yield from lines or [f"    x->nothing = {self.spelling.number(0.0)};"]
        yield "}"

    def _step(self, functions: Iterable[_Function]) -> Iterator[str]:
        name = self.interface.name
        yield from banner(f"One sample: call it every {self.interface.step_s:g} s", [])
        yield from signature(
            f"void {name}_step", [f"const {name}_inputs_t *in", f"{name}_state_t *x", f"{name}_outputs_t *out"]
        )
        yield "{"
        yield f"    {name}_signals_t s;"
        yield ""
        for function in functions:
            if function.call.count("(") and not function.call.endswith("();"):
                yield f"    {function.call}"
        yield "}"


def _known(interface: Interface) -> dict[int, str]:
    """Names of nodes that leave the step: of the outputs and of the states that they become."""
    rows = interface.program.outputs
    found = {}
    places = [member for member in interface.state for _ in range(member.size)]
    for member, node in zip(places, rows["state"], strict=True):
        found[node] = member.name
    for member in interface.outputs:
        for node in rows[member.source]:
            if member.name not in {"alarm", "estimate"} or node not in found:
                found.setdefault(node, member.name)
    return found


_GUARDS = (
    "/* The bits are those of IEEE 754, operation by operation. Compile with -ffp-contract=off and without -ffast-math;",
    " * GCC 12 needs -fno-tree-slp-vectorize too where it may fuse operations (-O3 -march=native); the self-test tells. */",
    "#if defined(__FAST_MATH__)",
    "#error this file needs the arithmetic of IEEE 754: compile it without -ffast-math",
    "#endif",
    "#if defined(__FLT_EVAL_METHOD__)",
    "#if (__FLT_EVAL_METHOD__ != 0) && (__FLT_EVAL_METHOD__ != 16)",
    "#error this file needs each operation rounded to its own type: not for an x87, compile it with SSE",
    "#endif",
    "#endif",
)
