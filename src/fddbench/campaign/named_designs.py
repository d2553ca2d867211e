"""The designs that a campaign names, with the gains that it sweeps."""

import json
import re
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from fddbench.campaign.reading.document import Address, Document
from fddbench.campaign.rules.model import NAME_PATTERN, CampaignFile
from fddbench.campaign.rules.swept import Sweep, SweptDesign
from fddbench.designs.design import Design, read_design
from fddbench.designs.finding import find_design
from fddbench.designs.sweeps import variants
from fddbench.errors import CampaignError, FddbenchError, Mistake

__all__ = ["designs_of", "tuned_on_these_flights"]


def designs_of(document: Document, folder: Path) -> tuple[tuple[Design, ...], list[Mistake]]:
    """Designs in the order of the file, one of several values of a gain several times, and what is wrong with them."""
    found: list[Design] = []
    mistakes: list[Mistake] = []
    for number, entry in enumerate(document.items("detectors")):
        at: Address = ("detectors", number)
        name = entry.get("design") if isinstance(entry, dict) else entry
        if not isinstance(name, str) or not re.fullmatch(NAME_PATTERN, name):
            continue
        where = document.where(at)
        try:
            design = read_design(find_design(name, folder), where=where)
            made, wrong = variants(design, _sweeps(entry), document, at) if entry is not name else ([design], [])
            found += made
            mistakes += wrong
        except CampaignError as error:
            mistakes += error.mistakes
        except FddbenchError as error:
            mistakes.append(Mistake(where, str(error)))
    return tuple(found), mistakes + _namesakes(found)


def _sweeps(entry: Any) -> dict[str, Sweep]:
    """Values by the key of the gain that an entry sweeps; what has mistakes is left out, the model tells them."""
    found: dict[str, Sweep] = {}
    listed = entry.get("sweep") if isinstance(entry, dict) else None
    for key, values in (listed if isinstance(listed, dict) else {}).items():
        with suppress(ValidationError):
            one = {"design": entry.get("design"), "sweep": {key: values}}
            found |= SweptDesign.model_validate_json(json.dumps(one), strict=True).sweeps
    return found


def _namesakes(designs: Sequence[Design]) -> list[Mistake]:
    """Different files of one name that designs stand on: only one of them could be kept beside the results."""
    first: dict[str, Design] = {}
    mistakes = []
    for design in designs:
        for name, content in design.files.items():
            other = first.setdefault(name, design)
            if other.files[name] != content:
                message = (
                    f"the plug-ins of {other.name!r} and {design.name!r} are different files of the same name {name}; "
                    "rename one"
                )
                mistakes.append(Mistake(design.where, message))
    return mistakes


def tuned_on_these_flights(written: CampaignFile, designs: Sequence[Design]) -> list[Mistake]:
    """Designs that were tuned on the very flights that the campaign is to score."""
    if written.purpose == "tuning":
        return []
    return [
        Mistake(
            design.where,
            f"design {design.base!r} was tuned on campaign {written.name!r} with seed {written.seed}: its score on the "
            "same flights would flatter it. Change the seed, or write purpose: tuning if this is the tuning",
        )
        for design in {design.base: design for design in reversed(designs)}.values()
        if any((seen.campaign, seen.seed) == (written.name, written.seed) for seen in design.tuned_on)
    ]
