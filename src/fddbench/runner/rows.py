"""Rows and events of flights: what was flown, and what was declared of it, as tables."""

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from fddbench.interfaces import IN_LOG, NEVER
from fddbench.metrics.consequence_rows import consequence_columns
from fddbench.metrics.rows import event_columns, score_columns, statuses
from fddbench.metrics.scoring import Scoring
from fddbench.results.schema import EVENTS, rows_schema
from fddbench.runner.assembly import Assembly, Batch, has_events
from fddbench.runner.beside import beside
from fddbench.runner.flight import Flyer, Outcome
from fddbench.runner.in_log import names_of

__all__ = ["rows_and_events", "rows_of", "schemas_of"]

Columns = dict[str, pa.Array]
Cases = npt.NDArray[np.int64]

_SHARED = ("scenario", "point", "level", "run", "detector", "status", "reason")


def rows_and_events(flyer: Flyer, cases: Cases, only: Sequence[str] = ()) -> tuple[pa.Table, pa.Table]:
    """Rows and events of cases, case by case and detector by detector, of all or of some."""
    assembly = flyer.assembly
    batch = assembly.batch(cases)
    able = np.array([reason == "" for reason in batch.infeasible_reason], dtype=bool)
    flown, grounded = batch.take(np.flatnonzero(able)), batch.take(np.flatnonzero(~able))
    outcome = flyer.fly(flown) if able.any() else None
    if outcome is not None:
        outcome.twins = beside(flyer, flown, outcome.departed)
    schema = _schema(assembly)
    parts: list[pa.Table] = []
    events = [EVENTS.empty_table()]
    order: list[Cases] = []
    for number, detector in enumerate(only or assembly.detectors):
        for mine, result in ((flown, outcome), (grounded, None)):
            if len(mine.cases):
                columns = _columns(assembly, mine, result, detector)
                parts.append(pa.Table.from_pydict(columns, schema=schema))
                events += _events(assembly, mine, result, detector, columns)
                order.append(np.stack([np.full(len(mine.cases), number), mine.cases]))
    rows = pa.concat_tables(parts)
    in_order = np.lexsort(np.concatenate(order, axis=1))
    return rows.take(pa.array(in_order)).combine_chunks(), pa.concat_tables(events).combine_chunks()


def _schema(assembly: Assembly) -> pa.Schema:
    """Schema of the rows of a campaign."""
    plan = assembly.plan
    return rows_schema(
        [parameter.name for parameter in plan.plant.parameters],
        plan.columns,
        plan.gain_columns,
        assembly.consequences.announced,
    )


def schemas_of(assembly: Assembly) -> tuple[pa.Schema, pa.Schema]:
    """Schemas of the rows and of the events of a campaign."""
    return _schema(assembly), EVENTS


def rows_of(assembly: Assembly, batch: Batch, outcome: Outcome | None, detector: str) -> pa.Table:
    """Rows of one detector on a batch."""
    schema = _schema(assembly)
    return pa.Table.from_pydict(_columns(assembly, batch, outcome, detector), schema=schema)


def _columns(assembly: Assembly, batch: Batch, outcome: Outcome | None, detector: str) -> Columns:
    """Rows of one detector by columns; without an outcome the flights are infeasible and nobody is scored."""
    n_cases, scoring = len(batch.cases), _scoring(assembly, outcome, detector)
    score = assembly.nothing_scored(batch, scoring) if outcome is None else outcome.scores[detector]
    departed = np.full(n_cases, NEVER) if outcome is None else outcome.departed
    errors = (outcome.errors.get(detector) if outcome else None) or [""] * n_cases
    status, reason = statuses(scoring, score, infeasible=batch.infeasible_reason, errors=errors)
    scores = score_columns(
        scoring, score, batch.score_constants, limit_s=batch.faults.limit_s, status=status, departed=departed
    )
    said = {"status": pa.array(status, pa.string()), "reason": pa.array(reason, pa.string())}
    scores |= _consequences(assembly, batch, outcome, status)
    return _who(assembly, batch, detector) | said | scores


def _consequences(assembly: Assembly, batch: Batch, outcome: Outcome | None, status: Sequence[str]) -> Columns:
    """What was kept of the flights themselves, beside their healthy twins; null where there is no score."""
    nothing = np.full((assembly.consequences.states.size, len(batch.cases)), np.nan)
    own, twins = (None, None) if outcome is None else (outcome.consequences, outcome.twins)
    departed = np.full(len(batch.cases), NEVER) if outcome is None else outcome.departed
    return consequence_columns(
        assembly.consequences,
        nothing if own is None else own,
        nothing if twins is None else twins,
        k0=batch.faults.k0,
        last_scored=assembly.last_scored(batch, departed),
        valid=np.array([each == "ok" for each in status], dtype=bool),
    )


