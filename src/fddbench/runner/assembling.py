"""From a campaign to what flies it."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import Plan, plan
from fddbench.designs.building import build_detectors
from fddbench.errors import FddbenchError, place_of, reason_of
from fddbench.interfaces import Loop, Options
from fddbench.metrics.consequences import Consequences
from fddbench.metrics.scoring import Scoring
from fddbench.plugin_files import noticed_reads
from fddbench.runner.assembly import Assembly
from fddbench.runner.firsts import first_samples
from fddbench.runner.in_c import code_of_design, require_allowed
from fddbench.runner.reconfiguration import require_able, require_commander
from fddbench.runner.soundness import require_sound

__all__ = ["assemble", "loop_of", "with_detectors"]


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
        with noticed_reads(campaign.path.parent) as read:
            loop = campaign.bench.loop(options)
    except FddbenchError:
        raise
    except (Exception, SystemExit) as error:
        raise FddbenchError(
            f"benchmark {campaign.benchmark!r} cannot make its loop: {reason_of(error)}{place_of(error)}"
        ) from error
    stray = sorted(set(read) - set(campaign.beside))
    if stray and campaign.beside:
        raise FddbenchError(
            f"benchmark {campaign.benchmark!r} reads {', '.join(stray)} beside the campaign, which would not travel with the "
            f"results; declare it in its Python file: FILES = ({', '.join(map(repr, stray))},)"
        )
    return loop


def _foreign(part: Any) -> bool:
    """Whether a class, or the class of a value, is somebody else's."""
    module = getattr(part, "__module__", None) or type(part).__module__
    return not module.startswith(("fddbench.", "builtins"))


def assemble(campaign: Campaign) -> Assembly:
    """Loop, detectors and scoring of a campaign.

    Raises
    ------
    CampaignError
        A design does not make a detector for this benchmark, or the aircraft cannot act on the one it shall act on.
    """
    planned = plan(campaign)
    loop = loop_of(planned)
    require_able(campaign, loop)
    n_faults = max((len(scenario.faults) for scenario in planned.scenarios), default=0) + planned.n_labelled
    units = [site.unit_name for site in loop.bus.sites]
    scoring = Scoring(loop.bus.names, n_faults, campaign.sample_s, units=units)
    consequences = Consequences(getattr(loop, "consequences", ()), loop.truth)
    assembly = Assembly(plan=planned, loop=loop, detectors={}, scoring=scoring, consequences=consequences)
    faults = [fault for scenario in campaign.scenarios for fault in scenario.faults]
    if any(map(_foreign, (campaign.bench, campaign.plant, loop, *campaign.chosen.values(), *faults))):
        require_sound(assembly)
    found = build_detectors(campaign.designs, loop.bus, lambda: first_samples(assembly))
    require_allowed(campaign, found, loop.bus)
    found = {design.name: code_of_design(design, found[design.name], loop.bus) for design in campaign.designs}
    require_commander(campaign, found)
    return replace(assembly, detectors=found)


def with_detectors(campaign: Campaign, names: Sequence[str]) -> Campaign:
    """The same flights with some of the detectors, and the one on which the aircraft acts; with all for no name."""
    if not names:
        return campaign
    kept = tuple(design for design in campaign.designs if design.name in names or design.name == campaign.reconfigure)
    return replace(campaign, designs=kept)
