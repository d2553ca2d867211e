"""The statement of Python that an operation was traced from: what it computes, in the author's own words."""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

__all__ = ["Statement", "statement_at"]

_LONGEST = 150


@dataclass(frozen=True)
class Statement:
    """A line of a step.

    Attributes
    ----------
    name : str
        What it gives: the variable, the key or the function that it returns from; "" when nobody knows.
    text : str
        The line itself, short enough for a comment.
    place : str
        ``file.py:12``.
    words : tuple of str
        Names in it, then those behind local abbreviations (``g, T = self.gains, self.sample_s``).
    filename : str
        Its file.
    """

    name: str
    text: str
    place: str
    words: tuple[str, ...] = ()
    filename: str = field(default="", repr=False)


@cache
def statement_at(line: str) -> Statement:
    """Statement at ``file:line``; one without a name where the file cannot be read."""
    filename, _, number = line.rpartition(":")
    place, tree = f"{Path(filename).name}:{number}", _tree(filename)
    if tree is None or not number:
        return Statement("", "", place, filename=filename)
    around = list(_around(tree, int(number)))
    functions = [node for node in around if isinstance(node, ast.FunctionDef)]
    statement = next((node for node in reversed(around) if isinstance(node, ast.stmt)), None)
    if statement is None or not functions:
        return Statement("", "", place, filename=filename)
    name, value = _named(statement, around, functions[-1].name)
    text = _readable(ast.unparse(value))
    words = re.findall(r"[A-Za-z_]\w*", text)
    behind = [each for short, full in _abbreviations(functions[-1]) if short in words for each in sorted(full)]
    return Statement(name, _short(name, text), place, tuple(dict.fromkeys((*words, *behind))), filename)


@cache
def _tree(filename: str) -> ast.Module | None:
    try:
        return ast.parse(Path(filename).read_text(encoding="utf-8-sig"))
    except (OSError, SyntaxError, ValueError):
        return None


def _around(tree: ast.AST, number: int) -> Iterator[ast.AST]:
    """Nodes that a line lies in, from the outside in."""
    for node in ast.iter_child_nodes(tree):
        first, last = getattr(node, "lineno", None), getattr(node, "end_lineno", None)
        if first is None or last is None:
            yield from _around(node, number)
        elif first <= number <= last:
            yield node
            yield from _around(node, number)


def _named(statement: ast.stmt, around: list[ast.AST], function: str) -> tuple[str, ast.AST]:
    """Name of what a statement gives, and the expression that gives it."""
    for node in reversed(around[around.index(statement) + 1 :]):  # one entry of many lines: its key says what it is
        if isinstance(node, ast.keyword) and node.arg and not isinstance(node.value, ast.Name):
            return node.arg, node.value
    if isinstance(statement, ast.Assign | ast.AnnAssign | ast.AugAssign) and statement.value is not None:
        target = statement.targets[0] if isinstance(statement, ast.Assign) else statement.target
        return _first_name(target), statement.value
    function = "" if function == "step" else function.strip("_")
    if isinstance(statement, ast.Return) and statement.value is not None:
        return function, statement.value
    header = getattr(statement, "iter", None) or getattr(statement, "test", None) or getattr(statement, "value", None)
    return function, header or statement


def _first_name(target: ast.expr) -> str:
    names = [node for node in ast.walk(target) if isinstance(node, ast.Name | ast.Attribute)]
    first = names[0] if names else None
    return first.id if isinstance(first, ast.Name) else first.attr if isinstance(first, ast.Attribute) else ""


def _abbreviations(function: ast.FunctionDef) -> Iterator[tuple[str, set[str]]]:
    """Names of the function, and the attributes that they stand for."""
    for node in ast.walk(function):
        if isinstance(node, ast.Assign):
            for target in node.targets:
                pairs: list[tuple[ast.expr, ast.expr]] = [(target, node.value)]
                if isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple):
                    pairs = list(zip(target.elts, node.value.elts, strict=False))
                for name, value in pairs:
                    if isinstance(name, ast.Name):
                        yield name.id, {each.attr for each in ast.walk(value) if isinstance(each, ast.Attribute)}


def _readable(text: str) -> str:
    """Python as a formula: no prefixes, no characters that a comment of C cannot hold."""
    text = re.sub(r"\b(np|self|measured|m)\.", "", text)
    return text.replace("//", "div").replace("/*", "/ *").replace("*/", "* /").encode("ascii", "replace").decode()


def _short(name: str, text: str) -> str:
    whole = f"{name} = {text}" if name else text
    return whole if len(whole) <= _LONGEST else whole[: _LONGEST - 4].rsplit(" ", 1)[0] + " ..."
