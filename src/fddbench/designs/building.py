"""Detectors of a campaign from its designs, each looked at before anything is flown with it."""

from collections.abc import Sequence

from fddbench.campaign.reading.document import refuse
from fddbench.designs.adapted import Adapted
from fddbench.designs.design import Design
from fddbench.designs.reasons import place_in
from fddbench.designs.soundness import Samples, unsound
from fddbench.errors import DesignError, Mistake, raise_interrupt, reason_of
from fddbench.interfaces import Bus, Detector

__all__ = ["build_detectors"]


def build_detectors(designs: Sequence[Design], bus: Bus, samples: Samples | None = None) -> dict[str, Adapted]:
    """Detectors by the name of their design, in order; `samples` is what those of ordinary Python are tried on.

    Raises
    ------
    CampaignError
        The numbers of a design make no detector for this bus; located where the campaign names the design.
    """
    found: dict[str, Adapted] = {}
    mistakes = []
    for design in designs:
        try:
            built = design.build(bus)
        except DesignError as error:
            wrong = f"{design.kind.name} {error}" if str(error).startswith("needs ") else str(error)
            wrong += (
                f" (with every: {design.every} its samples are {design.sample_s(bus):g} s apart)"
                if design.every > 1
                else ""
            )
        except BaseException as error:  # a plug-in may raise anything
            raise_interrupt(error)
            wrong = f"from_design raised {reason_of(error)}{place_in(error, design.kind.member, 'from_design')}"
        else:
            wrong = _unsound(found, design, built, bus, samples)
        if wrong:
            mistakes.append(Mistake(design.where, f"design {design.name!r} ({design.path}): {wrong}"))
    refuse(mistakes)
    return found


def _unsound(found: dict[str, Adapted], design: Design, built: Detector, bus: Bus, samples: Samples | None) -> str:
    """What is wrong with a detector, "" for nothing; then it is among those found."""
    try:
        found[design.name] = Adapted(built, bus, design.every, design)
    except BaseException as error:
        raise_interrupt(error)
        return f"it is no detector: {reason_of(error)}"
    return unsound(found[design.name], samples)
