"""``--set path=value``: changes a campaign without editing its file, by the same strict rules."""

from collections.abc import Sequence
from typing import Any

from fddbench.campaign.reading.document import Address, Document, refuse
from fddbench.campaign.reading.yaml_nodes import parse
from fddbench.errors import CampaignError, FddbenchError, Mistake, did_you_mean

__all__ = ["ALONE", "with_overrides"]

ALONE = ("requirements=[]", "keep=all")
"""Beside an override of the detectors: requirements are of the campaign's own, and all rows are read."""


def with_overrides(document: Document, overrides: Sequence[str]) -> Document:
    """Document with ``path=value`` texts applied in order; the places of what they bring name the override.

    Parameters
    ----------
    overrides : sequence of str
        Dotted paths; an item of a list by its number from 0 or, where it has one, its name:
        ``scenarios.jam_a.faults.0.onset_s=4``. The value is YAML.

    Raises
    ------
    CampaignError
        Every override that leads nowhere or is not YAML.
    """
    mistakes: list[Mistake] = []
    for override in overrides:
        try:
            document = _with_override(document, override)
        except CampaignError as error:
            mistakes += error.mistakes
        except _NowhereError as error:
            mistakes.append(Mistake(f"--set {override}", str(error)))
    refuse(mistakes)
    return document


class _NowhereError(FddbenchError):
    """A path leads to nothing that could be set."""


def _with_override(document: Document, override: str) -> Document:
    origin = f"--set {override}"
    path, equals, text = override.partition("=")
    if not equals or not path:
        raise _NowhereError("need path=value, e.g. dispersions.monte_carlo.runs=5")
    value = parse(text, name="value", place=origin)
    data, address = _placed(document.data, path, (), value.data)
    inside = len(address)
    keys = {at: place for at, place in document.keys.items() if at[:inside] != address}
    values = {at: place for at, place in document.values.items() if at[:inside] != address}
    made = [address[:n] for n in range(1, inside + 1) if n == inside or address[:n] not in document.values]
    brought = dict.fromkeys(made, origin)
    return Document(name=document.name, data=data, keys=keys | brought, values=values | brought)


def _placed(block: Any, path: str, address: Address, value: Any) -> tuple[Any, Address]:
    """Copy of a block with the value at a path, and the address of the path; blocks on the way are made."""
    if not path:
        return value, address
    if isinstance(block, list):
        position, rest = _item(block, path)
        inner, found = _placed(block[position], rest, (*address, position), value)
        return [*block[:position], inner, *block[position + 1 :]], found
    if block is not None and not isinstance(block, dict):
        raise _NowhereError(f"{'.'.join(map(str, address))} is {block!r} and has no {path!r} inside")
    key, _, rest = path.partition(".")
    if not key:
        raise _NowhereError("the path has an empty part; write e.g. dispersions.monte_carlo.runs=5")
    block = block or {}
    inner, found = _placed(block.get(key), rest, (*address, key), value)
    return {**block, key: inner}, found


def _item(items: list[Any], path: str) -> tuple[int, str]:
    """Position of the item that a path starts with, and the rest of the path; names may have dots."""
    names = {item["name"]: n for n, item in enumerate(items) if isinstance(item, dict) and "name" in item}
    for name in sorted(map(str, names), key=len, reverse=True):
        if path == name or path.startswith(f"{name}."):
            return names[name], path[len(name) + 1 :]
    part, _, rest = path.partition(".")
    if part.isascii() and part.isdigit() and int(part[:9]) < len(items):
        return int(part), rest
    known = f"by name ({', '.join(map(str, names))}) or " if names else ""
    numbers = f"by number (0 to {len(items) - 1})" if items else "not at all: it is empty"
    hint = " ".join(filter(None, [did_you_mean(part, map(str, names)), f"Items are reached {known}{numbers}"]))
    raise _NowhereError(f"no item {part!r} in the list. {hint}")
