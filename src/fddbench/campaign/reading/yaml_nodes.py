"""YAML read strictly, from its events: no aliases, tags or merged keys, no duplicate keys, no document without end."""

import re
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import yaml

from fddbench.campaign.reading.document import Address, Document, refuse
from fddbench.campaign.reading.scalars import Scalar, resolve
from fddbench.errors import CampaignError, Mistake

__all__ = ["MAX_BYTES", "parse", "read_yaml"]

MAX_BYTES = 4_000_000
"""Size of the largest file that is read [bytes]."""

_MAX_DEPTH = 32
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_CONTROL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")


def read_yaml(path: Path) -> Document:
    """Document of a file.

    Raises
    ------
    CampaignError
        The file cannot be read, is too large, is not text or is not plain YAML; every mistake that could be found.
    """
    name = str(path)
    try:
        if (
            path.exists() and not path.is_file() and not path.is_dir()
        ):  # a pipe without a writer keeps its readers waiting
            raise CampaignError((Mistake(name, "is a pipe or a device; give a file"),))
        with path.open("rb") as file:
            raw = file.read(MAX_BYTES + 1)
    except OSError as error:
        raise CampaignError((Mistake(name, f"cannot be read: {error.strerror or error}"),)) from None
    if len(raw) > MAX_BYTES:
        raise CampaignError((Mistake(name, f"larger than {MAX_BYTES / 1e6:g} MB; a campaign is a page of text"),))
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        place = _place_in(name, raw[: error.start].decode("utf-8", "replace"))
        message = f"byte 0x{raw[error.start]:02x} is not UTF-8 text; is this a binary file? Save it as UTF-8"
        raise CampaignError((Mistake(place, message),)) from None
    return parse(text, name=name)


def parse(text: str, *, name: str, place: str = "") -> Document:
    """Document of a YAML text; with `place`, everything in it is said to stand there."""
    control = _CONTROL.search(text)
    if control:
        message = f"control character U+{ord(control[0]):04X}; a campaign is plain text. Is this a binary file?"
        raise CampaignError((Mistake(place or _place_in(name, text[: control.start()]), message),))

    def where(mark: Any) -> str:
        return place or f"{name}:{mark.line + 1}:{mark.column + 1}"

    reader = _Reader(text, name, where)
    data = reader.document()
    refuse(reader.mistakes)
    return Document(name=name, data=data, keys=reader.keys, values=reader.values)


def _place_in(name: str, before: str) -> str:
    return f"{name}:{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"


class _Reader:
    """Builds plain data from YAML events and notes the place of each key and value."""

    def __init__(self, text: str, name: str, where: Callable[[Any], str]) -> None:
        self.text, self.name, self.where = text, name, where
        self.mistakes: list[Mistake] = []
        self.keys: dict[Address, str] = {}
        self.values: dict[Address, str] = {}
        self.shared = False
        self.events = self._events()

    def document(self) -> Any:
        """Content of the only document; None when there is none."""
        data: Any = None
        n_documents = 0
        for event in self.events:
            if isinstance(event, yaml.DocumentStartEvent):
                n_documents += 1
                if n_documents > 1:
                    self._refuse(event, "a second document starts here; write one campaign per file and remove the ---")
                    break
                data = self._value(next(self.events), ())
        return data

    def _events(self) -> Iterator[Any]:
        try:
            yield from self._shallow(self.text)
        except yaml.MarkedYAMLError as error:
            self._deep_before(error)
            refuse([*self.mistakes, self._syntax(error)])
        except (yaml.YAMLError, UnicodeError, ValueError) as error:
            refuse([*self.mistakes, Mistake(f"{self.name}:1:1", f"not valid YAML: {error}")])

    def _shallow(self, text: str) -> Iterator[Any]:
        """Events of a text as long as it is not nested too deeply, in keys as well as in values."""
        depth = -1  # the outermost block is level 0
        for event in yaml.parse(text, Loader=_LOADER):
            depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
            if depth > _MAX_DEPTH:
                self._refuse(event, f"nested deeper than {_MAX_DEPTH} levels; a campaign needs six")
                refuse(self.mistakes)
            yield event

    def _deep_before(self, error: yaml.MarkedYAMLError) -> None:
        """Refuse what is nested too deeply before an error.

        PyYAML reads ahead of its events and newer ones have a limit of their own, so it may complain of depth, or of what
        comes later, before our limit is seen; its words and its place would then depend on its version.
        """
        mark: Any = error.problem_mark or error.context_mark
        with suppress(yaml.YAMLError, UnicodeError, ValueError):
            for _ in self._shallow(self.text[: mark.index]):
                pass

    def _syntax(self, error: yaml.MarkedYAMLError) -> Mistake:
        mark: Any = error.problem_mark or error.context_mark
        lines = self.text.split("\n")
        line = lines[mark.line] if mark.line < len(lines) else ""
        if "\t" in line[: mark.column + 1]:
            return Mistake(self.where(mark), "not valid YAML: a tab; indent with spaces")
        context = f" {error.context}" if error.context else ""
        if error.context and error.context_mark:
            context += f" that starts at line {error.context_mark.line + 1}, column {error.context_mark.column + 1}"
        problem = f"not valid YAML: {error.problem}{context}; is a quote, a colon or a bracket missing?"
        return Mistake(self.where(mark), problem)

    def _refuse(self, event: Any, message: str) -> None:
        self.mistakes.append(Mistake(self.where(event.start_mark), message))

    def _value(self, event: Any, address: Address) -> Any:
        self.values[address] = self.where(event.start_mark)
        if isinstance(event, yaml.AliasEvent) or event.anchor is not None:
            if not self.shared:
                self._refuse(event, "anchors (&name) and aliases (*name) are not read; write the value out")
            self.shared = True
        if getattr(event, "tag", None) is not None:
            self._refuse(event, f"tags such as {event.tag} are not read; write the plain value")
        if isinstance(event, yaml.SequenceStartEvent):
            return self._list(address)
        if isinstance(event, yaml.MappingStartEvent):
            return self._mapping(address)
        return self._scalar(event) if isinstance(event, yaml.ScalarEvent) else None

    def _list(self, address: Address) -> list[Any]:
        items: list[Any] = []
        while not isinstance(event := next(self.events), yaml.SequenceEndEvent):
            items.append(self._value(event, (*address, len(items))))
        return items

    def _mapping(self, address: Address) -> dict[str, Any]:
        items: dict[str, Any] = {}
        while not isinstance(event := next(self.events), yaml.MappingEndEvent):
            key = self._key(event, address, items)
            value = self._value(next(self.events), (*address, key))
            items.setdefault(key, value)
        return items

    def _key(self, event: Any, address: Address, items: dict[str, Any]) -> str:
        block = self.values[address]
        value = self._value(event, address)
        self.values[address] = block
        if value == "<<":
            self._refuse(event, "merged keys (<<) are not read; write the keys out")
        elif not isinstance(value, str):
            self._refuse(event, f"a key must be a word, got {value!r}; put it in quotes if it is a name")
        elif value in items:
            self._refuse(event, f"key {value!r} stands twice in this block, first at {self.keys[(*address, value)]}")
        self.keys.setdefault((*address, str(value)), self.where(event.start_mark))
        return str(value)

    def _scalar(self, event: yaml.ScalarEvent) -> Scalar:
        text: str = event.value
        if _CONTROL.search(text):
            self._refuse(event, "control characters are not read; write plain text")
            return ""
        if not event.implicit[0]:
            return text
        try:
            return resolve(text)
        except ValueError as error:
            self._refuse(event, str(error))
            return 0.0
