"""Named systems wired to one: an interconnection written as the figure that it is."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace, append

__all__ = ["Block", "wire"]

Wires = Mapping[str, Mapping[str, float]]
"""Weighted sum of signals, by the name of the signal that it makes."""


@dataclass(frozen=True)
class Block:
    """A system with names for its signals.

    Attributes
    ----------
    system : StateSpace
    inputs, outputs : sequences of str
        One name a signal; those of outputs are unlike all others in a figure.
    """

    system: StateSpace
    inputs: Sequence[str]
    outputs: Sequence[str]

    def __post_init__(self) -> None:
        """Refuse a number of names that is not that of the signals."""
        counts = (len(self.inputs), len(self.outputs))
        if counts != (self.system.n_inputs, self.system.n_outputs):
            raise DesignError(
                f"a system of {self.system.n_inputs} inputs and {self.system.n_outputs} outputs needs as many names, "
                f"got {', '.join(self.inputs)} and {', '.join(self.outputs)}"
            )


def wire(blocks: Sequence[Block], wires: Wires, *, inputs: Sequence[str], outputs: Wires) -> StateSpace:
    """One system from `inputs` to `outputs`; states are those of the blocks in their order.

    Parameters
    ----------
    blocks : sequence of Block
    wires : mapping of str to (mapping of str to float)
        What enters an input of a block: a weighted sum of outputs of blocks and of `inputs`. An input that is not named
        here takes the signal of its own name.
    inputs : sequence of str
        Signals from outside.
    outputs : mapping of str to (mapping of str to float)
        Signals to the outside, in their order, as weighted sums of outputs of blocks and of `inputs`.

    Raises
    ------
    DesignError
        A wire begins at a signal that is none, or the loop has no solution.

    Examples
    --------
    >>> lag = Block(StateSpace.diagonal([-1.0], [1.0], [1.0], [0.0]), ["order"], ["position"])
    >>> closed = wire([lag], {"order": {"c": 2.0, "position": -1.0}}, inputs=["c"], outputs={"e": {"position": 1.0, "c": -1.0}})
    >>> closed.at(0.0).real, closed.poles().real
    (array([[0.]]), array([-2.]))
    """
    whole = append(*(block.system for block in blocks))
    inside = [name for block in blocks for name in block.outputs]
    known = {name: column for column, name in enumerate([*inside, *inputs])}
    entering = _sums([wires.get(name, {name: 1.0}) for block in blocks for name in block.inputs], known)
    leaving = _sums(list(outputs.values()), known)
    n = len(inside)
    loop = np.eye(n) - whole.D @ entering[:, :n]
    if n and np.linalg.cond(loop) > 1e12:
        raise DesignError("the figure has a loop without any lag whose gain is one; put a lag into it")
    # signals of the blocks by states and by inputs: y = C x + D (W y + E w)
    by_state, by_input = np.linalg.solve(loop, whole.C), np.linalg.solve(loop, whole.D @ entering[:, n:])
    return StateSpace(
        whole.A + whole.B @ entering[:, :n] @ by_state,
        whole.B @ (entering[:, :n] @ by_input + entering[:, n:]),
        leaving[:, :n] @ by_state,
        leaving[:, :n] @ by_input + leaving[:, n:],
    )


def _sums(sums: Sequence[Mapping[str, float]], known: Mapping[str, int]) -> Floats:
    """Weights of sums, a row each, over the known signals."""
    rows = np.zeros((len(sums), len(known)))
    for row, weights in zip(rows, sums, strict=True):
        for name, weight in weights.items():
            if name not in known:
                raise DesignError(f"no signal of the figure is called {name!r}; known: {', '.join(known)}")
            row[known[name]] += weight
    return rows
