"""What holds between the keys of a fault, as JSON Schema says it; pydantic's validators say the same with better words."""

from itertools import combinations
from typing import Any

__all__ = ["KeyRule", "at_most_one", "exactly_one", "positive", "where"]

KeyRule = dict[str, Any]
"""A fragment of JSON Schema that the whole entry of a campaign must meet."""


def exactly_one(*keys: str) -> KeyRule:
    """One of these keys is given, and no other of them."""
    return {"oneOf": [{"required": [key]} for key in keys]}


def at_most_one(*keys: str) -> KeyRule:
    """No two of these keys are given."""
    return {"not": {"anyOf": [{"required": list(pair)} for pair in combinations(keys, 2)]}}


def positive(*keys: str) -> KeyRule:
    """Plain numbers of these keys lie above zero."""
    return {"properties": {key: {"exclusiveMinimum": 0} for key in keys}}


def where(key: str, value: Any, then: KeyRule, otherwise: KeyRule | None = None) -> KeyRule:
    """What must be met where a key has a value, and where it has another or none."""
    found: KeyRule = {"if": {"properties": {key: {"const": value}}, "required": [key]}, "then": then}
    return found if otherwise is None else {**found, "else": otherwise}
