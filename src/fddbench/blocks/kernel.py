"""Flying a chunk of cases over many samples: the same call for the NumPy interpreter and for compiled code."""

import json
from collections.abc import Hashable, Sequence

from fddbench.blocks import cache, llvm
from fddbench.blocks.compiled import Compiled
from fddbench.blocks.flown import Addresses, Floats, Flown, Integers, Kernel, Streams
from fddbench.blocks.interpreted import Interpreted
from fddbench.blocks.merge import check_alike, expand_state, merged, shrink_state
from fddbench.blocks.program import Program, prune
from fddbench.errors import FddbenchError

__all__ = ["Addresses", "Compiled", "Flown", "Interpreted", "Kernel", "Merged", "build"]


def build(
    program: Program, *, consumers: tuple[int, ...] = (), fault_consumers: tuple[int, ...] = (), streams: Streams = (),
    merge: Sequence[Hashable] | None = None, recorded: tuple[str, ...] = (), backend: str = "auto", target: str = "host",
    lanes: int | None = None,
) -> Kernel:  # fmt: skip
    """Kernel of a step.

    Parameters
    ----------
    streams : tuple of (int, str)
        Consumer number of every four rows of ``normals``, and whose stream it takes, ``flight`` or ``scenario``.
    consumers, fault_consumers : tuple of int
        The same in another way: those drawn from the flight's stream, behind them those from the scenario's.
    merge : sequence of hashable, optional
        One key a state row: rows with the same key start with the same bits in every case, always, and those that also
        change alike are flown once (`fddbench.blocks.merge`). State, in and out, stays the full one; the bits are the same.
    recorded : tuple of str
        Outputs to store; others are not computed.
    backend : {"auto", "llvm", "numpy"}
        ``auto`` compiles where llvmlite is installed.
    target, lanes : str, int
        For tests: processor and width to compile for.

    Raises
    ------
    FddbenchError
        There is no such back end here, or draws or keys do not fit the program.
    """
    if backend not in {"auto", "llvm", "numpy"}:
        raise FddbenchError(f"no back end is called {backend!r}; known: auto, llvm, numpy")
    compiles = backend != "numpy" and llvm.available()
    if backend == "llvm" and not compiles:
        raise FddbenchError(
            "the back end 'llvm' needs llvmlite 0.45 or later: pip install llvmlite, or --backend numpy (the same bits)"
        )
    if streams and (consumers or fault_consumers):
        raise FddbenchError("draws are told twice; give streams, or consumers and fault_consumers")
    streams = (*streams, *((c, "flight") for c in consumers), *((c, "scenario") for c in fault_consumers))
    names = ("state", *(["finished"] if "finished" in program.outputs else []), *recorded)
    if not compiles:
        kept = program.keep(*names)
        fewer, classes = (kept, None) if merge is None else merged(kept, merge)
        interpreted = Interpreted(fewer, streams, recorded)
        return interpreted if classes is None else Merged(interpreted, classes)
    chosen = program.only(*names)
    if merge is None:
        return Compiled(chosen, streams, recorded, target, lanes)
    classes = _classes(chosen, merge)
    return Merged(Compiled(chosen, streams, recorded, target, lanes, classes=classes), classes)


def _classes(program: Program, keys: Sequence[Hashable]) -> list[int]:
    """Classes of `merged`, found once per program and keys."""
    name = cache.key("classes", program.hash, repr(keys), cache.source())
    body = cache.load(name)
    if body is None:
        body = json.dumps(merged(prune(program), keys)[1]).encode()
        cache.store(name, body)
    classes: list[int] = json.loads(body)
    return classes


class Merged:
    """A kernel that flies equal states once.

    Parameters
    ----------
    kernel : Kernel
        Flies the merged program.
    classes : sequence of int
        For each full state row the merged one.
    """

    def __init__(self, kernel: Kernel, classes: Sequence[int]) -> None:
        self.kernel, self.classes = kernel, tuple(classes)

    def fly(
        self, state: Floats, constants: Floats, samples: Integers, addresses: Addresses, *, first: int, end: int
    ) -> Flown:
        """As `Kernel.fly`.

        Raises
        ------
        FddbenchError
            Rows that are flown as one differ.
        """
        check_alike(state, self.classes)
        fewer = shrink_state(state, self.classes)
        flown = self.kernel.fly(fewer, constants, samples, addresses, first=first, end=end)
        return Flown(state=expand_state(flown.state, self.classes), samples=flown.samples, recorded=flown.recorded)
