"""Declarations that somebody made without us, scored like those of a detector."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from fddbench.blocks.layout import Nothing
from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats, Verdict
from fddbench.metrics.scoring import SITES, Scoring
from fddbench.runner.assembly import Assembly, Batch
from fddbench.runner.beside import beside
from fddbench.runner.flight import Flyer, Outcome
from fddbench.runner.rows import rows_of

__all__ = ["declared_rows"]


def declared_rows(
    assembly: Assembly,
    cases: npt.NDArray[np.int64],
    declared: Floats | None,
    *,
    alarm: Floats | None,
    residual: Floats | None,
    estimate: Floats | None,
    estimates: str,
    watches: Sequence[str] | None,
    name: str,
) -> pa.Table:
    """Rows of declarations, see `fddbench.api.flights.score`."""
    batch, sites = assembly.batch(cases), assembly.loop.bus.names
    last = assembly.scoring.constants.unpack(batch.score_constants).last
    if (last != last[0]).any():
        raise FddbenchError("these flights have different lengths; score those of one scenario at a time")
    time = (int(last.max()) + 1,)
    each = {"declared": (len(sites),), "alarm": (), "residual": (), "estimate": (len(sites),) * (estimates == SITES)}
    given = {"declared": declared, "alarm": alarm, "residual": residual, "estimate": estimate}
    _require(given, {key: (*time, *rows, len(cases)) for key, rows in each.items()})
    scoring = assembly.scoring.of(
        watches=sites if watches is None else watches,
        isolates=declared is not None,
        estimates=None if estimate is None else estimates,
    )
    flyer, truth = Flyer(assembly), scoring.truth
    if truth and truth not in flyer.fused.program().outputs:
        raise FddbenchError(
            f"an estimate of {estimates!r} cannot be scored: the benchmark does not say what is true of it"
        )
    flown = flyer.fly(batch, [truth] if truth else [])
    score = _scored(scoring, batch, given, flown, n_time=time[0])
    outcome = Outcome(
        batch=batch,
        scores={name: score},
        departed=flown.departed,
        scoring={name: scoring},
        consequences=flown.consequences,
        twins=beside(flyer, batch, flown.departed),
    )
    return rows_of(assembly, batch, outcome, name)


def _require(given: Mapping[str, Any], shapes: Mapping[str, tuple[int, ...]]) -> None:
    """Refuse arrays of another shape than the flights have, and a score of nothing."""
    wrong = [
        f"{key} needs the shape {shapes[key]}, got {np.shape(value)}"
        for key, value in given.items()
        if value is not None and np.shape(value) != shapes[key]
    ]
    if given["declared"] is None and given["alarm"] is None:
        wrong.append("give declared, alarm, or both")
    if wrong:
        raise FddbenchError("; ".join(wrong))


def _verdict(given: Mapping[str, Any], k: int, n_sites: int) -> Verdict:
    """Verdict of one sample."""
    at = {key: None if value is None else np.asarray(value[k], dtype=float) for key, value in given.items()}
    like = np.zeros(np.shape(next(value for value in at.values() if value is not None))[-1])
    declared = np.stack([like] * n_sites) if at["declared"] is None else at["declared"]
    alarm = np.where(declared.max(axis=0) > 0.0, 1.0, 0.0) if at["alarm"] is None else at["alarm"]
    return Verdict(declared, like if at["residual"] is None else at["residual"], alarm=alarm, estimate=at["estimate"])


def _scored(scoring: Scoring, batch: Batch, given: Mapping[str, Any], flown: Outcome, *, n_time: int) -> Floats:
    """Final score, (n_score, n_cases)."""
    n_cases, truth = len(batch.cases), scoring.truth
    c = scoring.constants.unpack(batch.score_constants)
    x = scoring.states.spread(scoring.start(c), n_cases)
    for k in range(n_time):
        sample = np.float64(k)
        rows = flown.recorded[truth][k] if truth else None
        actual = rows if scoring.estimates == SITES or rows is None else rows[0]
        x, _ = scoring.step(
            x, c, Nothing(), _verdict(given, k, len(scoring.sites)), actual, sample, sample < flown.departed
        )
    packed: Floats = scoring.states.pack(x, n_cases)
    return packed
