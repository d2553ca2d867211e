"""Flights with their signals and, at each sample, what was faulty: for those who train detectors."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import PlannedScenario
from fddbench.faults.timing import first_samples
from fddbench.interfaces import NEVER, Fault, Floats
from fddbench.runner.assembling import assemble
from fddbench.runner.assembly import Assembly, Batch
from fddbench.runner.flight import Flyer

__all__ = ["Labelled", "Signals", "labelled_flights", "without_detectors"]

_TOGETHER = 16
"""Flights recorded side by side: their signals at full rate are in memory; no part of any result."""

Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True)
class Signals:
    """Names of what is recorded, rows of one signal numbered from 1: ``r_deg_s_1``."""

    measured: tuple[str, ...]
    truth: tuple[str, ...]
    sites: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Labelled:
    """Some flights of one scenario, thinned to every so manieth sample.

    Attributes
    ----------
    cases : tuple of str
        Their names.
    run : (n_cases,) array
        Numbers of their aircraft.
    static : mapping of str to (n_cases,) arrays
        Parameters ``p_…``, drawn sizes ``f1_…``, ``onset_s``; not-a-number: none.
    reasons : tuple of str
        Why a flight cannot be flown; "" for one that can.
    time_s : (n_time,) array
        Time since the start [s].
    there : (n_time, n_cases) array
        Whether the flight still flies.
    departed : (n_cases,) array
        Whether it ended before its time.
    measured, truth : mapping of str to (n_time, n_cases) arrays
        Signals.
    faulty : mapping of str to (n_time, n_cases) arrays
        By site, whether it is faulty.
    fault : (n_time, n_cases) array of text
        Kinds of the faults that act, joined by +; "none".
    """

    scenario: PlannedScenario
    cases: tuple[str, ...]
    run: npt.NDArray[np.int64]
    static: Mapping[str, Floats]
    reasons: tuple[str, ...]
    time_s: Floats
    there: Flags
    departed: Flags
    measured: Mapping[str, Floats]
    truth: Mapping[str, Floats]
    faulty: Mapping[str, Flags]
    fault: npt.NDArray[np.object_]


def without_detectors(campaign: Campaign) -> Campaign:
    """The same flights, without those who judge them; the detector on which an aircraft acts is a part of the flight."""
    kept = tuple(design for design in campaign.designs if design.name == campaign.reconfigure)
    return replace(campaign, designs=kept)


def labelled_flights(campaign: Campaign, *, every: int) -> tuple[Signals, Iterator[Labelled]]:
    """All flights of a campaign, scenario by scenario and case by case, every so manieth sample of them."""
    flyer = Flyer(assemble(without_detectors(campaign)))
    loop = flyer.assembly.loop
    rows = {f"measured:{name}": name for name in loop.bus.signals} | {f"truth:{name}": name for name in loop.truth}
    first = next(_parts(flyer, rows, every, most=1), None)
    named = Signals(
        measured=tuple(first.measured) if first else (), truth=tuple(first.truth) if first else (), sites=loop.bus.names
    )
    return named, _parts(flyer, rows, every)


def _parts(flyer: Flyer, rows: Mapping[str, str], every: int, most: int = _TOGETHER) -> Iterator[Labelled]:
    assembly = flyer.assembly
    for number, planned in enumerate(assembly.plan.scenarios):
        for start in range(0, planned.n_cases, most):
            numbers = planned.first_case + np.arange(start, min(start + most, planned.n_cases), dtype=np.int64)
            yield _labelled(flyer, number, planned, assembly.batch(numbers), rows, every)


def _labelled(
    flyer: Flyer, number: int, planned: PlannedScenario, batch: Batch, rows: Mapping[str, str], every: int
) -> Labelled:
    assembly, n = flyer.assembly, len(batch.cases)
    able = np.flatnonzero([reason == "" for reason in batch.infeasible_reason])
    at = np.arange(0, max(planned.samples), every)
    there, departed = np.zeros((len(at), n), dtype=bool), np.zeros(n, dtype=bool)
    signals: dict[str, dict[str, Floats]] = {"measured": {}, "truth": {}}
    if len(able):
        flown = batch.take(able)
        found = flyer.fly(flown, list(rows))
        last = np.minimum(assembly.ends(flown), found.departed - 1.0)
        departed[able] = last < assembly.ends(flown)
        there[:, able] = at[:, np.newaxis] <= last
        for key, name in rows.items():
            values = found.recorded[key]
            for i in range(values.shape[1]):
                own = np.full((len(at), n), np.nan)
                seen = at < len(values)
                own[np.ix_(seen, able)] = values[at[seen], i]
                signals[key.split(":")[0]][name if values.shape[1] == 1 else f"{name}_{i + 1}"] = own
    faulty, fault = _labels(assembly, number, batch, at)
    sample_s = assembly.loop.bus.sample_s
    k0 = batch.faults.k0
    static = {"onset_s": np.where(k0 == NEVER, np.nan, np.round(k0 * sample_s, 9))}
    static |= dict(batch.faults.numbers) | {f"p_{name}": values for name, values in batch.parameters.items()}
    return Labelled(
        scenario=planned,
        cases=assembly.plan.names(batch.cases),
        run=batch.run,
        static=static,
        reasons=tuple(batch.infeasible_reason),
        time_s=np.round(at * sample_s, 9),
        there=there,
        departed=departed,
        measured=signals["measured"],
        truth=signals["truth"],
        faulty=faulty,
        fault=fault,
    )


def _labels(
    assembly: Assembly, scenario: int, batch: Batch, at: npt.NDArray[np.int64]
) -> tuple[dict[str, Flags], npt.NDArray[np.object_]]:
    """By site whether it is faulty, and which kinds of faults act, at samples of flights of one scenario."""
    plan, shape = assembly.plan, (len(at), len(batch.cases))
    faults, _ = plan.flown(scenario, batch.level, batch.run)
    faulty = {name: np.zeros(shape, dtype=bool) for name in assembly.loop.bus.names}
    acting = np.zeros(shape, dtype=np.int64)
    for line, fault in enumerate(faults):
        firsts = first_samples(fault, fault.sites, plan.campaign.sample_s)
        for site, first in zip(fault.sites, firsts, strict=True):
            on = (at[:, np.newaxis] >= first) & (at[:, np.newaxis] <= batch.faults.last[line])
            faulty[site] |= on
            acting |= on.astype(np.int64) << line
    return faulty, _named(faults)[acting]


def _named(faults: tuple[Fault, ...] | list[Fault]) -> npt.NDArray[np.object_]:
    """Text of each set of faults, by the bits of its lines."""
    kinds = [fault.kind for fault in faults]
    sets = [[kind for k, kind in enumerate(kinds) if code >> k & 1] for code in range(1 << len(kinds))]
    return np.array(["+".join(dict.fromkeys(each)) or "none" for each in sets], dtype=object)
