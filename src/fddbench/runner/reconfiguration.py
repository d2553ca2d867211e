"""The one detector on whose declarations the aircraft acts, where a campaign says ``reconfigure``."""

from collections.abc import Mapping, Sequence

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.campaign.meaning import Campaign
from fddbench.campaign.reading.document import refuse
from fddbench.designs.adapted import Adapted
from fddbench.errors import Mistake
from fddbench.interfaces import Floats, Loop, Verdict
from fddbench.runner.assembly import Assembly

__all__ = ["acted_on", "nothing_declared", "require_able", "require_commander", "told", "without_commander"]


def acted_on(verdict: Verdict) -> Rows:
    """What a loop is told of a verdict: rows of 0 and 1 in site order; what is no number declares nothing."""
    return np.where(verdict.declared * 1.0 > 0.0, 1.0, 0.0)


def told(assembly: Assembly, declared: Rows) -> dict[str, Rows]:
    """What the step of a loop is given besides: nothing where the aircraft acts on nobody."""
    return {"declared": declared} if assembly.commander else {}


def nothing_declared(assembly: Assembly, n_cases: int) -> Floats:
    """What is declared before sample 0, (n_sites, n_cases)."""
    return np.zeros((len(assembly.loop.bus.sites), n_cases))


def without_commander(name: str, errors: Mapping[str, Sequence[str]]) -> dict[str, list[str]]:
    """Errors by detector and case, where all share that of the detector on which the aircraft acts.

    What an aircraft does without the detector that it waits for, no campaign says: nobody is scored on such a flight.
    """
    own, found = errors[name], {}
    for other, reasons in errors.items():
        missing = [f"the aircraft acts on {name}, which ended with: {reason}" if reason else "" for reason in own]
        found[other] = list(own) if other == name else [a or b for a, b in zip(missing, reasons, strict=True)]
    return found


def require_able(campaign: Campaign, loop: Loop) -> None:
    """Refuse to reconfigure a benchmark that cannot.

    Raises
    ------
    CampaignError
        Located where the campaign says ``reconfigure``.
    """
    if campaign.reconfigure and not getattr(loop, "reconfigures", False):
        choices = ", ".join(f"{key} {name}" for key, name in campaign.choices.items())
        message = (
            f"benchmark {campaign.benchmark!r}{f' with {choices}' if choices else ''} cannot act on what a detector declares: "
            "its loop has no `reconfigures = True`. Remove this key; fddbench.interfaces.Loop says what such a loop offers"
        )
        refuse([Mistake(campaign.reconfigure_where, message)])


def require_commander(campaign: Campaign, detectors: dict[str, Adapted]) -> None:
    """Refuse a detector on which no aircraft can act.

    Raises
    ------
    CampaignError
        Located where the campaign says ``reconfigure``.
    """
    name = campaign.reconfigure
    wrong = _unable(detectors[name]) if name in detectors else ""
    if wrong:
        able = [other for other, own in detectors.items() if not _unable(own)]
        hint = f"Of this campaign it can act on: {', '.join(able) or 'none'}"
        refuse([Mistake(campaign.reconfigure_where, f"no aircraft can act on {name!r}: {wrong}. {hint}")])


def _unable(own: Adapted) -> str:
    """Why nothing can act on a detector; "" where it can."""
    if not own.isolates:
        return "it only detects and declares no site"
    if not own.watches:
        return "it watches no site of this benchmark, so it never declares one"
    if own.batched and own.opaque:
        return (
            "it cannot be compiled and flies many flights side by side, where an error in one ends the flight of all; without "
            f"`batched = True` it sees one flight at a time ({own.opaque})"
        )
    return ""
