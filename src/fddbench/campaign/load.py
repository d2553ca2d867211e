"""Reads a campaign file: every mistake at once with its place, or what the campaign means."""

import json
import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from fddbench import gallery, kinds
from fddbench.campaign.meaning import Campaign, Scenario
from fddbench.campaign.reading.canonical import canonical_text, fingerprint
from fddbench.campaign.reading.document import Address, Document, refuse
from fddbench.campaign.reading.overrides import with_overrides
from fddbench.campaign.reading.yaml_nodes import read_yaml
from fddbench.campaign.rules.consistency import Faults, inconsistencies
from fddbench.campaign.rules.fault_entries import ReadFaults, read_faults
from fddbench.campaign.rules.messages import mistakes_of
from fddbench.campaign.rules.model import NAME_PATTERN, CampaignFile, campaign_file
from fddbench.campaign.rules.references import Chosen, choose, unknown_names
from fddbench.campaign.rules.swept import Sweep, SweptDesign
from fddbench.campaign.rules.wording import shown
from fddbench.designs.design import Design, read_design
from fddbench.designs.finding import find_design
from fddbench.designs.sweeps import variants
from fddbench.errors import CampaignError, FddbenchError, Mistake, did_you_mean, reason_of
from fddbench.interfaces import Benchmark, Plant
from fddbench.results.folder import RESERVED

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
    ground = _ground(document, path.parent)
    written, mistakes = _written(document, ground)
    designs, wrong = _designs(document, path.parent)
    mistakes += [*wrong, *ground.mistakes]
    sites = ground.plant.sites if ground.plant else ()
    faults = read_faults(document, sites, path.parent)
    mistakes += faults.mistakes
    if ground.benchmark is not None and ground.plant is not None:
        members = ground.chosen.members if ground.chosen else {}
        mistakes += unknown_names(document, ground.benchmark, ground.plant, members)
        if written is not None and not mistakes:
            mistakes += inconsistencies(document, written, faults.lists, ground.benchmark, ground.plant)
    if written is not None:
        mistakes += _tuned_on_these_flights(written, designs)
    mistakes += [
        document.mistake((), f"the file {name} beside the campaign has a name that folders of results need; rename it")
        for name in ground.files | faults.files
        if Path(name).parts[0] in RESERVED
    ]
    refuse(mistakes)
    assert written is not None
    return _meaning(document, path, written, faults, designs, ground)


@dataclass(kw_only=True)
class _Ground:
    """What a campaign stands on: its benchmark, what it has chosen there, what flies, and what is wrong with these."""

    benchmark: Benchmark | None = None
    chosen: Chosen | None = None
    plant: Plant | None = None
    files: dict[str, bytes] = field(default_factory=dict)
    mistakes: list[Mistake] = field(default_factory=list)


def _ground(document: Document, folder: Path) -> _Ground:
    """Benchmark, choices and plant; foreign code may raise anything, which is told where the campaign names it."""
    found, name = _Ground(), document.get("benchmark")
    if not isinstance(name, str):
        return found
    try:
        kind = kinds.find("benchmark", name, beside=folder)
        found.files |= kind.files
        benchmark = kind.member()
        campaign_file(tuple(benchmark.choices))
        found.benchmark = benchmark
        found.chosen, wrong = choose(document, benchmark, folder)
        found.mistakes += wrong
        if found.chosen is not None:
            found.files |= found.chosen.files
            found.plant = benchmark.plant(found.chosen.members)
            _require_sound(found.plant)
    except FddbenchError as error:
        found.mistakes.append(document.mistake(("benchmark",), str(error)))
    except (Exception, SystemExit) as error:
        message = f"the benchmark {name!r} cannot be used: {reason_of(error)}"
        found.mistakes.append(document.mistake(("benchmark",), message))
    if found.mistakes:
        found.plant = None
    return found


def _require_sound(plant: Plant) -> None:
    """Refuse a plant that cannot be asked, or whose sites have a unit that nobody knows.

    Raises
    ------
    FddbenchError
        With what is missing.
    """
    missing = [name for name in ("sites", "parameters", "refused_parameters", "manoeuvres") if name not in dir(plant)]
    if missing:
        raise FddbenchError(f"the plant of this benchmark has no {' and no '.join(missing)}")
    names = [site.name for site in plant.sites]
    twice = {name for name in names if names.count(name) > 1}
    if twice:
        raise FddbenchError(f"the fault sites {sorted(twice)} are there twice; give each its own name")
    for site in plant.sites:
        _ = site.unit


def _written(document: Document, ground: _Ground) -> tuple[CampaignFile | None, list[Mistake]]:
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


def _designs(document: Document, folder: Path) -> tuple[tuple[Design, ...], list[Mistake]]:
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


def _tuned_on_these_flights(written: CampaignFile, designs: Sequence[Design]) -> list[Mistake]:
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


def _meaning(
    document: Document,
    path: Path,
    written: CampaignFile,
    faults: ReadFaults,
    designs: tuple[Design, ...],
    ground: _Ground,
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
        reconfigure_where=document.where(("reconfigure",)),
        text=canonical_text(document.data),
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
    content: dict[str, Any] = written.model_dump(mode="json", exclude={"about", "scenarios", "report"}) | dict(choices)
    content["scenarios"] = [
        entry.model_dump(mode="json")
        | {"faults": [fault.model_dump(mode="json", by_alias=True) for fault in faults[number]]}
        for number, entry in enumerate(written.scenarios)
    ]
    content["designs"] = {design.base: design.sha256 for design in designs}
    if written.reconfigure is None:
        del content["reconfigure"]  # a campaign means what it meant before there was this key
    if beside:
        content["files"] = {name: sha256(text).hexdigest() for name, text in sorted(beside.items())}
    return content


_AS_WRITTEN = ("name", "about", "benchmark", "purpose", "seed", "sample_s", "substeps", "duration_s", "dispersions")
