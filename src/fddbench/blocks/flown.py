"""What a kernel is given and what it gives, whoever flies it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from fddbench.blocks.program import Program

__all__ = ["Addresses", "Floats", "Flown", "Integers", "Kernel", "Streams", "by_output"]

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]
Streams = tuple[tuple[int, str], ...]
"""Consumer number of each draw, and whose stream it takes: ``flight`` or ``scenario``."""


@dataclass(frozen=True, kw_only=True)
class Addresses:
    """Random addresses of a chunk: key of the campaign; run and stream words of the cases, (n_cases,) of 32 bits."""

    key: int
    run: npt.ArrayLike
    flight: npt.ArrayLike
    scenario: npt.ArrayLike


@dataclass(frozen=True, kw_only=True)
class Flown:
    """A chunk after some samples.

    Attributes
    ----------
    state : (n_state, n_cases) array
        Of each case after its last sample flown.
    samples : (n_cases,) array of int
        Samples to fly; lowered to those flown where the step said ``finished``.
    recorded : mapping of str to (n_time, n_rows, n_cases) arrays
        Outputs sample by sample, not-a-number after the end of a flight.
    """

    state: Floats
    samples: Integers
    recorded: Mapping[str, Floats]


class Kernel(Protocol):
    """A step made ready to fly.

    The program's inputs are ``state``, ``constants``, ``normals`` (four rows a consumer) and ``sample`` (0 rows), its
    outputs ``state``, perhaps ``finished`` (one row: this was the last sample that matters) and what may be recorded.
    """

    def fly(
        self, state: Floats, constants: Floats, samples: Integers, addresses: Addresses, *, first: int, end: int
    ) -> Flown:
        """Fly samples `first` to ``end - 1``, each case up to its own ``samples - 1``."""
        ...


def by_output(tile: Floats, program: Program, recorded: tuple[str, ...]) -> dict[str, Floats]:
    """Recorded rows by output."""
    ends = np.cumsum([len(program.outputs[name]) for name in recorded]).tolist()
    return {name: tile[:, end - len(program.outputs[name]) : end] for name, end in zip(recorded, ends, strict=True)}
