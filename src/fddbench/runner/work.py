"""What a worker does: read the frozen campaign, fly a chunk, write its shard, say what is in it."""

from functools import lru_cache
from pathlib import Path
from threading import Lock
from typing import Any

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from fddbench.campaign.load import read_campaign
from fddbench.campaign.meaning import Campaign
from fddbench.errors import FddbenchError, ResultsError
from fddbench.metrics.rows import Truth, event_columns, score_columns, statuses
from fddbench.metrics.scoring import NEVER
from fddbench.results.manifest import Shard
from fddbench.results.schema import EVENTS, rows_schema
from fddbench.results.shards import write_table
from fddbench.runner.assembling import assemble
from fddbench.runner.assembly import Assembly, Batch, has_events
from fddbench.runner.chunks import Spans, expand, spans
from fddbench.runner.flight import Flyer, Outcome
from fddbench.runner.given_up import GivenUps

__all__ = ["fly_and_write", "flyer_of", "frozen", "rows_and_events", "rows_of"]

Columns = dict[str, pa.Array]
Cases = npt.NDArray[np.int64]

_SHARED = ("case", "scenario", "run", "detector", "status", "reason")
_making = Lock()


def flyer_of(folder: str, campaign_sha256: str, backend: str, given_up: GivenUps = ()) -> Flyer:
    """What flies a frozen campaign, made and compiled once per process."""
    with _making:
        return _flyer(folder, campaign_sha256, backend, given_up)


def frozen(folder: Path, campaign_sha256: object) -> Campaign:
    """Campaign of a folder of results, once it is the one that the results are of.

    Raises
    ------
    ResultsError
        The frozen campaign, a design or a plug-in was changed or is gone.
    """
    try:
        campaign = read_campaign(folder / "campaign.yaml")
    except FddbenchError as error:
        raise ResultsError(f"the campaign frozen in {folder} cannot be read any more:\n{error}\n{_REMEDY}") from error
    if campaign.sha256 != campaign_sha256:
        raise ResultsError(f"the campaign or a design frozen in {folder} is not the one of its results. {_REMEDY}")
    return campaign


_REMEDY = "Run the campaign again on this folder: it puts the files back."


@lru_cache(maxsize=2)
def _flyer(folder: str, campaign_sha256: str, backend: str, given_up: GivenUps) -> Flyer:
    flyer = Flyer(assemble(frozen(Path(folder), campaign_sha256)), backend, dict(given_up))
    flyer.prepare()
    return flyer


def fly_and_write(folder: str, campaign_sha256: str, backend: str, given_up: GivenUps, case_spans: Spans) -> Shard:
    """Fly the cases and write their shard into the folder of results; everything crosses as plain data."""
    cases = expand(case_spans)
    rows, events = rows_and_events(flyer_of(folder, campaign_sha256, backend, given_up), cases)
    name = f"{cases[0]:08d}-{cases[-1]:08d}-{len(cases)}.parquet"
    path = Path(folder)
    events_sha256 = write_table(path / "events" / name, events) if len(events) else None
    return Shard(
        cases=spans(cases),
        rows=f"rows/{name}",
        rows_sha256=write_table(path / "rows" / name, rows),
        events=f"events/{name}" if len(events) else None,
        events_sha256=events_sha256,
        statuses=dict(
            sorted((entry["values"], entry["counts"]) for entry in rows["status"].value_counts().to_pylist())
        ),
    )


def rows_and_events(flyer: Flyer, cases: Cases) -> tuple[pa.Table, pa.Table]:
    """Rows and events of cases, case by case and detector by detector."""
    assembly = flyer.assembly
    batch = assembly.batch(cases)
    able = np.array([reason == "" for reason in batch.infeasible_reason], dtype=bool)
    flown, grounded = batch.take(np.flatnonzero(able)), batch.take(np.flatnonzero(~able))
    outcome = flyer.fly(flown) if able.any() else None
    schema = rows_schema([parameter.name for parameter in assembly.plan.plant.parameters])
    parts: list[pa.Table] = []
    events = [EVENTS.empty_table()]
    rank: list[Cases] = []
    for number, detector in enumerate(assembly.detectors):
        for mine, result in ((flown, outcome), (grounded, None)):
            if len(mine.cases):
                columns = _columns(assembly, mine, result, detector)
                parts.append(pa.Table.from_pydict(columns, schema=schema))
                events += _events(assembly, mine, result, detector, columns)
                rank.append(np.full(len(mine.cases), number))
    rows = pa.concat_tables(parts)
    in_order = np.lexsort((np.concatenate(rank), rows["case"].to_numpy()))
    return rows.take(pa.array(in_order)).combine_chunks(), pa.concat_tables(events).combine_chunks()


