"""Declarations that somebody made without us, scored like those of a detector."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from fddbench.blocks.layout import Nothing
from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats, Verdict
from fddbench.runner.assembly import Assembly, Batch
from fddbench.runner.flight import Flyer, Outcome
from fddbench.runner.work import rows_of

__all__ = ["declared_rows"]


def declared_rows(
    assembly: Assembly,
    cases: npt.NDArray[np.int64],
    declared: Floats,
    *,
    alarm: Floats | None,
    residual: Floats | None,
    name: str,
) -> pa.Table:
    """Rows of declarations, see `fddbench.api.flights.score`."""
    batch = assembly.batch(cases)
    last = assembly.scoring.constants.unpack(batch.score_constants).last
    n_time, n_sites = int(last.max()) + 1, len(assembly.loop.bus.sites)
    if (last != last[0]).any():
        raise FddbenchError("these flights have different lengths; score those of one scenario at a time")
    given: dict[str, Any] = {"declared": (declared, (n_time, n_sites, len(cases)))}
    given |= {"alarm": (alarm, (n_time, len(cases))), "residual": (residual, (n_time, len(cases)))}
    wrong = [
        f"{key} needs the shape {shape}, got {np.shape(value)}"
        for key, (value, shape) in given.items()
        if value is not None and np.shape(value) != shape
    ]
    if wrong:
        raise FddbenchError("; ".join(wrong))
    departed = Flyer(assembly).fly(batch).departed
    verdicts = [_verdict(declared, alarm, residual, k) for k in range(n_time)]
    score = _scored(assembly, batch, verdicts, departed)
    return rows_of(assembly, batch, Outcome(batch=batch, scores={name: score}, departed=departed), name)


def _verdict(declared: Floats, alarm: Floats | None, residual: Floats | None, k: int) -> Verdict:
    """Verdict of one sample."""
    any_ = np.where(np.asarray(declared[k]).max(axis=0) > 0.0, 1.0, 0.0)
    return Verdict(
        np.asarray(declared[k], dtype=float),
        np.zeros_like(any_) if residual is None else np.asarray(residual[k], dtype=float),
        alarm=any_ if alarm is None else np.asarray(alarm[k], dtype=float),
    )


def _scored(assembly: Assembly, batch: Batch, verdicts: list[Verdict], departed: Floats) -> Floats:
    """Final score, (n_score, n_cases)."""
    scoring, n_cases = assembly.scoring, len(batch.cases)
    c = scoring.constants.unpack(batch.score_constants)
    x = scoring.states.spread(scoring.start(c), n_cases)
    for k, verdict in enumerate(verdicts):
        sample = np.float64(k)
        x, _ = scoring.step(x, c, Nothing(), verdict, sample, sample < departed)
    packed: Floats = scoring.states.pack(x, n_cases)
    return packed
