"""A file as plain data that remembers where everything stood, so that a mistake can be pointed at."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from fddbench.errors import CampaignError, Mistake

__all__ = ["Address", "Document", "refuse"]

Address = tuple[str | int, ...]
"""Way to a value: ``("scenarios", 0, "faults", 1, "onset_s")``."""

_AT_MOST = 50
_PLACE = re.compile(r"(.*):(\d+):(\d+)")


@dataclass(frozen=True)
class Document:
    """Plain data and places.

    Attributes
    ----------
    name : str
        File name as the user gave it.
    data : mapping, list or scalar
        What the file says.
    keys, values : mapping of address to str
        Where each key and each value stands: ``file:line:column`` or the override that brought it.
    """

    name: str
    data: Any
    keys: dict[Address, str]
    values: dict[Address, str]

    def where(self, address: Address, *, key: bool = False) -> str:
        """Place of the value (or of the key) at an address, or of what holds it."""
        if key and address in self.keys:
            return self.keys[address]
        for n in range(len(address), -1, -1):
            if address[:n] in self.values:
                return self.values[address[:n]]
        return f"{self.name}:1:1"

    def mistake(self, address: Address, message: str, *, key: bool = False) -> Mistake:
        """Mistake at an address."""
        return Mistake(self.where(address, key=key), message)

    def get(self, *address: str | int) -> Any:
        """Value at an address, or None where the file has nothing."""
        value = self.data
        for part in address:
            if isinstance(value, dict):
                value = value.get(part)
            elif isinstance(value, list) and isinstance(part, int) and part < len(value):
                value = value[part]
            else:
                return None
        return value

    def mapping(self, *address: str | int) -> dict[str, Any]:
        """Block of keys at an address; empty where there is none."""
        value = self.get(*address)
        return value if isinstance(value, dict) else {}

    def items(self, *address: str | int) -> list[Any]:
        """List at an address; empty where there is none."""
        value = self.get(*address)
        return value if isinstance(value, list) else []


def refuse(mistakes: Iterable[Mistake]) -> None:
    """Raise all the mistakes at once in the order of the file, or do nothing when there are none."""
    ordered = sorted(dict.fromkeys(mistakes), key=_order)
    if not ordered:
        return
    if len(ordered) > _AT_MOST:
        rest = f"and {len(ordered) - _AT_MOST} more mistakes; mend these first"
        ordered = [*ordered[:_AT_MOST], Mistake(ordered[_AT_MOST].where, rest)]
    raise CampaignError(tuple(ordered))


def _order(mistake: Mistake) -> tuple[str, int, int]:
    place = _PLACE.fullmatch(mistake.where)
    return (place[1], int(place[2]), int(place[3])) if place else (mistake.where, 0, 0)
