"""Flies the healthy flights of a campaign and keeps what a detector shows of its inside: for tuning."""

from collections.abc import Iterator, Mapping, Sequence
from types import SimpleNamespace

import numpy as np

from fddbench.interfaces import Floats, Verdict
from fddbench.runner.assembly import Assembly
from fddbench.runner.chunks import CHUNK
from fddbench.runner.flight import fly

__all__ = ["healthy_signals"]


def healthy_signals(assembly: Assembly, detector: str, names: Sequence[str]) -> Iterator[dict[str, Floats]]:
    """Signals of a detector by name, (n_time, n_cases), of all healthy flights, chunk by chunk."""
    for planned in assembly.plan.scenarios:
        if planned.faults:
            continue
        for first in range(0, planned.n_runs, CHUNK):
            count = min(CHUNK, planned.n_runs - first)
            batch = assembly.batch(planned.first_case + np.arange(first, first + count, dtype=np.int64))
            feasible = np.flatnonzero([reason == "" for reason in batch.infeasible_reason])
            if not len(feasible):
                continue
            kept: dict[str, list[Floats]] = {name: [] for name in names}

            def record(
                sample: int,
                measured: SimpleNamespace,
                truth: Mapping[str, Floats],
                verdicts: Mapping[str, Verdict],
                kept: dict[str, list[Floats]] = kept,
            ) -> None:
                del sample, measured, truth
                for name, rows in kept.items():
                    rows.append(verdicts[detector].signals[name])

            fly(assembly, batch.take(feasible), record)
            yield {name: np.array(rows) for name, rows in kept.items()}
