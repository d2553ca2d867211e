"""One design on the benchmark of a campaign: what commands about a single detector look at."""

import json
from dataclasses import replace
from pathlib import Path

from fddbench import gallery
from fddbench.campaign.reading.overrides import ALONE
from fddbench.errors import CampaignError, FddbenchError
from fddbench.runner.assembling import assemble
from fddbench.runner.assembly import Assembly
from fddbench.runner.supervised.trial import read_safely

__all__ = ["assembly_with"]


def assembly_with(detector: str, campaign: Path | None) -> Assembly:
    """Assembly of a campaign with a design, or with a variant of one that the campaign sweeps."""
    own = read_safely(campaign) if campaign else None
    swept = [design for design in own.designs if design.name == detector and design.swept] if own else []
    if own is None or not swept:
        return _one_detector(detector, campaign)
    return assemble(replace(own, designs=tuple(swept), reconfigure=""))


def _one_detector(design: str, campaign: Path | None) -> Assembly:
    """Assembly of a campaign with one detector; without a campaign the first shipped one whose benchmark feeds it."""
    shipped = [Path("smoke"), *(Path(path.stem) for path in sorted(gallery.folder("campaigns").glob("*.yaml")))]
    first: FddbenchError | None = None
    alone = f"detectors=[{json.dumps(design)}]"
    for path in [campaign] if campaign else shipped:
        try:
            return assemble(read_safely(path, [alone, *ALONE]))
        except CampaignError as error:
            # nobody has written this --set
            mine = (replace(each, where="") if each.where == f"--set {alone}" else each for each in error.mistakes)
            first = first or CampaignError(tuple(mine))
        except FddbenchError as error:
            first = first or error
    assert first is not None
    raise first
