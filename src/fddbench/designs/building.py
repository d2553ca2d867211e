"""Detectors of a campaign from its designs, each looked at before anything is flown with it."""

from collections.abc import Sequence

from fddbench.campaign.reading.document import refuse
from fddbench.designs.design import Design
from fddbench.designs.soundness import line_of, unsound
from fddbench.errors import DesignError, Mistake, reason_of
from fddbench.interfaces import Bus, Detector

__all__ = ["build_detectors"]


def build_detectors(designs: Sequence[Design], bus: Bus) -> dict[str, Detector]:
    """Detectors by the name of their design, in order.

    Raises
    ------
    CampaignError
        The numbers of a design make no detector for this bus; located where the campaign names the design.
    """
    found: dict[str, Detector] = {}
    mistakes = []
    for design in designs:
        try:
            found[design.name] = design.build(bus)
        except DesignError as error:
            wrong = f"{design.kind.name} {error}" if str(error).startswith("needs ") else str(error)
        except (Exception, SystemExit) as error:  # a plug-in may raise anything
            wrong = f"from_design raised {reason_of(error)}{line_of(error, design.kind.member, 'from_design')}"
        else:
            wrong = unsound(found[design.name], bus)
        if wrong:
            mistakes.append(Mistake(design.where, f"design {design.name!r} ({design.path}): {wrong}"))
    refuse(mistakes)
    return found