def _scoring(assembly: Assembly, outcome: Outcome | None, detector: str) -> Scoring:
    """How a detector was scored; somebody else's declarations have a scoring of their own."""
    own = None if outcome is None else outcome.scoring.get(detector)
    return own or assembly.scoring_of[detector]


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
    if len(batch.faults.labelled):
        columns["fault"] = _with_labelled(columns["fault"], batch)
    columns |= {name: pa.array(getattr(batch, name)) for name in ("point", "level", "run")}
    columns |= _swept(assembly, detector, len(batch.cases))
    flown = batch.faults.numbers.items()
    columns |= {name: pa.array(values, mask=np.isnan(values)) for name, values in flown}
    return columns | {f"p_{name}": pa.array(values) for name, values in batch.parameters.items()}


def _with_labelled(kinds: pa.Array, batch: Batch) -> pa.Array:
    """Kinds of the faults of flights joined by +, with a word for each that is in what flies."""
    counts = (batch.faults.labelled < NEVER).any(axis=1).sum(axis=0).tolist()
    texts = [
        "+".join([*filter(None, [kind]), *[IN_LOG] * n]) or None
        for kind, n in zip(kinds.to_pylist(), counts, strict=True)
    ]
    return pa.array(texts, pa.string())


def _swept(assembly: Assembly, detector: str, n_cases: int) -> Columns:
    """Columns of the gains that the campaign sweeps: of one detector only its own has a value."""
    swept = {each.name: each.swept for each in assembly.plan.campaign.designs}.get(detector)
    own = {swept.column: swept.value} if swept else {}
    return {name: pa.repeat(pa.scalar(own.get(name), pa.float64()), n_cases) for name in assembly.plan.gain_columns}


def _events(
    assembly: Assembly, batch: Batch, outcome: Outcome | None, detector: str, columns: Columns
) -> list[pa.Table]:
    """Events of one detector: one per case and fault of scenarios whose faults are scored one by one."""
    found: list[pa.Table] = []
    scoring, departed = assembly.scoring_of[detector], np.full(len(batch.cases), NEVER)
    score = assembly.nothing_scored(batch, scoring)
    if outcome is not None:
        score, departed = outcome.scores[detector], outcome.departed
    ok = np.array([status == "ok" for status in columns["status"].to_pylist()], dtype=bool)
    for position in np.unique(batch.scenario).tolist():
        planned = assembly.plan.scenarios[position]
        if not has_events(planned, assembly.plan.n_labelled):
            continue
        for number, kind, sites, mine in _lines(assembly, batch, position):
            limit_s = batch.faults.event_limits_s[number]
            scores = event_columns(
                scoring, score, batch.score_constants, event=number, limit_s=limit_s, departed=departed, valid=ok
            )
            own = {name: columns[name].filter(pa.array(mine)) for name in _SHARED}
            own |= {
                name: pa.repeat(pa.scalar(value, EVENTS.field(name).type), int(mine.sum()))
                for name, value in {"event": number + 1, "fault": kind}.items()
            }
            own |= {"sites": sites.filter(pa.array(mine))} | _event_times(assembly, batch, number, mine)
            own |= {name: values.filter(pa.array(mine)) for name, values in scores.items()}
            found.append(pa.Table.from_pydict(own, schema=EVENTS))
    return found


def _lines(
    assembly: Assembly, batch: Batch, position: int
) -> Iterator[tuple[int, str, pa.Array, npt.NDArray[np.bool_]]]:
    """Line, kind, sites and flights of each fault of a scenario, and of those that are in what flies."""
    mine, faults = batch.scenario == position, assembly.plan.scenarios[position].faults
    for number, fault in enumerate(faults):
        yield number, fault.kind, pa.repeat(pa.scalar("+".join(fault.sites)), len(mine)), mine
    before = len(batch.faults.first) - len(batch.faults.labelled)
    for line, first in enumerate(batch.faults.labelled):
        there = mine & (first < NEVER).any(axis=0)
        if there.any():
            sites = pa.array(names_of(first < NEVER, assembly.loop.bus.names), pa.string())
            yield before + line, IN_LOG, sites, there


def _event_times(assembly: Assembly, batch: Batch, line: int, mine: npt.NDArray[np.bool_]) -> Columns:
    """When a fault began and ended in some flights."""
    sample_s, last = assembly.loop.bus.sample_s, batch.faults.last[line, mine]
    end_s = np.round((last + 1.0) * sample_s, 9)
    return {
        "onset_s": pa.array(np.round(batch.faults.first[line, mine] * sample_s, 9)),
        "end_s": pa.array(end_s, mask=last == NEVER),
    }
