"""Names to classes, by entry points; the built-in members use the same door as a user's."""

from collections import Counter
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any

from fddbench.errors import FddbenchError, UnknownNameError

__all__ = ["FAMILIES", "kinds", "load"]

FAMILIES = ("benchmark", "fault", "voter", "detector")


@cache
def kinds(family: str) -> dict[str, EntryPoint]:
    """Name → entry point of every registered member of `family` ("detector", "fault", ...), in alphabetical order."""
    found = sorted(entry_points(group=f"fddbench.{family}s"), key=lambda point: point.name)
    distinct = {(point.name, point.value): point for point in found}
    twice = [name for name, n in Counter(name for name, _ in distinct).items() if n > 1]
    if twice:
        owners = sorted(f"{name} = {value}" for name, value in distinct if name in twice)
        raise FddbenchError(f"two packages register the same {family}:\n  " + "\n  ".join(owners))
    return {point.name: point for point in distinct.values()}


def load(family: str, name: str, *, where: str = "") -> Any:
    """Class registered as `name`; its module is imported now and not before.

    Raises
    ------
    UnknownNameError
        Nobody registered the name; the message lists the known ones.
    """
    known = kinds(family)
    if name not in known:
        raise UnknownNameError(family, name, tuple(known), where)
    return known[name].load()
