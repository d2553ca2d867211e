"""Flies the healthy flights of a campaign and keeps what a detector shows of its inside: for tuning."""

from collections.abc import Iterator, Sequence

import numpy as np

from fddbench.interfaces import Floats
from fddbench.runner.assembly import Assembly
from fddbench.runner.chunks import CHUNK
from fddbench.runner.flight import Flyer

__all__ = ["healthy_signals"]


def healthy_signals(assembly: Assembly, detector: str, names: Sequence[str]) -> Iterator[dict[str, Floats]]:
    """Signals of a detector by name, (n_time, n_cases), of all healthy flights, chunk by chunk."""
    flyer = Flyer(assembly)
    for planned in assembly.plan.scenarios:
        for first in range(0, 0 if planned.faults else planned.n_cases, CHUNK):
            last = min(first + CHUNK, planned.n_cases)
            batch = assembly.batch(planned.first_case + np.arange(first, last, dtype=np.int64))
            feasible = np.flatnonzero([reason == "" for reason in batch.infeasible_reason])
            if len(feasible):
                recorded = flyer.fly(batch.take(feasible), [f"{detector}:{name}" for name in names]).recorded
                yield {name: recorded[f"{detector}:{name}"][:, 0] for name in names}
