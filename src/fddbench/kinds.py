"""Names to kinds: registered by a package, or a class in a file beside a campaign; built-in members use the same door.

A family is what campaigns and designs can name. Packages register members as entry points ``fddbench.<family>s``; a file is
named as ``mine.py:Mine``. A member is found once and carried with the files it came from. One that cannot be imported or
lacks something is told with place and cure, to those who ask for it and nobody else.
"""

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

from fddbench.errors import FddbenchError, UnknownNameError, reason_of
from fddbench.plugin_files import is_file_kind, load_class

__all__ = ["FAMILIES", "Kind", "Named", "find", "is_file_kind", "known", "load", "registered"]

FAMILIES: Mapping[str, tuple[str, ...]] = {
    "benchmark": ("name", "about", "choices", "shown", "limits_from", "plant", "loop"),
    "plant": (),
    "fault": ("about", "in_unit", "numbers", "block"),
    "voter": (),
    "sensor": (),
    "wind": (),
    "law": (),
    "detector": ("Gains", "from_design"),
    "scheduling": ("about", "signals", "parameters", "rho"),
    "recipe": ("spelled_out", "in_folder", "make"),
}
"""Family → what a member must have whoever uses it; a choice of a benchmark may ask for more (`Choice.needs`)."""


@dataclass(frozen=True, kw_only=True)
class Kind:
    """A member of a family.

    Attributes
    ----------
    family, name : str
        As a campaign or design names it.
    member : class or object
        The member itself.
    files : mapping of str to bytes
        The file it came from and those beside it that it needs, by their names beside the campaign or design; empty for one
        that a package registered.
    """

    family: str
    name: str
    member: Any
    files: Mapping[str, bytes] = field(default_factory=dict, repr=False)


class Named(Mapping[str, Any]):
    """Members by name, given as ``package.module:Member``; a module is imported when its member is asked for, not before.

    >>> voters = Named({"median": "fddbench.voting.median:Median", "other": "fddbench.voting.nowhere:Other"})
    >>> list(voters), "other" in voters, voters["median"].__name__
    (['median', 'other'], True, 'Median')
    """

    def __init__(self, places: Mapping[str, str]) -> None:
        self._places = dict(places)

    def __getitem__(self, name: str) -> Any:
        return resolve_name(self._places[name])

    def __contains__(self, name: object) -> bool:
        return name in self._places

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)


@cache
def registered(family: str) -> dict[str, EntryPoint]:
    """Name → entry point of every registered member of a family ("detector", "fault", …), in alphabetical order."""
    found = sorted(entry_points(group=f"fddbench.{family}s"), key=lambda point: point.name)
    distinct = {(point.name, point.value): point for point in found}
    twice = [name for name, n in Counter(name for name, _ in distinct).items() if n > 1]
    if twice:
        owners = sorted(f"{name} = {value}" for name, value in distinct if name in twice)
        raise FddbenchError(f"two packages register the same {family}:\n  " + "\n  ".join(owners))
    return {point.name: point for point in distinct.values()}


def known(family: str) -> tuple[str, ...]:
    """Names of the registered members of a family."""
    return tuple(registered(family))


def load(family: str, name: str) -> Any:
    """Registered member; its module is imported now and not before.

    Raises
    ------
    UnknownNameError
        Nobody registered the name; the message lists the known ones.
    FddbenchError
        It cannot be imported, or lacks something.
    """
    points = registered(family)
    if name not in points:
        raise UnknownNameError(family, name, tuple(points))
    point = points[name]
    try:
        member = point.load()
    except (Exception, SystemExit) as error:  # a package of somebody else's may raise anything
        raise FddbenchError(
            f"the {family} {name!r} is registered as {point.value} and cannot be imported: {reason_of(error)}. Mend or "
            "remove that package"
        ) from error
    _require(family, f"{name!r} ({point.value})", member)
    return member


def find(family: str, name: str, *, beside: Path | None = None) -> Kind:
    """Member of a family: a registered name, or ``mine.py:Mine`` for a class in a file of the folder `beside`.

    Raises
    ------
    FddbenchError
        There is none, or it is none; the message has one line.
    """
    if is_file_kind(name):
        if beside is None:
            raise FddbenchError(f"{name!r} names a file, and there is no folder to look in; give a registered {family}")
        loaded = load_class(name, beside)
        _require(family, f"{name!r} ({beside / name.split(':')[0]})", loaded.member)
        return Kind(family=family, name=name, member=loaded.member, files=loaded.files)
    try:
        return Kind(family=family, name=name, member=load(family, name))
    except UnknownNameError as error:
        raise FddbenchError(str(error).replace("\n", " ")) from None


def _require(family: str, what: str, member: Any) -> None:
    missing = [part for part in FAMILIES[family] if part not in dir(member)]
    if missing:
        raise FddbenchError(
            f"{what} is no {family}: it has no {' and no '.join(missing)}. See fddbench.interfaces for what a {family} needs"
        )
