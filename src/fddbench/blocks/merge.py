"""States that start alike and change alike are one state: ten variants of a detector share what does not differ."""

from collections.abc import Hashable, Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fddbench.blocks.congruence import refined
from fddbench.blocks.program import Program, prune
from fddbench.blocks.rewrite import rebuilt
from fddbench.errors import FddbenchError

__all__ = ["check_alike", "expand_state", "merged", "shared", "shrink_state", "start_keys"]

Floats = npt.NDArray[np.float64]


def start_keys(start: Floats, mergeable: Sequence[bool]) -> list[Hashable]:
    """Keys for `merged` of some cases' start: the bits of a row that is the same in all of them, else the row's own number.

    Parameters
    ----------
    start : (n_state, n_cases) array
        State before sample 0 of one case or more.
    mergeable : sequence of bool
        Rows that may be merged at all; the others get a key of their own.
    """
    keys: list[Hashable] = []
    for row, (values, may) in enumerate(zip(np.asarray(start, dtype=float), mergeable, strict=True)):
        bits = {value.tobytes() for value in values} if may else set()
        keys.append(bits.pop() if len(bits) == 1 else row)
    return keys


def merged(program: Program, keys: Sequence[Hashable]) -> tuple[Program, list[int]]:
    """The same program with equal states flown once, and for each old state row the row that holds it now.

    Two rows are equal if they start alike and their updates are the same operations on equal rows.

    Parameters
    ----------
    program : Program
        Its states are the input and the output ``state``.
    keys : sequence of hashable
        One a state row; rows with the same key start with the same bits in every case, always.

    Raises
    ------
    FddbenchError
        There are not as many keys as rows.

    Examples
    --------
    >>> from fddbench.blocks.program import trace
    >>> twins = trace(lambda state: {"state": 0.5 * state + 1.0}, state=3)
    >>> small, classes = merged(twins, ["zero", "zero", "one"])
    >>> len(small.outputs["state"]), classes
    (2, [0, 0, 1])
    """
    if len(keys) != len(program.outputs["state"]):
        raise FddbenchError(f"need a key for each of the {len(program.outputs['state'])} state rows, got {len(keys)}")
    classes = refined(program, keys)
    if len(set(classes)) == len(classes):
        return program, classes
    # what has become equal may be simplified, and then more may be equal
    fewer, further = merged(shared(program, classes), [keys[row] for row in _first_rows(classes)])
    return fewer, [further[number] for number in classes]


def shrink_state(state: Floats, classes: Sequence[int]) -> Floats:
    """State of a merged program, (n_classes, n_cases), of the full one."""
    return state[_first_rows(classes)]


def expand_state(state: Floats, classes: Sequence[int]) -> Floats:
    """Full state, (n_state, n_cases), of that of a merged program."""
    return state[np.asarray(classes, dtype=np.int64)]


def check_alike(state: Floats, classes: Sequence[int]) -> None:
    """Check that merged rows have the same bits.

    Raises
    ------
    FddbenchError
        They do not, so the keys promised what is not true of these cases.
    """
    state = np.ascontiguousarray(state, dtype=float)
    twins = expand_state(shrink_state(state, classes), classes)
    differs = (state.view(np.int64) != twins.view(np.int64)).any(axis=1)
    if differs.any():
        row = int(np.flatnonzero(differs)[0])
        other = _first_rows(classes)[classes[row]]
        raise FddbenchError(
            f"state rows {other} and {row} were merged but differ at the start of a case; give rows the same key only if they "
            "start with the same bits in every case"
        )


def _first_rows(classes: Sequence[int]) -> list[int]:
    """First row of each class."""
    first: dict[int, int] = {}
    for row, number in enumerate(classes):
        first.setdefault(number, row)
    return [first[number] for number in range(len(first))]


def shared(program: Program, classes: Sequence[int]) -> Program:
    """The program with one state row a class, as `merged` gives it."""
    first = _first_rows(classes)
    outputs = {**program.outputs, "state": tuple(program.outputs["state"][row] for row in first)}
    fewer = replace(program, inputs={**program.inputs, "state": len(first)}, outputs=outputs)
    return prune(rebuilt(fewer, lambda graph, name, row: graph.input(name, classes[row]) if name == "state" else None))
