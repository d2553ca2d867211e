"""Pieces that all schemas are made of."""

from collections.abc import Iterable, Mapping
from typing import Any

__all__ = ["DIALECT", "FILE_KIND", "Schema", "embedded", "one_of_names", "reference", "when"]

Schema = dict[str, Any]

DIALECT = "https://json-schema.org/draft/2020-12/schema"
FILE_KIND = r"^[A-Za-z_][A-Za-z0-9_]*\.py:[A-Za-z_][A-Za-z0-9_]*$"
"""A class in a file beside the campaign, ``mine.py:Mine``."""


def reference(name: str) -> Schema:
    """Reference to a definition of the same schema."""
    return {"$ref": f"#/$defs/{name}"}


def when(condition: Schema | None, then: Schema) -> Schema:
    """What must be met where a condition is; always where there is none."""
    return {"if": condition, "then": then} if condition else then


def one_of_names(names: Iterable[str], about: Mapping[str, str] | None = None, *patterns: str) -> Schema:
    """Known names, each with what it is, which an editor offers; or others of a pattern."""
    texts = about or {}
    known = [{"const": name, **({"description": texts[name]} if texts.get(name) else {})} for name in names]
    return {"anyOf": [*known, *({"type": "string", "pattern": pattern} for pattern in patterns)]}


def embedded(schema: Schema, prefix: str, definitions: Schema) -> Schema:
    """Schema whose own definitions have moved to those of the whole, their names behind a prefix."""
    own = schema.pop("$defs", {})
    for name, definition in own.items():
        definitions[f"{prefix}{name}"] = _renamed(definition, prefix)
    moved: Schema = _renamed(schema, prefix)
    return moved


def _renamed(value: Any, prefix: str) -> Any:
    """Same content with the prefix in every reference."""
    if isinstance(value, dict):
        return {
            key: inner.replace("#/$defs/", f"#/$defs/{prefix}") if key == "$ref" else _renamed(inner, prefix)
            for key, inner in value.items()
        }
    return [_renamed(inner, prefix) for inner in value] if isinstance(value, list) else value
