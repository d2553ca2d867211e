"""Compiled C that steps like a program of the engine: rows in, rows out."""

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from fddbench.exported.child import Child, CodeError
from fddbench.exported.interface import Interface, Member

__all__ = ["FlownC"]

Floats = npt.NDArray[np.float64]


class FlownC:
    """A child that speaks the interface of a detector.

    Parameters
    ----------
    interface : Interface
        What its header says.
    child : Child
        The running code.

    Attributes
    ----------
    start : (n_words,) array
        State before the first sample; its bytes in words of eight, whatever they mean to the code.

    Raises
    ------
    CodeError
        Its structs have other sizes than the interface.
    """

    def __init__(self, interface: Interface, child: Child) -> None:
        self.interface, self.child = interface, child
        n_in, n_out = (max(sum(m.size for m in part), 1) for part in (interface.inputs, interface.outputs))
        self.bytes = 4 if child.inputs_size == 4 * n_in and child.outputs_size == 4 * n_out else 8
        if (child.inputs_size, child.outputs_size) != (self.bytes * n_in, self.bytes * n_out):
            raise CodeError(
                "error",
                f"inputs and outputs of the code take {child.inputs_size} and {child.outputs_size} bytes, the interface of "
                f"{interface.name} has {n_in} and {n_out} numbers; take its header as fddbench export writes it",
            )
        self._real = np.dtype(f"{child.number_type}f{self.bytes}")
        self._pad = -child.state_size % 8
        self.start = self._words(child.start[np.newaxis])[0]

    @property
    def words(self) -> int:
        """Rows of the state."""
        return len(self.start)

    def step(self, state: Floats, inputs: Mapping[str, Floats]) -> tuple[Floats, dict[str, Floats]]:
        """State and outputs by member, (n_rows, n_flights) each, after a sample of inputs by signal, (n_rows, n_flights).

        A single signal is (n_flights,), as everywhere.
        """
        n = state.shape[1]
        rows = [np.atleast_2d(inputs[m.source]) for m in self.interface.inputs] or [np.zeros((1, n))]
        given = np.ascontiguousarray(np.concatenate(rows).T.astype(self._real)).view(np.uint8)
        kept = np.ascontiguousarray(state.T).view(np.uint8)[:, : self.child.state_size]
        after, out = self.child.step(kept, given)
        numbers = np.ascontiguousarray(out).view(self._real).astype(float).T
        return self._words(after).T, dict(_members(self.interface.outputs, numbers))

    def _words(self, state: npt.NDArray[np.uint8]) -> Floats:
        whole = np.pad(state, ((0, 0), (0, self._pad))) if self._pad else state
        return np.ascontiguousarray(whole).view(np.float64)


def _members(members: tuple[Member, ...], numbers: Floats) -> list[tuple[str, Floats]]:
    found, row = [], 0
    for member in members:
        found.append((member.source, numbers[row : row + member.size]))
        row += member.size
    return found
