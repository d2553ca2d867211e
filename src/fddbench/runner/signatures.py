"""Flies some flights of every faulty scenario without detectors and keeps what their faults really add on every site."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import PlannedScenario, plan
from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats
from fddbench.metrics.bound import Faults
from fddbench.metrics.scoring import Scoring
from fddbench.runner.assembling import loop_of
from fddbench.runner.assembly import Assembly, Batch
from fddbench.runner.flight import Flyer

__all__ = ["MOST_FLIGHTS", "Signature", "signatures"]

MOST_FLIGHTS = 25
"""Flights of a scenario that are flown, evenly spaced among all of them."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Signature:
    """Faults of some flights of a scenario, within their time limits.

    Attributes
    ----------
    scenario : str
        Its name.
    batch : Batch
        The flights.
    faults : Faults
        What they add, from the first faulty sample to the limit or the end of the flight.
    window_s : float
        Longest such time [s].
    """

    scenario: str
    batch: Batch
    faults: Faults
    window_s: float


def signatures(campaign: Campaign, most: int = MOST_FLIGHTS) -> Iterator[Signature]:
    """Signatures of the faulty scenarios of a campaign, in their order; a scenario that cannot fly is left out.

    The aircraft acts on no detector: its law flies on, so a fault that depends on the signal is what it is without help.

    Raises
    ------
    FddbenchError
        The benchmark does not say what its faults add.
    """
    planned = plan(campaign)
    loop = loop_of(planned)
    n_faults = max((len(scenario.faults) for scenario in planned.scenarios), default=0)
    units = [site.unit_name for site in loop.bus.sites]
    scoring = Scoring(loop.bus.names, n_faults, campaign.sample_s, units=units)
    flyer = Flyer(Assembly(plan=planned, loop=loop, detectors={}, scoring=scoring))
    for scenario in planned.scenarios:
        if scenario.faults and (found := _signature(flyer, scenario, most)) is not None:
            yield found


def _signature(flyer: Flyer, planned: PlannedScenario, most: int) -> Signature | None:
    assembly = flyer.assembly
    places = np.unique(np.linspace(0, planned.n_cases - 1, min(most, planned.n_cases)).round().astype(np.int64))
    batch = assembly.batch(planned.first_case + places)
    batch = batch.take(np.flatnonzero([reason == "" for reason in batch.infeasible_reason]))
    if not len(batch.cases):
        return None
    sample_s, k0 = assembly.loop.bus.sample_s, batch.faults.k0
    last = np.minimum(assembly.ends(batch), k0 + np.round(batch.faults.limit_s / sample_s))
    recorded = flyer.fly(assembly.shortened(batch, last), ["added"]).recorded
    if "added" not in recorded:
        raise FddbenchError(
            f"benchmark {assembly.plan.campaign.benchmark!r} does not say what its faults add (`Sample.added`): no bound"
        )
    windows = last - k0 + 1.0
    return Signature(
        scenario=planned.name,
        batch=batch,
        faults=Faults(added=_from_onset(assembly, planned, recorded["added"], k0, windows), before=k0),
        window_s=float((windows.max() - 1.0) * sample_s),
    )


def _from_onset(
    assembly: Assembly, planned: PlannedScenario, added: Floats, k0: Floats, windows: Floats
) -> dict[str, Floats]:
    """What is added on each faulty site, (n_time, n_cases), flights side by side from their first faulty samples."""
    names, n_time = assembly.loop.bus.names, int(windows.max())
    at = k0.astype(np.int64) + np.arange(n_time)[:, np.newaxis]
    inside = np.arange(n_time)[:, np.newaxis] < windows
    at = np.minimum(at, len(added) - 1)
    found = {}
    for site in planned.faulty_sites:
        rows = np.take_along_axis(added[:, names.index(site)], at, axis=0)
        found[site] = np.where(inside, np.nan_to_num(rows), 0.0)
    return found
