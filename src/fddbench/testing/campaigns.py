"""Small campaigns for checks, and flights of them side by side, alone, interpreted and compiled."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.blocks import llvm
from fddbench.campaign.load import read_campaign
from fddbench.interfaces import Floats
from fddbench.runner.assembling import assemble
from fddbench.runner.assembly import Assembly, Batch
from fddbench.runner.flight import Flyer, Outcome

__all__ = ["different_bits", "flown", "require", "some_flights"]

Cases = npt.NDArray[np.int64]


def require(condition: Any, message: str) -> None:
    """Raise AssertionError with the message unless the condition holds."""
    if not condition:
        raise AssertionError(message)


def some_flights(campaign: str | Path, overrides: Sequence[str], *, most: int = 6) -> tuple[Assembly, Batch]:
    """A campaign ready to fly, and at most so many feasible cases from all of its scenarios."""
    assembly = assemble(read_campaign(Path(campaign), overrides))
    cases = np.unique(np.linspace(0, assembly.plan.n_cases - 1, 4 * most).astype(np.int64))
    batch = assembly.batch(cases)
    able = np.flatnonzero([reason == "" for reason in batch.infeasible_reason])
    require(len(able), f"none of the flights of {campaign} is feasible: {batch.infeasible_reason[0]}")
    chosen = able[np.unique(np.linspace(0, len(able) - 1, most).astype(np.int64))]
    return assembly, batch.take(chosen)


def flown(assembly: Assembly, batch: Batch, recorded: Sequence[str] = (), *, backend: str = "numpy") -> Outcome:
    """The cases after their flight."""
    return Flyer(assembly, backend).fly(batch, recorded)


def different_bits(assembly: Assembly, batch: Batch, recorded: Sequence[str]) -> str:
    """What differs between flights side by side, one of them alone, and compiled; "" for nothing.

    `recorded` are the signals that are compared, ``measured:NAME`` and ``truth:NAME``, beside all scores.
    """
    together = flown(assembly, batch, recorded)
    alone = flown(assembly, batch.take(np.array([len(batch.cases) - 1])), recorded)
    wrong = _difference(together, alone, slice(-1, None))
    if wrong:
        return f"{wrong} depends on which flights fly together (a sum by BLAS or np.sum over the cases?)"
    if llvm.available():
        compiled = flown(assembly, batch, recorded, backend="llvm")
        wrong = _difference(together, compiled, slice(None))
        if wrong:
            return f"{wrong} differs between NumPy and compiled code (a function that is not of fddbench.blocks?)"
    return ""


def _difference(a: Outcome, b: Outcome, cases: slice) -> str:
    """Name of the first thing that is not bit for bit equal."""
    for name, score in a.scores.items():
        if not _equal(score[:, cases], b.scores[name]):
            return f"the score of {name}"
    for name, rows in a.recorded.items():
        n = min(len(rows), len(b.recorded[name]))
        if not _equal(rows[:n, :, cases], b.recorded[name][:n]):
            return name
    return ""


def _equal(a: Floats, b: Floats) -> bool:
    return a.shape == b.shape and bool(np.array_equal(a, b, equal_nan=True))
