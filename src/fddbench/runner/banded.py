"""Flies all flights of scenarios again and keeps quantiles of their signals over time, in little memory."""

from collections.abc import Collection, Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt
import pandas as pd

from fddbench.blocks.philox import philox4x32
from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import PlannedScenario
from fddbench.interfaces import NEVER, QUANTILES, Bands, Floats
from fddbench.runner.assembling import assemble
from fddbench.runner.assembly import Assembly, Batch
from fddbench.runner.flight import Flyer

__all__ = ["MOST_FLIGHTS", "bands_of", "quantiles"]

MOST_FLIGHTS = 1000
"""Of more flights of a scenario a seeded sample is flown again."""

_PART = 32
"""Flights recorded side by side; their signals are thinned before the next ones fly. No part of any result."""
_POINTS = 300
_BEFORE_S = 1.0

Samples = npt.NDArray[np.int64]
Recorded = Mapping[str, Floats]


def bands_of(
    campaign: Campaign, rows: pd.DataFrame, *, signals: Collection[str], seconds: Mapping[str, float]
) -> Iterator[Bands]:
    """Bands of every scenario that was flown, in the order of the campaign.

    Parameters
    ----------
    campaign : Campaign
        What flies.
    rows : DataFrame
        Its rows: which flights are shown.
    signals : collection of str
        Measured and true signals to keep, all rows of each; those that the loop does not have are left out.
    seconds : mapping of str to float
        By scenario, how long after the onset of its fault the bands stop [s]; those of healthy flights go to the end.
    """
    flyer = Flyer(assemble(campaign))
    flown = rows[np.asarray(rows["status"] == "ok", dtype=bool)].drop_duplicates("case")
    for planned in flyer.assembly.plan.scenarios:
        names = _ordered(flown[np.asarray(flown["scenario"] == planned.name, dtype=bool)], campaign.seed)
        if names:
            yield _bands(flyer, planned, names, signals, seconds.get(planned.name))


def _ordered(flights: pd.DataFrame, seed: int) -> list[str]:
    """Names of flights in an order that is drawn by the seed."""
    run, point, level = (flights[name].to_numpy(dtype=np.int64) for name in ("run", "point", "level"))
    order = np.argsort(philox4x32((run, point, level, 0), seed)[0], kind="stable")
    return [str(name) for name in flights["case"].to_numpy()[order]]


def _bands(
    flyer: Flyer, planned: PlannedScenario, names: Sequence[str], signals: Collection[str], seconds: float | None
) -> Bands:
    assembly, chosen = flyer.assembly, names[:MOST_FLIGHTS]
    batch = assembly.batch(assembly.plan.numbers(chosen, planned.name))
    at = _samples(assembly, batch, seconds)
    kept = _kept(assembly, signals)
    shown = {name: ("residual", *own.recorded) for name, own in assembly.detectors.items()}
    asked = [*kept, *(f"{name}:{signal}" for name, own in shown.items() for signal in ("n_declared", *own))]
    found = _thinned(flyer, assembly.shortened(batch, float(at[-1])), asked, at)
    own = {row: _unwound(row, values) for key, name in kept.items() for row, values in _rows(name, found[key])}
    sample_s = assembly.loop.bus.sample_s
    return Bands(
        scenario=planned.name,
        manoeuvre=planned.manoeuvre,
        flights=len(chosen),
        of=len(names),
        case=chosen[0],
        time_s=np.round(at * sample_s, 9),
        onset_s=round(float(k0) * sample_s, 9) if (k0 := batch.faults.k0.min()) < NEVER else None,
        signals={name: quantiles(values) for name, values in own.items()},
        one={name: values[:, 0] for name, values in own.items()},
        detectors={
            name: {signal: quantiles(found[f"{name}:{signal}"][:, 0]) for signal in each}
            for name, each in shown.items()
        },
        declared={name: _shares(found[f"{name}:n_declared"][:, 0]) for name in shown},
    )


def _samples(assembly: Assembly, batch: Batch, seconds: float | None) -> Samples:
    """Samples that are kept: about 300 of the flight, or from 1 s before the first onset on."""
    per_s, first, last = 1.0 / assembly.loop.bus.sample_s, 0, int(assembly.ends(batch).max())
    begun = batch.faults.k0[batch.faults.k0 < NEVER]
    if len(begun):
        first = max(int(begun.min()) - round(_BEFORE_S * per_s), 0)
        if seconds is not None:
            last = min(last, int(begun.max()) + round(seconds * per_s))
    return np.arange(first, last + 1, max((last - first) // _POINTS, 1))


def _kept(assembly: Assembly, signals: Collection[str]) -> dict[str, str]:
    """Outputs of the loop to record, and what the signals are called."""
    sources = {**dict.fromkeys(assembly.loop.bus.signals, "measured"), **dict.fromkeys(assembly.loop.truth, "truth")}
    return {f"{source}:{name}": name for name, source in sources.items() if name in signals}


def _thinned(flyer: Flyer, batch: Batch, recorded: Sequence[str], at: Samples) -> Recorded:
    """Outputs of all cases at some samples only, (n_time, n_rows, n_cases); NaN after the end of a flight."""
    parts: dict[str, list[Floats]] = {name: [] for name in recorded}
    for start in range(0, len(batch.cases), _PART):
        part = batch.take(np.arange(start, min(start + _PART, len(batch.cases))))
        flown = flyer.fly(part, recorded).recorded
        for name, kept in parts.items():
            values = flown[name]
            rows = np.full((len(at), *values.shape[1:]), np.nan)
            rows[at < len(values)] = values[at[at < len(values)]]
            kept.append(rows)
    return {name: np.concatenate(kept, axis=2) for name, kept in parts.items()}


def _rows(name: str, values: Floats) -> Iterator[tuple[str, Floats]]:
    """A signal of one row by its name, rows of several numbered from 1; (n_time, n_cases) each."""
    if values.shape[1] == 1:
        yield name, values[:, 0]
    else:
        yield from ((f"{name}_{i + 1}", values[:, i]) for i in range(values.shape[1]))


def _unwound(name: str, values: Floats) -> Floats:
    """An angle that goes on beyond half a turn, and anything else as it is."""
    found: Floats = np.unwrap(values, period=360.0, axis=0) if name.endswith("_deg") else values
    return found


def quantiles(values: Floats) -> Floats:
    """Observed values at `QUANTILES` of those that are there, (n_quantile, n_time), of (n_time, n_cases); NaN: none is.

    >>> quantiles(np.array([[3.0, 1.0, 2.0, np.nan]]))[:, 0]
    array([1., 1., 1., 2., 3., 3., 3.])
    """
    ordered = np.sort(values, axis=1)  # NaN last
    there = np.sum(~np.isnan(ordered), axis=1)
    return np.stack(
        [
            np.take_along_axis(ordered, np.maximum(np.ceil(q * there) - 1, 0).astype(np.int64)[:, np.newaxis], axis=1)[
                :, 0
            ]
            for q in QUANTILES
        ]
    )


def _shares(n_declared: Floats) -> Floats:
    """Share of the flights that still fly with 0, 1, 2, … declared sites, (n_count, n_time)."""
    most = int(np.nanmax(n_declared, initial=2.0))
    there = np.maximum(np.sum(~np.isnan(n_declared), axis=1), 1)
    return np.stack([np.sum(n_declared == count, axis=1) / there for count in range(most + 1)])
