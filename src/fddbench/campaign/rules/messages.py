"""Pydantic's findings told to an engineer: the place, what was received with which unit, what is allowed."""

import typing
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from fddbench.campaign.reading.document import Address, Document
from fddbench.campaign.rules.model import extra_hint
from fddbench.campaign.rules.wording import Finding, say
from fddbench.errors import Mistake, did_you_mean
from fddbench.faults.varied import Number, Varied

__all__ = ["allowed_keys", "mistakes_of"]


_TAGS = ("name", "matrices", "swept", "values", "sweep")
"""Names that models give the members of their unions."""


def allowed_keys(model: type[BaseModel], address: Address) -> tuple[str, ...]:
    """Keys of the block at an address within a model; empty where it is no block."""
    found, named = _model_in(model), False
    for part in address:
        if found is None or isinstance(part, int):
            continue
        if named:  # a name of the file's own, in a mapping of names to blocks
            named = False
            continue
        entry = _keyed(found).get(part)
        named = entry is not None and typing.get_origin(entry.annotation) is dict
        found = _model_of(entry) if entry else _model_in(extra_hint(found))
    return tuple(_keyed(found)) if found else ()


def _keyed(model: type[BaseModel]) -> dict[str, FieldInfo]:
    """Fields of a model by the keys that a file writes."""
    return {field.alias or name: field for name, field in model.model_fields.items()}


def _model_of(entry: FieldInfo) -> type[BaseModel] | None:
    """Model of the block that a field may hold; numbers of a fault may be drawn or swept."""
    if any(isinstance(part, Number) for part in entry.metadata):
        return Varied
    return _model_in(entry.annotation)


def _model_in(annotation: Any) -> type[BaseModel] | None:
    if isinstance(annotation, Number):
        return Varied
    if isinstance(annotation, type) and not typing.get_args(annotation) and issubclass(annotation, BaseModel):
        return annotation
    return next(filter(None, map(_model_in, typing.get_args(annotation))), None)


def mistakes_of(
    error: ValidationError, document: Document, *, model: type[BaseModel], at: Address = ()
) -> list[Mistake]:
    """Every finding of a validation of the block at an address, as a mistake at its place."""
    found = []
    for detail in error.errors(include_url=False):
        kind = detail["type"]
        local = _written(document, at, tuple(part for part in detail["loc"] if part != "[key]"), kind)
        if kind == "too_short" and len(detail["input"]) >= detail.get("ctx", {})["min_length"]:
            continue  # pydantic counts the right items only; the wrong ones are told by themselves
        if kind == "extra_forbidden":
            message = _unknown_key(local, allowed_keys(model, local[:-1]))
            found.append(document.mistake((*at, *local), message, key=True))
        elif kind == "missing":
            found.append(document.mistake((*at, *local[:-1]), _missing_key(local, model)))
        else:
            finding = Finding(
                kind=kind,
                received=detail["input"],
                context=detail.get("ctx", {}),
                text=detail["msg"],
                address=_blamed(document, (*at, *local), detail["msg"]),
                allowed=allowed_keys(model, local),
            )
            found.append(document.mistake(finding.address, say(finding)))
    return found


def _written(document: Document, at: Address, loc: Address, kind: str) -> Address:
    """Pydantic's way to a value without the names that it gives the members of a union, which no file writes."""
    local: Address = ()
    for n, part in enumerate(loc):
        named = isinstance(part, int) or part in document.mapping(*at, *local)
        if named or (kind == "missing" and n == len(loc) - 1) or part not in _TAGS:
            local = (*local, part)
    return local


def _unknown_key(local: Address, allowed: tuple[str, ...]) -> str:
    key = str(local[-1])
    parts = [f"unknown key {key!r}.", did_you_mean(key, allowed), f"Allowed: {', '.join(allowed)}"]
    return " ".join(filter(None, parts))


def _missing_key(local: Address, model: type[BaseModel]) -> str:
    block = f" in {local[-2]}" if len(local) > 1 and isinstance(local[-2], str) else ""
    return f"key {str(local[-1])!r} is missing{block}. Keys here: {', '.join(allowed_keys(model, local[:-1]))}"


def _blamed(document: Document, address: Address, text: str) -> Address:
    """Address of the key that a message of a whole block starts with, else of the block."""
    first = text.removeprefix("Value error, ").split(" ", maxsplit=1)[0]
    return (*address, first) if first in document.mapping(*address) else address
