"""Tuned detectors: a file with the kind, the numbers, where they come from and what they were tuned on."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from fddbench import gallery
from fddbench.campaign.canonical import text_sha256
from fddbench.campaign.design_file import DesignFile, TunedOn
from fddbench.campaign.document import refuse
from fddbench.campaign.fault_entries import load_kind
from fddbench.campaign.messages import mistakes_of
from fddbench.campaign.plugins import Plugin, is_plugin, load_plugin
from fddbench.campaign.wording import shown
from fddbench.campaign.yaml_nodes import read_yaml
from fddbench.errors import FddbenchError, did_you_mean
from fddbench.interfaces import Bus, Detector

__all__ = ["Design", "find_design", "known_designs", "read_design"]


@dataclass(frozen=True, kw_only=True)
class Design:
    """A tuned detector.

    Attributes
    ----------
    name : str
        As campaigns and result columns call it; the file's name.
    kind : str
        Registered detector, or plug-in.
    gains : BaseModel
        Its numbers.
    about, source : str
        What it is, and where its numbers come from.
    tuned_on : tuple of TunedOn
        Flights the numbers were chosen on.
    text, sha256 : str
        The file, and its fingerprint (with that of the plug-in, if any).
    plugin : Plugin or None
        The user's Python file.
    path : Path
        Where it was found.
    where : str
        Place in the campaign that names it.
    gamma : float or None
        What its recipe guarantees in the worst case [-].
    """

    name: str
    kind: str
    gains: BaseModel
    about: str
    source: str
    tuned_on: tuple[TunedOn, ...]
    text: str = field(repr=False)
    sha256: str
    plugin: Plugin | None
    path: Path
    where: str
    gamma: float | None = None

    def build(self, bus: Bus) -> Detector:
        """Detector for a bus; raises DesignError when its numbers do not make one."""
        kind = load_plugin(self.kind, self.path.parent)[0] if self.plugin else load_kind("detector", self.kind)
        detector: Detector = kind.from_design(self.gains, bus)
        return detector


def _folders(campaign_folder: Path) -> list[Path]:
    beside = [campaign_folder / "detectors", campaign_folder / ".." / "detectors"]
    try:
        # one's own detectors on a shipped campaign lie where one works
        here = [Path("detectors")] if campaign_folder.resolve() == gallery.folder("campaigns").resolve() else []
        return [*here, *beside, gallery.folder("detectors")]
    except FddbenchError:
        return beside


def known_designs(campaign_folder: Path) -> list[str]:
    """Names of all designs that a campaign in a folder can name, in alphabetical order."""
    return sorted({path.stem for folder in _folders(campaign_folder) for path in folder.glob("*.yaml")})


def find_design(name: str, campaign_folder: Path) -> Path:
    """File of a design: in ``detectors/`` beside the campaign, then beside its folder, then as shipped.

    Raises
    ------
    FddbenchError
        There is none; the message lists the known ones.
    """
    for folder in _folders(campaign_folder):
        path = folder / f"{name}.yaml"
        if path.is_file() and path.resolve().is_relative_to(folder.resolve()):
            return path
    known = known_designs(campaign_folder)
    parts = [
        f"no design is called {name!r}.",
        did_you_mean(name, known),
        f"Known: {', '.join(known) or 'none'}.",
        f"Designs are files: put yours at {_folders(campaign_folder)[0] / name}.yaml",
    ]
    raise FddbenchError(" ".join(filter(None, parts)))


def read_design(path: Path, *, where: str = "") -> Design:
    """Design of a file.

    Raises
    ------
    CampaignError
        Every mistake in it.
    """
    document = read_yaml(path)
    if not isinstance(document.data, dict):
        message = f"a design is a mapping of keys (kind, source, tuned_on, gains), got {shown(document.data)}"
        refuse([document.mistake((), message)])
    written, kind, plugin, mistakes = None, None, None, []
    try:
        written = DesignFile.model_validate_json(json.dumps(document.data), strict=True)
    except ValidationError as error:
        mistakes += mistakes_of(error, document, model=DesignFile)
    try:
        kind, plugin = _kind(document.get("kind"), path.parent)
    except FddbenchError as error:
        mistakes.append(document.mistake(("kind",), str(error)))
    gains: BaseModel | None = None
    if kind is not None and not (
        isinstance(model := getattr(kind, "Gains", None), type) and issubclass(model, BaseModel)
    ):
        mistakes.append(
            document.mistake(("kind",), f"{document.get('kind')} needs a class Gains, a pydantic BaseModel")
        )
    elif kind is not None and isinstance(document.get("gains"), dict):
        try:
            gains = kind.Gains.model_validate_json(json.dumps(document.get("gains")), strict=True)
        except ValidationError as error:
            mistakes += mistakes_of(error, document, model=kind.Gains, at=("gains",))
    refuse(mistakes)
    assert written is not None
    assert gains is not None
    text = path.read_text(encoding="utf-8-sig")
    return Design(
        name=path.stem,
        kind=written.kind,
        gains=gains,
        about=written.about,
        source=written.source,
        tuned_on=written.tuned_on or (),
        text=text,
        sha256=text_sha256(text + (plugin.sha256 if plugin else "")),
        plugin=plugin,
        path=path,
        where=where,
        gamma=_gamma(written.recipe),
    )


def _gamma(recipe: Mapping[str, Any] | None) -> float | None:
    found = (recipe or {}).get("found")
    gamma = found.get("gamma") if isinstance(found, dict) else None
    return float(gamma) if isinstance(gamma, float | int) else None


def _kind(name: Any, folder: Path) -> tuple[Any, Plugin | None]:
    if not isinstance(name, str):
        return None, None
    kind, plugin = load_plugin(name, folder) if is_plugin(name) else (load_kind("detector", name), None)
    missing = [part for part in ("Gains", "from_design") if part not in dir(kind)]
    if missing:
        raise FddbenchError(f"{name!r} is no detector: its class has no {' and no '.join(missing)}")
    return kind, plugin