def rows_of(assembly: Assembly, batch: Batch, outcome: Outcome | None, detector: str) -> pa.Table:
    """Rows of one detector on a batch."""
    schema = rows_schema([parameter.name for parameter in assembly.plan.plant.parameters])
    return pa.Table.from_pydict(_columns(assembly, batch, outcome, detector), schema=schema)


def _columns(assembly: Assembly, batch: Batch, outcome: Outcome | None, detector: str) -> Columns:
    """Rows of one detector by columns; without an outcome the flights are infeasible and nobody is scored."""
    n_cases = len(batch.cases)
    score = assembly.nothing_scored(batch) if outcome is None else outcome.scores[detector]
    departed = np.full(n_cases, NEVER) if outcome is None else outcome.departed
    errors = (outcome.errors.get(detector) if outcome else None) or [""] * n_cases
    status, reason = statuses(
        assembly.scoring,
        score,
        batch.score_constants,
        departed=departed,
        infeasible=batch.infeasible_reason,
        errors=errors,
    )
    scores = score_columns(
        assembly.scoring,
        score,
        batch.score_constants,
        truth=_truth(assembly, batch),
        sites=assembly.loop.bus.names,
        status=status,
        departed=departed,
        sample_s=assembly.loop.bus.sample_s,
    )
    said = {"status": pa.array(status, pa.string()), "reason": pa.array(reason, pa.string())}
    return _who(assembly, batch, detector) | said | scores


def _truth(assembly: Assembly, batch: Batch) -> Truth:
    planned = assembly.plan.scenarios
    return Truth(
        faulty_sites=[p.faulty_sites for p in planned], limit_s=[p.limit_s for p in planned], scenario=batch.scenario
    )


def _who(assembly: Assembly, batch: Batch, detector: str) -> Columns:
    """The columns that say which flight a row is of."""
    planned, where = assembly.plan.scenarios, pa.array(batch.scenario)
    texts = {
        "scenario": [p.name for p in planned],
        "manoeuvre": [p.manoeuvre for p in planned],
        "fault": ["+".join(fault.kind for fault in p.faults) or None for p in planned],
        "detector": [detector] * len(planned),
    }
    columns = {name: pa.array(known, pa.string()).take(where) for name, known in texts.items()}
    columns |= {"case": pa.array(batch.cases), "run": pa.array(batch.run)}
    return columns | {f"p_{name}": pa.array(values) for name, values in batch.parameters.items()}


def _events(
    assembly: Assembly, batch: Batch, outcome: Outcome | None, detector: str, columns: Columns
) -> list[pa.Table]:
    """Events of one detector: one per case and fault of scenarios whose faults are scored one by one."""
    found: list[pa.Table] = []
    for position in np.unique(batch.scenario).tolist():
        planned = assembly.plan.scenarios[position]
        if not has_events(planned):
            continue
        cases = np.flatnonzero(batch.scenario == position)
        shared = {name: columns[name].take(pa.array(cases)) for name in _SHARED}
        ok, end = np.zeros(len(cases), dtype=bool), np.full(len(cases), planned.n_samples - 1.0)
        score = assembly.nothing_scored(batch)
        if outcome is not None:
            score, end = outcome.scores[detector], np.minimum(end, outcome.departed[cases] - 1.0)
            ok = np.array([status == "ok" for status in shared["status"].to_pylist()], dtype=bool)
        for number, fault in enumerate(planned.faults):
            times = event_columns(
                assembly.scoring, score, batch.score_constants, cases=cases, event=number,
                limit_s=planned.event_limits_s[number], end=end, sample_s=assembly.loop.bus.sample_s, valid=ok,
            )  # fmt: skip
            what: dict[str, Any] = {"event": number + 1, "fault": fault.kind, "sites": "+".join(fault.sites)}
            what |= {"onset_s": fault.onset_s, "end_s": fault.end_s}
            alike = {
                name: pa.repeat(pa.scalar(value, EVENTS.field(name).type), len(cases)) for name, value in what.items()
            }
            found.append(pa.Table.from_pydict(shared | alike | times, schema=EVENTS))
    return found
