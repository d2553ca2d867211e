"""The kernel in machine code: arrays in, padded to whole vectors, and one call."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.blocks import draws, llvm
from fddbench.blocks.flown import Addresses, Floats, Flown, Integers, Streams, by_output
from fddbench.blocks.lower import Spec, lower
from fddbench.blocks.merge import shared
from fddbench.blocks.program import Program
from fddbench.blocks.rewrite import canonical
from fddbench.blocks.targets.llvm import frame
from fddbench.errors import FddbenchError

__all__ = ["Compiled"]


class Compiled:
    """Kernel in machine code; a call releases the GIL, so threads fly chunks side by side.

    With `classes` of equal state rows (`merge.merged`) it flies one row a class; the program is merged only where it has
    not been compiled before.
    """

    def __init__(
        self, program: Program, streams: Streams, recorded: tuple[str, ...],
        target: str = "host", lanes: int | None = None, classes: Sequence[int] | None = None,
    ) -> None:  # fmt: skip
        machine = llvm.machine(target)
        if machine is None:
            raise FddbenchError(f"this processor does not run code for {target!r}")
        self.lanes = lanes or machine.lanes
        self._program, self._streams, self._recorded, self._machine = program, streams, recorded, machine
        self._classes = classes
        identity = f"{program.hash} {classes} {streams} {recorded} {self.lanes} {machine.rounds}"
        self._code = llvm.load(identity, self.text, machine)

    def text(self) -> str:
        """LLVM module of the kernel."""
        program = self._program if self._classes is None else shared(self._program, self._classes)
        spec = Spec(program=draws.with_draws(canonical(program)), streams=self._streams, recorded=self._recorded)
        return frame.write(lower(spec), self.lanes, rounds=self._machine.rounds)

    def fly(
        self, state: Floats, constants: Floats, samples: Integers, addresses: Addresses, *, first: int, end: int
    ) -> Flown:
        """As `Kernel.fly`."""
        n_cases = state.shape[1]
        if first >= end or not n_cases:
            return self._grounded(state, samples, max(end - first, 0))
        padding = -n_cases % self.lanes
        width = n_cases + padding
        n_rows = sum(len(self._program.outputs[name]) for name in self._recorded)
        tile = np.full((end - first, n_rows, width), np.nan)
        flying = np.pad(np.asarray(samples, dtype=np.int64), (0, padding))
        arrays = [
            _padded(state, padding),
            _padded(constants, padding),
            flying,
            *(_words(word, n_cases, padding) for word in (addresses.run, addresses.flight, addresses.scenario)),
            tile,
            _aligned(self._code.slots * self.lanes),
        ]
        self._code.fly(width, first, end, addresses.key, *(array.ctypes.data for array in arrays))
        recorded = by_output(tile[:, :, :n_cases], self._program, self._recorded)
        return Flown(state=arrays[0][:, :n_cases], samples=flying[:n_cases], recorded=recorded)

    def _grounded(self, state: Floats, samples: Integers, n_time: int) -> Flown:
        """Nothing flown."""
        n_rows = sum(len(self._program.outputs[name]) for name in self._recorded)
        tile = np.full((n_time, n_rows, state.shape[1]), np.nan)
        return Flown(
            state=state.copy(), samples=samples.copy(), recorded=by_output(tile, self._program, self._recorded)
        )


def _padded(rows: Floats, padding: int) -> Floats:
    """Copy in C order with the last case repeated, so that idle lanes compute nothing unusual."""
    rows = np.asarray(rows, dtype=float)
    return np.ascontiguousarray(np.concatenate([rows, np.repeat(rows[:, -1:], padding, axis=1)], axis=1))


def _words(word: npt.ArrayLike, n_cases: int, padding: int) -> Any:
    return np.pad(np.broadcast_to(np.asarray(word, dtype=np.uint64), n_cases), (0, padding))


def _aligned(size: int) -> Floats:
    """Workspace that starts at a cache line and, for the widest vectors, at a multiple of their size."""
    space = np.empty(size + 32)
    return space[(-space.ctypes.data % 256) // 8 :]
