"""Reads a campaign file: every mistake at once with its place, or what the campaign means."""

import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from fddbench import gallery
from fddbench.campaign.canonical import canonical_text, fingerprint
from fddbench.campaign.consistency import inconsistencies
from fddbench.campaign.designs import Design, find_design, read_design
from fddbench.campaign.document import Document, refuse
from fddbench.campaign.fault_entries import Faults, load_kind, read_faults
from fddbench.campaign.meaning import Campaign, Scenario
from fddbench.campaign.messages import mistakes_of
from fddbench.campaign.model import NAME_PATTERN, CampaignFile
from fddbench.campaign.overrides import with_overrides
from fddbench.campaign.references import CHOICES, default_choice, unknown_names
from fddbench.campaign.wording import shown
from fddbench.campaign.yaml_nodes import read_yaml
from fddbench.errors import CampaignError, FddbenchError, Mistake, did_you_mean
from fddbench.interfaces import Benchmark

__all__ = ["find_campaign", "read_campaign"]


def read_campaign(path: Path, overrides: Sequence[str] = ()) -> Campaign:
    """Campaign of a file, or of a shipped campaign's bare name, with ``path=value`` overrides applied.

    Raises
    ------
    CampaignError
        Every mistake in the file, in the overrides and in the designs it names.
    """
    path = find_campaign(path)
    document = with_overrides(_document(path), overrides)
    mistakes: list[Mistake] = []
    written = None
    try:
        written = CampaignFile.model_validate_json(json.dumps(document.data), strict=True)
    except ValidationError as error:
        mistakes += mistakes_of(error, document, model=CampaignFile)
    benchmark, unknown = _benchmark(document)
    faults, wrong = read_faults(document, benchmark)
    mistakes += wrong
    designs, wrong = _designs(document, path.parent)
    mistakes += [*wrong, *unknown]
    if benchmark is not None:
        mistakes += unknown_names(document, benchmark)
    if written is not None and benchmark is not None and not mistakes:
        mistakes += inconsistencies(document, written, faults, benchmark)
    if written is not None:
        mistakes += _tuned_on_these_flights(written, designs)
    refuse(mistakes)
    assert written is not None
    assert benchmark is not None
    return _meaning(document, path, written, faults, designs, benchmark)


def find_campaign(path: Path) -> Path:
    """File of a campaign: as given, or a shipped one of that bare name.

    Raises
    ------
    CampaignError
        There is none.
    """
    if path.is_file():
        return path
    try:
        shipped = {file.stem: file for file in gallery.folder("campaigns").glob("*.yaml")}
    except FddbenchError:
        shipped = {}
    bare = path.name.removesuffix(".yaml")
    if path.parent == Path() and bare in shipped:
        return shipped[bare]
    what = "is a folder; give the campaign.yaml in it" if path.is_dir() else "no such file."
    hint = "" if path.is_dir() else did_you_mean(bare, shipped)
    names = f"Shipped campaigns: {', '.join(sorted(shipped)) or 'none'}"
    raise CampaignError((Mistake(str(path), " ".join(filter(None, [what, hint, "" if path.is_dir() else names]))),))


def _document(path: Path) -> Document:
    document = read_yaml(path)
    if document.data is None:
        refuse(
            [
                document.mistake(
                    (), "the file is empty; a campaign starts with name, benchmark, seed, scenarios, detectors"
                )
            ]
        )
    if not isinstance(document.data, dict):
        message = f"a campaign is a mapping of keys (name, benchmark, seed, …), got {shown(document.data)}"
        refuse([document.mistake((), message)])
    return document


def _benchmark(document: Document) -> tuple[Benchmark | None, list[Mistake]]:
    name = document.get("benchmark")
    if not isinstance(name, str):
        return None, []
    try:
        return load_kind("benchmark", name)(), []
    except FddbenchError as error:
        return None, [document.mistake(("benchmark",), str(error))]


def _designs(document: Document, folder: Path) -> tuple[tuple[Design, ...], list[Mistake]]:
    found: list[Design] = []
    mistakes: list[Mistake] = []
    for number, name in enumerate(document.items("detectors")):
        where = document.where(("detectors", number))
        if not isinstance(name, str) or not re.fullmatch(NAME_PATTERN, name):
            continue
        try:
            found.append(read_design(find_design(name, folder), where=where))
        except CampaignError as error:
            mistakes += error.mistakes
        except FddbenchError as error:
            mistakes.append(Mistake(where, str(error)))
    return tuple(found), mistakes + _namesakes(found)


def _namesakes(designs: Sequence[Design]) -> list[Mistake]:
    """Different plug-in files of one name: only one of them could be kept beside the results."""
    first: dict[str, Design] = {}
    mistakes = []
    for design in designs:
        if design.plugin is None:
            continue
        other = first.setdefault(design.plugin.file, design)
        if other.plugin != design.plugin:
            mistakes.append(
                Mistake(
                    design.where,
                    f"the plug-ins of {other.name!r} and {design.name!r} are different files of the same name "
                    f"{design.plugin.file}; rename one",
                )
            )
    return mistakes


def _tuned_on_these_flights(written: CampaignFile, designs: Sequence[Design]) -> list[Mistake]:
    if written.purpose == "tuning":
        return []
    return [
        Mistake(
            design.where,
            f"design {design.name!r} was tuned on campaign {written.name!r} with seed {written.seed}: its score on the "
            "same flights would flatter it. Change the seed, or write purpose: tuning if this is the tuning",
        )
        for design in designs
        if any((seen.campaign, seen.seed) == (written.name, written.seed) for seen in design.tuned_on)
    ]


def _meaning(
    document: Document,
    path: Path,
    written: CampaignFile,
    faults: Faults,
    designs: tuple[Design, ...],
    benchmark: Benchmark,
) -> Campaign:
    choices: dict[str, Any] = {key: getattr(written, key) or default_choice(benchmark, key) for key in CHOICES}
    scenarios = tuple(
        Scenario(
            name=entry.name,
            manoeuvre=entry.manoeuvre,
            faults=faults[number],
            runs=entry.runs,
            duration_s=entry.duration_s,
            detection_time_limit_s=entry.detection_time_limit_s,
        )
        for number, entry in enumerate(written.scenarios)
    )
    content = written.model_dump(mode="json", exclude={"about", "scenarios"}) | choices
    content["scenarios"] = [
        entry.model_dump(mode="json")
        | {"faults": [fault.model_dump(mode="json", by_alias=True) for fault in faults[number]]}
        for number, entry in enumerate(written.scenarios)
    ]
    content["designs"] = {design.name: design.sha256 for design in designs}
    return Campaign(
        path=path,
        **{key: getattr(written, key) for key in _AS_WRITTEN},
        **choices,
        scenarios=scenarios,
        designs=designs,
        text=canonical_text(document.data),
        sha256=fingerprint(content),
    )


_AS_WRITTEN = ("name", "about", "benchmark", "purpose", "seed", "sample_s", "substeps", "duration_s", "dispersions")
