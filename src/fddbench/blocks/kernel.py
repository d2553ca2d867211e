"""Flying a chunk of cases over many samples: the same call for the NumPy interpreter and for compiled code."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from fddbench.blocks import draws, llvm
from fddbench.blocks.interpreter import Interpreter
from fddbench.blocks.lower import Spec, lower
from fddbench.blocks.philox import normals
from fddbench.blocks.program import Program
from fddbench.blocks.targets.llvm import frame
from fddbench.errors import FddbenchError

__all__ = ["Addresses", "Compiled", "Flown", "Interpreted", "Kernel", "build"]

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


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


def build(
    program: Program, *, consumers: tuple[int, ...] = (), fault_consumers: tuple[int, ...] = (),
    recorded: tuple[str, ...] = (), backend: str = "auto", target: str = "host", lanes: int | None = None,
) -> Kernel:  # fmt: skip
    """Kernel of a step.

    Parameters
    ----------
    consumers, fault_consumers : tuple of int
        Consumer numbers drawn from the flight's and from the scenario's stream, in the order of ``normals``.
    recorded : tuple of str
        Outputs to store; others are not computed.
    backend : {"auto", "llvm", "numpy"}
        ``auto`` compiles where llvmlite is installed.
    target, lanes : str, int
        For tests: processor and width to compile for.
    """
    if backend not in {"auto", "llvm", "numpy"}:
        raise FddbenchError(f"no back end is called {backend!r}; known: auto, llvm, numpy")
    if backend == "llvm" and not llvm.available():
        raise FddbenchError(
            "the back end 'llvm' needs llvmlite 0.45 or later: pip install llvmlite, or --backend numpy (the same bits)"
        )
    kept = program.keep("state", *(["finished"] if "finished" in program.outputs else []), *recorded)
    streams = (*((c, "flight") for c in consumers), *((c, "scenario") for c in fault_consumers))
    if backend == "numpy" or not llvm.available():
        return Interpreted(kept, streams, recorded)
    return Compiled(kept, streams, recorded, target, lanes)


def _split(tile: Floats, program: Program, recorded: tuple[str, ...]) -> dict[str, Floats]:
    """Recorded rows by output."""
    ends = np.cumsum([len(program.outputs[name]) for name in recorded]).tolist()
    return {name: tile[:, end - len(program.outputs[name]) : end] for name, end in zip(recorded, ends, strict=True)}


class Interpreted:
    """Kernel that runs on NumPy alone."""

    def __init__(self, program: Program, streams: tuple[tuple[int, str], ...], recorded: tuple[str, ...]) -> None:
        self._interpreter = Interpreter(program, fixed=("constants",))
        self._program, self._streams, self._recorded = program, streams, recorded

    def fly(
        self, state: Floats, constants: Floats, samples: Integers, addresses: Addresses, *, first: int, end: int
    ) -> Flown:
        """As `Kernel.fly`."""
        state, samples = np.array(state, dtype=float), np.array(samples, dtype=np.int64)
        self._interpreter.fix(constants=constants)
        n_rows = sum(len(self._program.outputs[name]) for name in self._recorded)
        tile = np.full((end - first, n_rows, state.shape[1]), np.nan)
        for k in range(first, end):
            active = k < samples
            if not active.any():
                break
            drawn = self._normals(k, addresses, state.shape[1])
            outputs = self._interpreter.run(state=state, normals=drawn, sample=np.float64(k))
            state = np.where(active, outputs["state"], state)
            if n_rows:
                rows = np.concatenate([outputs[name] for name in self._recorded])
                tile[k - first] = np.where(active, rows, np.nan)
            if "finished" in outputs:
                samples = np.where(active & (outputs["finished"][0] != 0.0), k + 1, samples)
        return Flown(state=state, samples=samples, recorded=_split(tile, self._program, self._recorded))

    def _normals(self, k: int, addresses: Addresses, n_cases: int) -> Floats:
        words = {"flight": np.asarray(addresses.flight), "scenario": np.asarray(addresses.scenario)}
        run = np.asarray(addresses.run)
        drawn = [normals((k, consumer, run, words[stream]), addresses.key) for consumer, stream in self._streams]
        return np.concatenate([np.broadcast_to(d, (4, n_cases)) for d in drawn]) if drawn else np.zeros((0, n_cases))


class Compiled:
    """Kernel in machine code; a call releases the GIL, so threads fly chunks side by side."""

    def __init__(
        self, program: Program, streams: tuple[tuple[int, str], ...], recorded: tuple[str, ...],
        target: str = "host", lanes: int | None = None,
    ) -> None:  # fmt: skip
        machine = llvm.machine(target)
        if machine is None:
            raise FddbenchError(f"this processor does not run code for {target!r}")
        self.lanes = lanes or machine.lanes
        self._program, self._streams, self._recorded, self._machine = program, streams, recorded, machine
        identity = f"{program.hash} {streams} {recorded} {self.lanes} {machine.rounds}"
        self._code = llvm.load(identity, self.text, machine)

    def text(self) -> str:
        """LLVM module of the kernel."""
        spec = Spec(program=draws.with_draws(self._program), streams=self._streams, recorded=self._recorded)
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
        recorded = _split(tile[:, :, :n_cases], self._program, self._recorded)
        return Flown(state=arrays[0][:, :n_cases], samples=flying[:n_cases], recorded=recorded)

    def _grounded(self, state: Floats, samples: Integers, n_time: int) -> Flown:
        """Nothing flown."""
        n_rows = sum(len(self._program.outputs[name]) for name in self._recorded)
        tile = np.full((n_time, n_rows, state.shape[1]), np.nan)
        return Flown(state=state.copy(), samples=samples.copy(), recorded=_split(tile, self._program, self._recorded))


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
