"""Turns the fields of a system into matrices and names all that do not fit, with both shapes, at once."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.systems.errors import MisfitError

__all__ = ["Matrix", "adopt", "misfits", "refuse"]

Matrix = npt.NDArray[np.float64]


def misfits(
    shapes: Mapping[str, tuple[int, ...]], layout: Mapping[str, str], counted: Mapping[str, str]
) -> tuple[list[str], dict[str, int]]:
    """Sentences about all that does not fit, and the size of every letter.

    Parameters
    ----------
    shapes : mapping of str to tuple of int
        Shapes by name; only the first two axes count.
    layout : mapping of str to str
        Letters of rows and columns by name, in the order in which a size is first believed.
    counted : mapping of str to str
        What a letter counts, in the plural.
    """
    mistakes: list[str] = []
    sizes: dict[str, tuple[int, str]] = {}
    for name in (name for name in layout if name in shapes):
        for axis, letter in enumerate(layout[name]):
            own = shapes[name][axis]
            size, first = sizes.setdefault(letter, (own, name))
            if own != size:
                what = ("rows", "columns")[axis]
                mistakes.append(
                    f"{name} {shapes[name]} has {own} {what} but {first} {shapes[first]} "
                    f"has {size} {counted[letter]}; they must agree"
                )
    return mistakes, {letter: size for letter, (size, _) in sizes.items()}


def adopt(system: Any, layout: Mapping[str, str], counted: Mapping[str, str]) -> None:
    """Turn the fields of a frozen system into float matrices, zero where they are None; `layout` as in `misfits`.

    Raises
    ------
    MisfitError
        A field is no finite matrix, or two do not fit.
    """
    given = {name: getattr(system, name) for name in layout if getattr(system, name) is not None}
    matrices = {name: np.array(value, dtype=float) for name, value in given.items()}
    wrong = [name for name, matrix in matrices.items() if matrix.ndim != 2 or not np.all(np.isfinite(matrix))]
    mistakes = [
        f"{name} must be a finite matrix with two axes, got shape {matrices[name].shape}: {given[name]!r:.80}"
        for name in wrong
    ]
    found, sizes = misfits({name: m.shape for name, m in matrices.items() if name not in wrong}, layout, counted)
    refuse(type(system).__name__, mistakes + found)
    for name, letters in layout.items():
        shape = tuple(sizes.get(letter, 0) for letter in letters)
        object.__setattr__(system, name, matrices.get(name, np.zeros(shape)))


def refuse(name: str, mistakes: Iterable[str]) -> None:
    """Raise a `MisfitError` that lists the mistakes, if there are any."""
    mistakes = list(mistakes)
    if mistakes:
        raise MisfitError(f"{name} does not fit together:\n  " + "\n  ".join(mistakes))
