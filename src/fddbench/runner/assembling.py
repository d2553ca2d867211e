"""From a campaign to what flies it."""

from dataclasses import replace

from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import Plan, plan
from fddbench.designs.building import build_detectors
from fddbench.errors import FddbenchError, place_of, reason_of
from fddbench.interfaces import Loop, Options
from fddbench.metrics.scoring import Scoring
from fddbench.runner.assembly import Assembly, has_events
from fddbench.runner.firsts import first_samples
from fddbench.runner.soundness import require_sound

__all__ = ["assemble", "loop_of"]


def loop_of(planned: Plan) -> Loop:
    """Closed loop of a campaign's benchmark with its options.

    Raises
    ------
    FddbenchError
        The benchmark refuses a choice, or is somebody else's and raises what it likes.
    """
    campaign = planned.campaign
    options = Options(
        chosen=campaign.chosen,
        sample_s=campaign.sample_s,
        substeps=campaign.substeps,
        faults=tuple(scenario.faults for scenario in planned.scenarios),
    )
    try:
        return campaign.bench.loop(options)
    except FddbenchError:
        raise
    except (Exception, SystemExit) as error:
        raise FddbenchError(
            f"benchmark {campaign.benchmark!r} cannot make its loop: {reason_of(error)}{place_of(error)}"
        ) from error


def assemble(campaign: Campaign) -> Assembly:
    """Loop, detectors and scoring of a campaign.

    Raises
    ------
    CampaignError
        A design does not make a detector for this benchmark.
    """
    planned = plan(campaign)
    loop = loop_of(planned)
    n_events = max((len(s.faults) for s in planned.scenarios if has_events(s)), default=0)
    assembly = Assembly(plan=planned, loop=loop, detectors={}, scoring=Scoring(len(loop.bus.sites), n_events))
    found = build_detectors(campaign.designs, loop.bus, lambda: first_samples(assembly))
    assembly = replace(assembly, detectors=found)
    if any(not type(own).__module__.startswith("fddbench.") for own in (campaign.bench, campaign.plant, loop)):
        require_sound(assembly)
    return assembly
