"""From a campaign to what flies it."""

from dataclasses import replace

from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import plan
from fddbench.designs.building import build_detectors
from fddbench.metrics.scoring import Scoring
from fddbench.runner.assembly import Assembly, has_events
from fddbench.runner.firsts import first_samples
from fddbench.runner.loops import loop_of, try_loop

__all__ = ["assemble"]


def assemble(campaign: Campaign) -> Assembly:
    """Loop, detectors and scoring of a campaign.

    Raises
    ------
    FddbenchError
        The benchmark cannot be flown with what was chosen, or a design does not make a detector for it.
    """
    planned = plan(campaign)
    loop = loop_of(planned)
    n_events = max((len(s.faults) for s in planned.scenarios if has_events(s)), default=0)
    assembly = Assembly(plan=planned, loop=loop, detectors={}, scoring=Scoring(len(loop.bus.sites), n_events))
    try_loop(assembly)
    found = build_detectors(campaign.designs, loop.bus, lambda: first_samples(assembly))
    assembly = replace(assembly, detectors=found)
    return assembly
