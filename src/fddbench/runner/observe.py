"""Flies the healthy flights of a campaign: what a detector shows of its inside, and which flights alarm; for tuning."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from fddbench.errors import DesignError
from fddbench.interfaces import NEVER, Floats
from fddbench.metrics.distinct import DistinctFlights, distinct_flights
from fddbench.runner.assembly import Assembly
from fddbench.runner.chunks import CHUNK, COMPILED_CHUNK
from fddbench.runner.flight import Flyer
from fddbench.runner.rows import rows_and_events

__all__ = ["HealthySignals", "healthy_flights", "healthy_signals"]

Cases = npt.NDArray[np.int64]


@dataclass(frozen=True, kw_only=True, eq=False)
class HealthySignals:
    """What a detector shows on some healthy flights.

    Attributes
    ----------
    signals : dict of str to (n_time, n_cases) arrays
        By name; not-a-number once a flight has ended.
    run, time_s : (n_cases,) arrays
        Run of each flight, and how long it lasts [s].
    """

    signals: dict[str, Floats]
    run: Cases
    time_s: Floats


def healthy_signals(assembly: Assembly, detector: str, names: Sequence[str]) -> Iterator[HealthySignals]:
    """Signals of a detector of all healthy flights that can be flown, chunk by chunk."""
    flyer = Flyer(assembly)
    for cases in _healthy_cases(assembly, CHUNK):
        batch = assembly.batch(cases)
        feasible = np.flatnonzero([reason == "" for reason in batch.infeasible_reason])
        if len(feasible):
            flown = flyer.fly(batch.take(feasible), [f"{detector}:{name}" for name in names])
            shown = {name: flown.recorded[f"{detector}:{name}"][:, 0] for name in names}
            lasted = np.sum(~np.isnan(shown[names[0]]), axis=0) - 1.0
            time_s = np.maximum(lasted, 0.0) * assembly.loop.bus.sample_s
            yield HealthySignals(signals=shown, run=flown.batch.run, time_s=time_s)


def healthy_flights(assembly: Assembly) -> dict[str, DistinctFlights]:
    """Distinct healthy flights by detector: which alarm, and for how long they flew until then.

    Raises
    ------
    DesignError
        No healthy flight can be flown, or a detector fails on one.
    """
    flyer = Flyer(assembly)
    chunk = COMPILED_CHUNK if flyer.compiled else CHUNK
    parts = [rows_and_events(flyer, cases)[0] for cases in _healthy_cases(assembly, chunk)]
    rows = pa.concat_tables(parts).to_pandas()
    failed = rows[~rows["status"].isin(["ok", "infeasible"])]
    if len(failed):
        first = failed.iloc[0]
        case = "/".join(str(first[name]) for name in ("scenario", "point", "level", "run"))
        raise DesignError(f"{first['detector']} fails on {len(failed)} healthy flights ({case}): {first['reason']}")
    if not (rows["status"] == "ok").any():
        raise DesignError(f"none of the healthy flights of {assembly.plan.campaign.path} can be flown")
    return {str(name): distinct_flights(group) for name, group in rows.groupby("detector", sort=False)}


def _healthy_cases(assembly: Assembly, chunk: int) -> Iterator[Cases]:
    """Numbers of the healthy cases, chunk by chunk; those of several scenarios together, if they are equally long."""
    planned = [each for each in assembly.plan.scenarios if not each.faults]
    for samples in dict.fromkeys(each.samples[0] for each in planned):
        alike = [each.first_case + np.arange(each.n_cases) for each in planned if each.samples[0] == samples]
        cases = np.concatenate(alike).astype(np.int64)
        for first in range(0, len(cases), chunk):
            part = cases[first : first + chunk]
            if assembly.plan.n_labelled:  # a fault is in what flies
                part = part[assembly.batch(part).faults.k0 == NEVER]
            if len(part):
                yield part
