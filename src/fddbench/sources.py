"""What code flies: hashes of source and versions of libraries, by names in which a difference can be told.

The program is hashed room by room. A package of somebody else's whose classes fly is hashed file by file, data included, and
so is everything that it imports and that can change without its version (an editable installation, a folder on the path);
of what is installed for good the version stands for the code. Source is hashed once per process and class: the code in
memory is that of the file when it was imported, not what the file has become since.
"""

import ast
import json
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from hashlib import sha256
from importlib.machinery import PathFinder
from importlib.metadata import Distribution, distribution, entry_points, packages_distributions
from importlib.util import find_spec
from pathlib import Path
from typing import Any

__all__ = ["Foreign", "foreign", "own"]

_DECIDE_NO_ROW = ("api", "cli", "design", "gallery", "reporting", "testing", "gallery.py", "__main__.py")
_DECIDE_NO_BIT = ("fddbench", "pydantic", "pydantic_core")


@cache
def own() -> Mapping[str, str]:
    """Sha256 of the source of every room of this package that decides rows, by ``fddbench/<room>``."""
    package = Path(__file__).parent
    rooms: dict[str, list[Path]] = {}
    for path in _files(package):
        room = path.relative_to(package).parts[0]
        if room not in _DECIDE_NO_ROW:
            rooms.setdefault(f"{package.name}/{room}", []).append(path)
    return {room: _digest(package, paths) for room, paths in sorted(rooms.items())}


@dataclass(frozen=True)
class Foreign:
    """Code of other packages that flies: versions of those that have one, sha256 of the source of those that may change."""

    versions: dict[str, str] = field(default_factory=dict)
    source: dict[str, str] = field(default_factory=dict)


def foreign(members: Iterable[Any], files: Mapping[str, bytes]) -> Foreign:
    """Code of other packages that stands behind members of kinds and files beside a campaign.

    Parameters
    ----------
    members : iterable of class or object
        What flies.
    files : mapping of str to bytes
        Python and other files that travel with the campaign, by name; they are hashed elsewhere, what they import is not.
    """
    anchors = frozenset(anchor for member in members for anchor in _anchors(member))
    imports = {name for file, text in files.items() if file.endswith(".py") for name in _imports(text)}
    return _behind(anchors, frozenset(imports))


def _anchors(member: Any) -> Iterator[type]:
    """Classes of a member that stand in a module under their own name, its bases among them."""
    for each in (member if isinstance(member, type) else type(member)).__mro__:
        module = sys.modules.get(each.__module__)
        if getattr(module, each.__qualname__, None) is each:
            yield each


@cache
def _behind(anchors: frozenset[type], imports: frozenset[str]) -> Foreign:
    """Follow imports from the classes and files to everything that is not part of Python."""
    registered = {_unit(anchor.__module__) for anchor in anchors}
    found, left = Foreign(), [*registered, *map(_unit, imports)]
    seen = {"", *_DECIDE_NO_BIT}
    while left:
        unit = left.pop()
        top = unit.partition(".")[0]
        if unit in seen or top in seen or top in sys.stdlib_module_names or top.startswith("fddbench_plugin_"):
            continue
        seen.add(unit)
        owner = _owner(unit)
        if owner is not None:
            found.versions[owner.metadata["Name"]] = owner.version
        if unit in registered or owner is None or _editable(owner):
            root, paths = _source(unit)
            if paths:
                found.source[unit] = _digest(root, paths)
            left += [_unit(name) for path in paths if path.suffix == ".py" for name in _imports(path.read_bytes())]
    return found


def _unit(module: str) -> str:
    """Package that a module is changed and installed with: its outermost one that is no namespace; "" for none."""
    parts = module.split(".")
    for depth in range(1, len(parts) + 1):
        name = ".".join(parts[:depth])
        try:
            spec = find_spec(name)
        except (ImportError, ValueError, AttributeError):
            return ""
        if spec is None:
            return ""
        if spec.origin is not None:
            return name
    return ""


def _source(unit: str) -> tuple[Path, list[Path]]:
    """Folder of a package or module, and its files."""
    spec = find_spec(unit) or PathFinder.find_spec(unit)
    origin = Path(spec.origin) if spec is not None and spec.origin else Path()
    if not origin.is_file():
        return Path(), []
    if spec is not None and spec.submodule_search_locations is not None:
        return origin.parent, list(_files(origin.parent))
    return origin.parent, [origin]


def _files(folder: Path) -> Iterator[Path]:
    """Files of a package, in order; neither hidden ones nor what Python or an editor leaves there."""
    for path in sorted(folder.rglob("*")):
        inside = path.relative_to(folder).parts
        hidden = any(part.startswith(".") or part == "__pycache__" for part in inside)
        if path.is_file() and not hidden and path.suffix != ".pyc" and not path.name.endswith("~"):
            yield path


def _digest(root: Path, paths: Iterable[Path]) -> str:
    """Sha256 of files and their names; a line ends alike on every system."""
    text = sha256()
    for path in paths:
        content = path.read_bytes()
        if path.suffix == ".py":
            content = content.replace(b"\r\n", b"\n")
        text.update(f"{path.relative_to(root).as_posix()}\0{len(content)}\0".encode() + content)
    return text.hexdigest()


def _imports(text: bytes) -> set[str]:
    """Modules that a Python file imports anywhere in it; those of its own package are not named."""
    try:
        nodes = list(ast.walk(ast.parse(text)))
    except (SyntaxError, ValueError):
        return set()
    found = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    return found | {
        node.module for node in nodes if isinstance(node, ast.ImportFrom) and not node.level and node.module
    }


def _owner(unit: str) -> Distribution | None:
    """Distribution that a package came with: the one that registers kinds from it, else the one that lists its files."""
    for group in entry_points().groups:
        if group.startswith("fddbench."):
            for point in entry_points(group=group):
                if point.dist is not None and f"{point.module}.".startswith(f"{unit}."):
                    return point.dist
    names = _distributions().get(unit.partition(".")[0], [])
    return distribution(names[0]) if names else None


@cache
def _distributions() -> Mapping[str, list[str]]:
    return packages_distributions()


def _editable(owner: Distribution) -> bool:
    """Whether the code of a distribution lies where somebody works on it."""
    try:
        return bool(json.loads(owner.read_text("direct_url.json") or "{}")["dir_info"]["editable"])
    except (ValueError, KeyError, TypeError):
        return False
