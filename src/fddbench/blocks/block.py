"""The one shape of everything that flies, from a gust to the fused kernel.

Gust, plant, sensors, faults, voter, law, actuators, detectors with their parts, scores: all are blocks, and so is what they
are composed to.

A block is a value that knows the layout of its states, of its constants (what never changes in flight) and of its random
numbers. A composition derives all three from its parts and addresses them by name, so a part that a campaign does not have
is a part without states, not an ``if``.
"""

from collections.abc import Callable, Mapping
from typing import Any, Protocol, TypeVar

from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Row, Rows, mapped
from fddbench.blocks.program import Program, trace

__all__ = ["NOTHING", "NO_DRAWS", "Block", "Part", "Stateless", "program"]

X = TypeVar("X")
C = TypeVar("C")
N = TypeVar("N")
O_co = TypeVar("O_co", covariant=True)

Part = Any
"""Record of a part that a campaign chooses: opaque to the composition, typed inside the part."""

NOTHING = Layout(Nothing())
"""Layout of a block that keeps no state, or has no constants."""
NO_DRAWS = Draws(Nothing())
"""Draws of a block without random numbers."""


class Block(Protocol[X, C, N, O_co]):
    """What flies.

    Attributes
    ----------
    states, constants : Layout
        Of the record that a step takes and gives back, and of what never changes in flight.
    draws : Draws
        Random numbers of a sample, by name.
    """

    states: Layout[X]
    constants: Layout[C]
    draws: Draws[N]

    def start(self, c: C) -> X:
        """State before sample 0; plain numbers where every case starts alike."""
        ...

    def step(self, x: X, c: C, n: N, *inputs: Any, **more: Any) -> tuple[X, O_co]:
        """State at the next sample, and the outputs at this one; the inputs are the block's own."""
        ...


class Stateless:
    """Base of blocks that keep nothing, know no constants and draw nothing; each of the three may be overridden."""

    states: Layout[Any] = NOTHING
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def start(self, c: Any) -> Any:
        """State before sample 0: all zero."""
        del c
        return mapped(lambda _: 0.0, self.states.shape)


def program(
    block: Block[Any, Any, Any, Any], *, shown: Callable[[Any], Mapping[str, Rows]] | None = None, **inputs: int
) -> Program:
    """A block as a traced program; the only place besides the fused kernel that packs.

    Parameters
    ----------
    shown : callable, optional
        Makes named rows of the block's outputs; without it only the state is computed.
    inputs : int
        Rows of each input that the step takes by keyword (0: a single row), for blocks that are fed.
    """

    def step(state: Rows, constants: Rows, normals: Rows, sample: Row, **fed: Rows) -> Mapping[str, Rows]:
        x, c, n = block.states.unpack(state), block.constants.unpack(constants), block.draws.unpack(normals)
        after, outputs = block.step(x, c, n, **(fed if inputs else {"sample": sample}))
        return {"state": block.states.pack(after), **(shown(outputs) if shown else {})}

    rows = {"state": block.states.size, "constants": block.constants.size, "normals": block.draws.size}
    return trace(step, **rows, sample=0, **inputs)
