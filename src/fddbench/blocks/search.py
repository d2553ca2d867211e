"""Look-ups in constant tables as instructions that every target has."""

from typing import TYPE_CHECKING

import numpy as np

from fddbench.blocks.table import Table

if TYPE_CHECKING:
    from fddbench.blocks.stretch import Writer

__all__ = ["gather", "locate"]

_FEW = 64
"""Knots up to which comparing with all of them beats bisection, whose steps wait for each other and for memory."""


def locate(w: "Writer", knots: Table, x: int) -> int:
    """Register of how many knots lie at or below x; every comparison with not-a-number is false, so none."""
    return _compared(w, knots, x) if len(knots) <= _FEW else _bisected(w, knots, x)


def _compared(w: "Writer", knots: Table, x: int) -> int:
    found = w.leaf("literal", 0.0)
    for number, knot in enumerate(knots.values.tolist(), 1):
        below = w.let("le", w.leaf("literal", knot), x)
        found = w.let("select", below, w.leaf("literal", float(number)), found)
    return found


def _bisected(w: "Writer", knots: Table, x: int) -> int:
    """Bits of the answer from the highest to the lowest; behind the knots follows infinity, which only infinity reaches."""
    bits = len(knots).bit_length()
    padded = Table.of(np.pad(knots.values, (0, 2**bits - 1 - len(knots)), constant_values=np.inf))
    found = w.leaf("literal", 0.0)
    for bit in reversed(range(bits)):
        tried = w.let("add", found, w.leaf("literal", float(2**bit)))
        last = gather(w, padded, w.let("sub", tried, w.leaf("literal", 1.0)))
        found = w.let("select", w.let("le", last, x), tried, found)
    most = w.leaf("literal", float(len(knots)))
    return w.let("select", w.let("lt", most, found), most, found)


def gather(w: "Writer", table: Table, place: int) -> int:
    """Register of the entry at a place; tables of one length share the index of a place."""
    return w.let("gather", _index(w, place, len(table) - 1), value=w.shared.table(table))


def _index(w: "Writer", place: int, last: int) -> int:
    """Register of a place held between 0 and `last`; not-a-number is not above 0."""
    key = place, last
    if key not in w.indices:
        zero, most = w.leaf("literal", 0.0), w.leaf("literal", float(last))
        above = w.let("select", w.let("lt", zero, place), place, zero)
        w.indices[key] = w.let("index", w.let("select", w.let("lt", above, most), above, most))
    return w.indices[key]
