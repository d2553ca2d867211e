"""Tuned detectors: a file with the kind, the numbers, where they come from and what they were tuned on."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from fddbench import kinds
from fddbench.campaign.reading.canonical import text_sha256
from fddbench.campaign.reading.document import Document, refuse
from fddbench.campaign.reading.yaml_nodes import read_yaml
from fddbench.campaign.rules.messages import mistakes_of
from fddbench.campaign.rules.wording import shown
from fddbench.designs.design_file import DesignFile, Limits, TunedOn
from fddbench.errors import DesignError, FddbenchError, Mistake
from fddbench.interfaces import Bus, Detector
from fddbench.kinds import Kind
from fddbench.plugin_files import code_in, noticed_reads

__all__ = ["Design", "SweptGain", "read_design"]


@dataclass(frozen=True)
class SweptGain:
    """Which gain of a design a campaign has changed, and its value, or the factor on what the design says."""

    key: str
    value: float
    factor: bool = False

    @property
    def column(self) -> str:
        """Column of the rows that holds the value, ``gain_threshold_deg_s`` or ``factor_thresholds``."""
        return f"{'factor' if self.factor else 'gain'}_{self.key}"

    def applied(self, written: Any) -> Any:
        """What a file would write instead of what it writes; a factor acts on every number of a list."""
        if not self.factor:
            return _plain(self.value)
        return [self.applied(each) for each in written] if isinstance(written, list) else _plain(self.value * written)


def _plain(value: float) -> float | int:
    """A number as a file writes it: a kind that wants whole numbers takes 3, not 3.0."""
    return int(value) if float(value).is_integer() else value


@dataclass(frozen=True, kw_only=True)
class Design:
    """A tuned detector.

    Attributes
    ----------
    name : str
        As campaigns and result columns call it: the file's name, of a variant ``DESIGN.KEY.1``.
    kind : Kind
        The class of the detector, registered or in a file beside the design.
    gains : BaseModel
        Its numbers.
    about, source : str
        What it is, and where its numbers come from.
    tuned_on : tuple of TunedOn
        Flights the numbers were chosen on.
    text, sha256 : str
        The file, and its fingerprint (with that of the files it stands on).
    files : mapping of str to bytes
        Files beside the design that the detector stands on.
    path : Path
        Where it was found.
    where : str
        Place in the campaign that names it.
    gamma : float or None
        What its recipe guarantees in the worst case [-].
    members : mapping of str to Kind
        Members of other families that its numbers name, by the key that names them.
    written : mapping
        Gains as the file writes them.
    swept : SweptGain or None
        Of a variant, what differs from the file.
    every : int
        It steps at every so manieth sample.
    code : str
        Folder of C beside it that flies in its place; "" for none.
    symbols : str, list or None
        Library of operations that it must keep to.
    limits : Limits
        What a step may take where the detector is ordinary Python.
    """

    name: str
    kind: Kind
    gains: BaseModel
    about: str
    source: str
    tuned_on: tuple[TunedOn, ...]
    text: str = field(repr=False)
    sha256: str
    files: Mapping[str, bytes] = field(repr=False)
    path: Path
    where: str
    gamma: float | None = None
    members: Mapping[str, Kind] = field(default_factory=dict)
    written: Mapping[str, Any] = field(default_factory=dict, repr=False)
    swept: SweptGain | None = None
    every: int = 1
    code: str = ""
    symbols: Any = None
    limits: Limits = field(default_factory=Limits)

    @property
    def base(self) -> str:
        """Name of the file's design, also of a variant."""
        return self.path.stem

    def sample_s(self, bus: Bus) -> float:
        """Time between two of its steps [s]."""
        return bus.sample_s if self.every == 1 else round(self.every * bus.sample_s, 12)

    def build(self, bus: Bus) -> Detector:
        """Detector for a bus, as it steps on its own clock.

        Raises
        ------
        DesignError
            Its numbers do not make one, or it reads a file that would not travel with the results.
        """
        with noticed_reads(self.path.parent) as read:
            named = {key: kind.member for key, kind in self.members.items()}
            own = replace(bus, sample_s=self.sample_s(bus))
            detector: Detector = self.kind.member.from_design(self.gains, own, **named)
        stray = sorted(set(read) - set(self.files))
        if stray and self.files:
            raise DesignError(
                f"it reads {', '.join(stray)} beside it, which would not travel with the results; declare it in its Python "
                f"file: FILES = ({', '.join(map(repr, stray))},)"
            )
        return detector


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
    written, kind = None, None
    mistakes: list[Mistake] = []
    try:
        written = DesignFile.model_validate_json(json.dumps(document.data), strict=True)
    except ValidationError as error:
        mistakes += mistakes_of(error, document, model=DesignFile)
    try:
        name = document.get("kind")
        kind = kinds.find("detector", name, beside=path.parent) if isinstance(name, str) else None
    except FddbenchError as error:
        mistakes.append(document.mistake(("kind",), str(error)))
    gains = _gains(document, kind, mistakes)
    members = _members(document, kind, gains, path.parent, mistakes)
    code = _code(document, written, path.parent, mistakes)
    refuse(mistakes)
    assert written is not None
    assert kind is not None
    assert gains is not None
    text = path.read_text(encoding="utf-8-sig")
    files = {name: text for each in (kind, *members.values()) for name, text in each.files.items()} | code
    stands_on = "".join(f"{each}:{text_sha256(content.hex())}" for each, content in sorted(files.items()))
    return Design(
        name=path.stem,
        kind=kind,
        gains=gains,
        about=written.about,
        source=written.source,
        tuned_on=written.tuned_on or (),
        text=text,
        sha256=text_sha256(text + stands_on),
        files=files,
        path=path,
        where=where,
        gamma=written.gamma,
        members=members,
        written=document.mapping("gains"),
        every=written.every,
        code=written.code,
        symbols=written.symbols,
        limits=written.limits,
    )


def _gains(document: Document, kind: Kind | None, mistakes: list[Mistake]) -> BaseModel | None:
    """Numbers of a design, None with a mistake when they are not right."""
    if kind is None:
        return None
    model = kind.member.Gains
    if not (isinstance(model, type) and issubclass(model, BaseModel)):
        mistakes.append(document.mistake(("kind",), f"{kind.name} needs a class Gains, a pydantic BaseModel"))
        return None
    try:
        found: BaseModel | None = None
        if isinstance(document.get("gains"), dict):
            found = model.model_validate_json(json.dumps(document.get("gains")), strict=True)
    except ValidationError as error:
        mistakes += mistakes_of(error, document, model=model, at=("gains",))
    return found


def _members(
    document: Document, kind: Kind | None, gains: BaseModel | None, folder: Path, mistakes: list[Mistake]
) -> dict[str, Kind]:
    """Members of other families that gains name: a model says which keys do, ``MEMBERS = {key: family}``."""
    if kind is None or gains is None:
        return {}
    found = {}
    for key, family in getattr(kind.member.Gains, "MEMBERS", {}).items():
        name = getattr(gains, key)
        if name is None:
            continue
        try:
            found[key] = kinds.find(family, name, beside=folder)
        except FddbenchError as error:
            mistakes.append(document.mistake(("gains", key), str(error)))
    return found


def _code(document: Document, written: DesignFile | None, folder: Path, mistakes: list[Mistake]) -> dict[str, bytes]:
    """Files of C that fly in place of the kind's own step."""
    if written is None or not written.code:
        return {}
    try:
        return code_in(written.code, folder)
    except FddbenchError as error:
        mistakes.append(document.mistake(("code",), str(error)))
        return {}
