"""Lines of C: wrapped, indented, with comments."""

import re
import textwrap
from collections.abc import Iterable, Iterator, Sequence

from fddbench.exported.rolling import Assignment, Loop, rolled

__all__ = ["COLUMNS", "assignments_text", "banner", "comment", "signature", "wrapped"]

COLUMNS = 100
_BREAK = re.compile(r"(?<= )(?=[-+*/?:<>=!]=? )|(?<= )(?=&& |\|\| )")


def comment(text: str, indent: str = "    ") -> list[str]:
    """A comment of one or several lines."""
    clean = text.encode("ascii", "replace").decode().replace("*/", "* /").replace("/*", "/ *").replace("//", "/ /")
    lines = textwrap.wrap(clean, COLUMNS - len(indent) - 6) or [""]
    if len(lines) == 1:
        return [f"{indent}/* {lines[0]} */"]
    return [f"{indent}/* {lines[0]}", *(f"{indent} * {line}" for line in lines[1:-1]), f"{indent} * {lines[-1]} */"]


def banner(title: str, paragraphs: Sequence[str]) -> list[str]:
    """The comment above a function: what it is, in paragraphs."""
    lines = ["/*", f" * {title}"]
    for paragraph in paragraphs:
        clean = " ".join(paragraph.split()).encode("ascii", "replace").decode()
        clean = clean.replace("*/", "* /").replace("/*", "/ *").replace("//", "/ /").replace("``", "").replace("`", "")
        if clean:
            lines += [" *", *(f" * {line}" for line in textwrap.wrap(clean, COLUMNS - 4))]
    return [*lines, " */"]


def signature(name: str, parameters: Sequence[str]) -> list[str]:
    """Head of a function, a parameter a line where they do not fit."""
    whole = f"{name}({', '.join(parameters) or 'void'})"
    if len(whole) <= COLUMNS:
        return [whole]
    *first, last = parameters
    return [f"{name}(", *(f"    {each}," for each in first), f"    {last})"]


def wrapped(line: str, indent: str) -> list[str]:
    """A line broken before its operators, the rest indented once more."""
    whole = f"{indent}{line}"
    if len(whole) <= COLUMNS:
        return [whole]
    pieces, lines, current = _pieces(line), [], indent
    for piece in pieces:
        if len(current) + len(piece.rstrip()) > COLUMNS and current.strip():
            lines.append(current.rstrip())
            current = indent + "    "
        current += piece
    return [*lines, current.rstrip()]


def _pieces(line: str) -> list[str]:
    found: list[str] = []
    for part in _BREAK.split(line):
        found += re.split(r"(?<=, )", part)
    return [piece for piece in found if piece]


def assignments_text(assignments: Iterable[Assignment], indent: str, declared: dict[str, str]) -> Iterator[str]:
    """Assignments as lines, loops where they step alike; `declared` are numbers declared where they are assigned, by type."""
    for each in rolled(list(assignments)):
        if isinstance(each, Loop):
            yield f"{indent}{each.head}"
            yield f"{indent}{{"
            yield from wrapped(f"{each.body.target} = {each.body.value};", indent + "    ")
            yield f"{indent}}}"
        else:
            kind = declared.get(each.target)
            yield from wrapped(f"{f'const {kind} ' if kind else ''}{each.target} = {each.value};", indent)
