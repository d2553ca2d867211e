"""What a worker does: read the frozen campaign, fly a chunk, write its shard, say what is in it."""

from collections import Counter
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.campaign.load import read_campaign
from fddbench.interfaces import Floats
from fddbench.metrics.rows import Truth, event_columns, score_columns, statuses
from fddbench.metrics.scoring import NEVER
from fddbench.results.manifest import Shard
from fddbench.results.schema import EVENTS, rows_schema
from fddbench.results.shards import write_table
from fddbench.runner.assembly import Assembly, Batch, assemble, has_events
from fddbench.runner.chunks import Spans, expand, spans
from fddbench.runner.flight import Outcome, fly

__all__ = ["fly_and_write", "rows_and_events"]

Row = dict[str, Any]
Cases = npt.NDArray[np.int64]


@lru_cache(maxsize=2)
def _assembly(folder: str, sha256: str) -> Assembly:
    """Assembly of a frozen campaign, made once per worker."""
    del sha256  # part of the key: a folder may be replaced under a living worker
    return assemble(read_campaign(Path(folder) / "campaign.yaml"))


def fly_and_write(folder: str, campaign_sha256: str, case_spans: Spans) -> Shard:
    """Fly the cases and write their shard into the folder of results; everything crosses as plain data."""
    assembly = _assembly(folder, campaign_sha256)
    cases = expand(case_spans)
    rows, events = rows_and_events(assembly, cases)
    name = f"{cases[0]:08d}-{cases[-1]:08d}-{len(cases)}.parquet"
    path = Path(folder)
    schema = rows_schema([parameter.name for parameter in assembly.plan.benchmark.parameters])
    events_sha256 = write_table(path / "events" / name, events, EVENTS) if events else None
    return Shard(
        cases=spans(cases),
        rows=f"rows/{name}",
        rows_sha256=write_table(path / "rows" / name, rows, schema),
        events=f"events/{name}" if events else None,
        events_sha256=events_sha256,
        statuses=dict(sorted(Counter(row["status"] for row in rows).items())),
    )


def rows_and_events(assembly: Assembly, cases: Cases) -> tuple[list[Row], list[Row]]:
    """Rows and events of cases, case by case and detector by detector."""
    batch = assembly.batch(cases)
    feasible = np.flatnonzero([reason == "" for reason in batch.infeasible_reason])
    flown = batch.take(feasible)
    outcome = fly(assembly, flown) if len(feasible) else None
    rows: list[Row] = []
    events: list[Row] = []
    grounded = batch.take(np.setdiff1d(np.arange(len(cases)), feasible))
    for detector in assembly.detectors:
        if outcome is not None:
            scored = _scored(assembly, outcome, detector)
            rows += scored
            events += _events(assembly, flown, outcome, detector, scored)
        left = _infeasible(assembly, grounded, detector)
        rows += left
        events += _events(assembly, grounded, None, detector, left)
    order = {name: i for i, name in enumerate(assembly.detectors)}
    return sorted(rows, key=lambda row: (row["case"], order[row["detector"]])), events


def _scored(assembly: Assembly, outcome: Outcome, detector: str) -> list[Row]:
    """Rows of one detector on the flights that were flown."""
    batch, scoring, score = outcome.batch, assembly.scoring, outcome.scores[detector]
    status, reason = statuses(
        scoring,
        score,
        batch.score_constants,
        departed=outcome.departed,
        infeasible=batch.infeasible_reason,
        errors=outcome.errors.get(detector, [""] * len(batch.cases)),
    )
    return _rows(assembly, batch, detector, score=score, departed=outcome.departed, status=status, reason=reason)


def _infeasible(assembly: Assembly, batch: Batch, detector: str) -> list[Row]:
    """Rows of the flights that cannot be flown: nobody failed, nobody is scored."""
    n_cases = len(batch.cases)
    return _rows(
        assembly,
        batch,
        detector,
        score=assembly.scoring.start(n_cases),
        departed=np.full(n_cases, NEVER),
        status=["infeasible"] * n_cases,
        reason=list(batch.infeasible_reason),
    )


def _rows(
    assembly: Assembly,
    batch: Batch,
    detector: str,
    *,
    score: Floats,
    departed: Floats,
    status: list[str],
    reason: Sequence[str | None],
) -> list[Row]:
    """Rows of one detector: which flight, how it went, what it scored."""
    columns = score_columns(
        assembly.scoring,
        score,
        batch.score_constants,
        truth=_truth(assembly, batch),
        sites=assembly.loop.bus.sites,
        status=status,
        departed=departed,
        sample_s=assembly.loop.bus.sample_s,
    )
    columns |= {"status": list(status), "reason": list(reason)}
    scores = [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]
    return [who | score for who, score in zip(_who(assembly, batch, detector), scores, strict=True)]


def _truth(assembly: Assembly, batch: Batch) -> Truth:
    planned = [assembly.plan.scenarios[s] for s in batch.scenario]
    return Truth(faulty_sites=[p.faulty_sites for p in planned], limit_s=[p.limit_s for p in planned])


def _who(assembly: Assembly, batch: Batch, detector: str) -> list[Row]:
    """The columns that say which flight a row is of."""
    found = []
    for i, case in enumerate(batch.cases):
        planned = assembly.plan.scenarios[batch.scenario[i]]
        row: Row = {
            "case": int(case),
            "scenario": planned.name,
            "manoeuvre": planned.manoeuvre,
            "fault": "+".join(fault.kind for fault in planned.faults) or None,
            "run": int(batch.run[i]),
            "detector": detector,
        }
        found.append(row | {f"p_{name}": float(values[i]) for name, values in batch.parameters.items()})
    return found


def _events(assembly: Assembly, batch: Batch, outcome: Outcome | None, detector: str, rows: list[Row]) -> list[Row]:
    """Events of one detector: one per case and fault of scenarios whose faults are scored one by one."""
    sample_s = assembly.loop.bus.sample_s
    found: list[Row] = []
    for i, row in enumerate(rows):
        planned = assembly.plan.scenarios[batch.scenario[i]]
        for number, fault in enumerate(planned.faults if has_events(planned) else ()):
            times: Row = {}
            if outcome is not None and row["status"] == "ok":
                end = min(float(planned.n_samples - 1), float(outcome.departed[i]))
                times = event_columns(
                    assembly.scoring, outcome.scores[detector], batch.score_constants,
                    case=i, event=number, limit_s=planned.event_limits_s[number], end=end, sample_s=sample_s,
                )  # fmt: skip
            what = {"event": number + 1, "fault": fault.kind, "sites": "+".join(fault.sites)}
            found.append(row | what | {"onset_s": fault.onset_s, "end_s": fault.end_s} | _own(times))
    return found


_TIMES = (
    "first_alarm_time_s",
    "detection_time_s",
    "detection_time_limit_s",
    "normalized_detection_time",
    "detected",
    "missed",
    "censored",
)


def _own(times: Row) -> Row:
    """Times of the event in place of those of the whole flight; nulls where there are none."""
    return {name: times.get(name) for name in _TIMES}
