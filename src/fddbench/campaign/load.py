"""Reads a campaign file: every mistake at once with its place, or what the campaign means."""

import json
from collections.abc import Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from fddbench import kinds
from fddbench.campaign.case_table import CaseTable, read_case_table
from fddbench.campaign.finding import document_of, find_campaign
from fddbench.campaign.ground import Ground, ground_of
from fddbench.campaign.meaning import Campaign, Scenario
from fddbench.campaign.named_designs import designs_of, tuned_on_these_flights
from fddbench.campaign.reading.canonical import canonical_text, fingerprint
from fddbench.campaign.reading.document import Document, refuse
from fddbench.campaign.reading.overrides import with_overrides
from fddbench.campaign.rules.consistency import Faults, inconsistencies
from fddbench.campaign.rules.fault_entries import ReadFaults, read_faults
from fddbench.campaign.rules.messages import mistakes_of
from fddbench.campaign.rules.model import CampaignFile, campaign_file
from fddbench.campaign.rules.references import unknown_names
from fddbench.designs.design import Design
from fddbench.errors import FddbenchError, Mistake
from fddbench.results.folder import RESERVED

__all__ = ["read_campaign"]


def read_campaign(path: Path, overrides: Sequence[str] = ()) -> Campaign:
    """Campaign of a file, or of a shipped campaign's bare name, with ``path=value`` overrides applied.

    Raises
    ------
    CampaignError
        Every mistake in the file, in the overrides and in the designs it names.
    """
    path = find_campaign(path)
    document = with_overrides(document_of(path), overrides)
    ground = ground_of(document, path.parent)
    written, mistakes = _written(document, ground)
    designs, wrong = designs_of(document, path.parent)
    mistakes += [*wrong, *ground.mistakes]
    sites = ground.plant.sites if ground.plant else ()
    faults = read_faults(document, sites, path.parent)
    table, table_files, wrong_table = read_case_table(
        document, path.parent, ground.plant.parameters if ground.plant else ()
    )
    faults.files |= table_files
    mistakes += [*faults.mistakes, *(wrong_table if ground.plant else [])]
    if ground.benchmark is not None and ground.plant is not None:
        members = ground.chosen.members if ground.chosen else {}
        mistakes += unknown_names(document, ground.benchmark, ground.plant, members)
        if written is not None and not mistakes:
            mistakes += inconsistencies(document, written, faults.lists, ground.benchmark, ground.plant)
    if written is not None:
        mistakes += tuned_on_these_flights(written, designs)
    mistakes += [
        document.mistake((), f"the file {name} beside the campaign has a name that folders of results need; rename it")
        for name in ground.files | faults.files
        if Path(name).parts[0] in RESERVED
    ]
    refuse(mistakes)
    assert written is not None
    return _meaning(document, path, written, faults, designs, ground, table)


def _written(document: Document, ground: Ground) -> tuple[CampaignFile | None, list[Mistake]]:
    """The campaign as its model reads it; without a benchmark the choices of all registered ones are allowed."""
    model = campaign_file(tuple(ground.benchmark.choices) if ground.benchmark else _any_choices())
    try:
        return model.model_validate_json(json.dumps(document.data), strict=True), []
    except ValidationError as error:
        return None, mistakes_of(error, document, model=model)


def _any_choices() -> tuple[str, ...]:
    """Choices of all registered benchmarks; a broken package has none."""
    found: dict[str, None] = {}
    for name in kinds.known("benchmark"):
        try:
            found |= dict.fromkeys(kinds.load("benchmark", name).choices)
        except FddbenchError:
            continue
    return tuple(key for key in found if key not in CampaignFile.model_fields)


def _meaning(
    document: Document,
    path: Path,
    written: CampaignFile,
    faults: ReadFaults,
    designs: tuple[Design, ...],
    ground: Ground,
    table: CaseTable,
) -> Campaign:
    assert ground.benchmark is not None
    assert ground.chosen is not None
    assert ground.plant is not None
    scenarios = [Scenario(entry=entry, faults=faults.lists[n]) for n, entry in enumerate(written.scenarios)]
    beside = ground.files | faults.files
    return Campaign(
        path=path,
        **{key: getattr(written, key) for key in _AS_WRITTEN},
        bench=ground.benchmark,
        plant=ground.plant,
        choices=ground.chosen.names,
        chosen=ground.chosen.members,
        scenarios=tuple(scenarios),
        designs=designs,
        reconfigure=written.reconfigure or "",
        symbols=written.symbols,
        reconfigure_where=document.where(("reconfigure",)),
        text=canonical_text(document.data),
        table=table,
        beside=beside,
        sha256=fingerprint(_content(written, faults.lists, designs, ground.chosen.names, beside)),
    )


def _content(
    written: CampaignFile,
    faults: Faults,
    designs: Sequence[Design],
    choices: Mapping[str, str],
    beside: Mapping[str, bytes],
) -> dict[str, Any]:
    """Everything that decides rows, as plain data."""
    content: dict[str, Any] = written.model_dump(
        mode="json", exclude={"about", "scenarios", "report", "requirements", "symbols"}
    ) | dict(choices)
    content["scenarios"] = [
        entry.model_dump(mode="json")
        | {"faults": [fault.model_dump(mode="json", by_alias=True) for fault in faults[number]]}
        for number, entry in enumerate(written.scenarios)
    ]
    content["designs"] = {design.base: design.sha256 for design in designs}
    # a campaign means what it meant before there were these keys
    if written.reconfigure is None:
        del content["reconfigure"]
    if written.keep == "all":
        del content["keep"], content["kept_runs"]
    drawn = written.dispersions.monte_carlo
    if drawn is not None and drawn.plain:
        for key in ("sampling", "table", "correlation"):
            del content["dispersions"]["monte_carlo"][key]
    if beside:
        content["files"] = {name: sha256(text).hexdigest() for name, text in sorted(beside.items())}
    return content


_AS_WRITTEN = (
    "name",
    "about",
    "benchmark",
    "purpose",
    "seed",
    "sample_s",
    "substeps",
    "duration_s",
    "dispersions",
    "requirements",
    "keep",
    "kept_runs",
)
