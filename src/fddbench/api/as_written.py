"""What the frozen texts of a folder of results say by themselves: read without running a plug-in that lies beside them."""

import json
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from fddbench import kinds
from fddbench.campaign.finding import document_of
from fddbench.campaign.ground import ground_of
from fddbench.campaign.reading.document import Document, refuse
from fddbench.campaign.reading.yaml_nodes import read_yaml
from fddbench.campaign.rules.messages import mistakes_of
from fddbench.campaign.rules.model import CampaignFile, campaign_file
from fddbench.designs.design_file import DesignFile
from fddbench.errors import FddbenchError
from fddbench.interfaces import Benchmark
from fddbench.plugin_files import none_run
from fddbench.results.folder import provenance_of

__all__ = [
    "benchmark_as_written",
    "campaign_as_written",
    "designs_as_written",
    "in_sample_as_written",
    "voted_as_written",
]

_File = TypeVar("_File", bound=BaseModel)


def campaign_as_written(folder: Path) -> CampaignFile:
    """The campaign's keys; whether its parts exist and fit each other is not asked.

    Raises
    ------
    CampaignError
        It is no campaign.
    """
    document = document_of(folder / "campaign.yaml")
    others = tuple(key for key in document.data if key not in CampaignFile.model_fields)
    return _valid(document, campaign_file(others))


def benchmark_as_written(folder: Path) -> Benchmark | None:
    """Its benchmark, where a package registered it; None for one in a file."""
    with none_run():
        return ground_of(document_of(folder / "campaign.yaml"), folder).benchmark


def designs_as_written(folder: Path) -> dict[str, DesignFile]:
    """Files of its designs by the names of the detectors, variants of a sweep included.

    Raises
    ------
    FddbenchError
        No folder of results, or a file is no design.
    """
    bases = {name: name.split(".")[0] for name in provenance_of(folder)["designs_sha256"]}
    files = {
        base: _valid(read_yaml(folder / "detectors" / f"{base}.yaml"), DesignFile)
        for base in dict.fromkeys(bases.values())
    }
    return {name: files[base] for name, base in bases.items()}


def in_sample_as_written(folder: Path) -> tuple[str, ...]:
    """Detectors whose designs say that they were tuned on these flights."""
    known = provenance_of(folder)
    own = (known["campaign"], known["seed"])
    return tuple(
        name
        for name, design in designs_as_written(folder).items()
        if any((seen.campaign, seen.seed) == own for seen in design.tuned_on or ())
    )


def voted_as_written(folder: Path) -> tuple[str, ...]:
    """Detectors of registered kinds that see the voted signal alone; what one in a file sees, only running it would tell."""
    return tuple(name for name, design in designs_as_written(folder).items() if _sees(design.kind) == "voted")


def _sees(kind: str) -> str:
    if kinds.is_file_kind(kind):
        return "sensors"
    try:
        return str(getattr(kinds.load("detector", kind), "sees", "sensors"))
    except FddbenchError:
        return "sensors"


def _valid(document: Document, model: type[_File]) -> _File:
    """What a document says in the keys of a model."""
    try:
        return model.model_validate_json(json.dumps(document.data), strict=True)
    except ValidationError as error:
        refuse(mistakes_of(error, document, model=model))
        raise
