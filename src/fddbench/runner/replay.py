"""Flies cases of a finished campaign again and keeps the signals: for pictures and for a close look."""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from fddbench.blocks.philox import philox4x32
from fddbench.campaign.addresses import Address
from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import PlannedScenario
from fddbench.interfaces import NEVER, Floats, Recording
from fddbench.runner.assembling import assemble
from fddbench.runner.assembly import Batch
from fddbench.runner.fingerprint import frozen
from fddbench.runner.flight import Flyer

__all__ = ["MOST_CASES", "replay", "replay_campaign", "sampled_cases"]

MOST_CASES = 50
"""Cases of a scenario that a picture shows, beside the worst ones."""

_NUMBER = re.compile(r"_[0-9]+$")

Chosen = Mapping[str, Sequence[Address]]
"""Cases by their scenarios."""


def sampled_cases(rows: pd.DataFrame, *, seed: int, most: int = MOST_CASES) -> dict[str, tuple[str, ...]]:
    """Names of cases to show by scenario: a seeded sample of those flown, and the worst of every detector.

    Worst is the slowest detection, or the largest margin of a healthy flight.
    """
    found: dict[str, tuple[str, ...]] = {}
    for scenario, group in rows[rows["status"] == "ok"].groupby("scenario", sort=False):
        flights = group.drop_duplicates("case")
        point, level, run = (flights[name].to_numpy(dtype=np.int64) for name in ("point", "level", "run"))
        order = np.argsort(philox4x32((run, point, level, 0), seed)[0], kind="stable")
        names = flights["case"].to_numpy()
        chosen = {*names[order[:most]], *(_worst(of_one) for _, of_one in group.groupby("detector", sort=False))}
        found[str(scenario)] = tuple(str(name) for name in names if name in chosen)
    return found


def _worst(rows: pd.DataFrame) -> str:
    """Case of the slowest detection (none counts as slowest), or of the largest healthy margin."""
    by = "margin_healthy" if (rows["n_faulty"] == 0).all() else "detection_time_s"
    badness = rows[by].astype("float64[pyarrow]").fillna(np.inf if by == "detection_time_s" else -1.0)
    return str(rows["case"].iloc[int(np.argmax(badness.to_numpy(dtype=float)))])


def replay(
    folder: Path,
    cases: Chosen | None = None,
    *,
    seconds: Mapping[str, float] | None = None,
    signals: Collection[str] | None = None,
) -> Iterator[Recording]:
    """Recordings of cases of a folder of results, from its frozen campaign; see `replay_campaign`."""
    yield from replay_campaign(frozen(folder), cases, seconds=seconds, signals=signals)


def replay_campaign(
    campaign: Campaign,
    cases: Chosen | None = None,
    *,
    seconds: Mapping[str, float] | None = None,
    signals: Collection[str] | None = None,
    scenarios: Collection[str] | None = None,
) -> Iterator[Recording]:
    """Recordings of cases, scenario by scenario.

    Parameters
    ----------
    campaign : Campaign
        What flies.
    cases : mapping of str to sequence, optional
        Cases by scenario, each by its name ``jam_a/3/0/17`` or (point, level, run); all by default.
    seconds : mapping of str to float, optional
        By scenario, how long after the onset of its fault the recording stops [s]; to the end by default.
    signals : collection of str, optional
        Measured and true signals to keep; all by default. What the detectors show is always kept.
    scenarios : collection of str, optional
        Only these.
    """
    flyer = Flyer(assemble(campaign))
    for planned in flyer.assembly.plan.scenarios:
        if scenarios is not None and planned.name not in scenarios:
            continue
        numbers = planned.first_case + np.arange(planned.n_cases)
        if planned.name in (cases or {}):
            numbers = flyer.assembly.plan.numbers((cases or {})[planned.name], planned.name)
        batch = flyer.assembly.batch(numbers)
        able = np.flatnonzero([reason == "" for reason in batch.infeasible_reason])
        if len(able):
            yield _record(flyer, planned, batch.take(able), (seconds or {}).get(planned.name), signals)


def _record(
    flyer: Flyer, planned: PlannedScenario, batch: Batch, seconds: float | None, signals: Collection[str] | None
) -> Recording:
    """Signals of cases of one scenario."""
    assembly, sample_s = flyer.assembly, flyer.assembly.loop.bus.sample_s
    k0, last = batch.faults.k0, int(assembly.ends(batch).max())
    faulty = bool((k0 < NEVER).any())
    if faulty and seconds is not None:
        last = min(last, int(k0[k0 < NEVER].max()) + round(seconds / sample_s))
    sources = {**dict.fromkeys(assembly.loop.bus.signals, "measured"), **dict.fromkeys(assembly.loop.truth, "truth")}
    # a row of a signal, q_deg_s_2, is asked for by its number or with all the others, q_deg_s
    asked = {name for full in signals or () for name in (full, _NUMBER.sub("", full))}
    kept = [f"{source}:{name}" for name, source in sources.items() if signals is None or name in asked]
    shown = {name: ("n_declared", "alarm", "residual", *own.recorded) for name, own in assembly.detectors.items()}
    kept += [f"{detector}:{name}" for detector, names in shown.items() for name in ("declared", *names)]
    flown = flyer.fly(assembly.shortened(batch, float(last)), kept)
    found = flown.recorded
    return Recording(
        scenario=planned.name,
        cases=assembly.plan.names(batch.cases),
        time_s=np.round(np.arange(last + 1) * sample_s, 9),
        onset_s=np.where(k0 < NEVER, np.round(k0 * sample_s, 9), np.nan) if faulty else None,
        errors={name: tuple(reasons) for name, reasons in flown.errors.items() if any(reasons)},
        signals=dict(
            _numbered(
                {name: found[f"{source}:{name}"] for name, source in sources.items() if f"{source}:{name}" in found}
            )
        ),
        detectors={
            name: {signal: found[f"{name}:{signal}"][:, 0] for signal in names} for name, names in shown.items()
        },
        declared={
            name: {site: found[f"{name}:declared"][:, i] for i, site in enumerate(assembly.loop.bus.names)}
            for name in shown
        },
    )


def _numbered(recorded: Mapping[str, Floats]) -> Iterator[tuple[str, Floats]]:
    """Signals of one row by their names, those of several numbered from 1; (n_time, n_cases) each."""
    for name, rows in recorded.items():
        if rows.shape[1] == 1:
            yield name, rows[:, 0]
        else:
            yield from ((f"{name}_{i + 1}", rows[:, i]) for i in range(rows.shape[1]))
