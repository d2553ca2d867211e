"""The house rules that a machine can hold: room sizes, documented names, registered members, parts addressed by name."""

import ast
import importlib
import inspect
import pkgutil
import re
import subprocess
from importlib.metadata import entry_points
from pathlib import Path
from typing import get_args

import pytest

import fddbench
from fddbench import kinds

SOURCE = Path(fddbench.__file__).parent
ROOT = Path(__file__).parents[1]
FILES = sorted(SOURCE.rglob("*.py"))
MODULES = sorted(m.name for m in pkgutil.walk_packages(fddbench.__path__, "fddbench.") if m.name != "fddbench.__main__")
BANNED = {"utils", "util", "common", "helpers", "core", "misc"}


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(SOURCE)))
def test_rooms_are_small(path):
    text = path.read_text(encoding="utf-8")
    assert text.count("\n") <= 300, "split this module: it is more than one thing"
    long = [
        f"{node.name}: {node.end_lineno - node.lineno + 1} lines"
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.FunctionDef) and node.end_lineno - node.lineno + 1 > 60
    ]
    assert not long
    assert path.stem not in BANNED


@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="no repository")
def test_what_is_under_version_control_is_small():
    """Wheels that a download had left in the folder were once committed with everything else."""
    files = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.split("\0")
    large = [
        name for name in filter(None, files) if (ROOT / name).is_file() and (ROOT / name).stat().st_size > 1_000_000
    ]
    assert not large


@pytest.mark.parametrize("name", MODULES)
def test_public_names_are_documented_and_listed(name):
    """What a module lists is there and says what it is, and so do the methods of its classes."""
    module = importlib.import_module(name)
    assert module.__doc__
    listed = getattr(module, "__all__", ())
    for public in listed:
        thing = getattr(module, public)
        if inspect.isfunction(thing) or inspect.isclass(thing):
            assert inspect.getdoc(thing), f"{name}.{public} has no docstring"
        if inspect.isclass(thing):
            for method, found in vars(thing).items():
                if inspect.isfunction(found) and not method.startswith("_"):
                    assert inspect.getdoc(found), f"{name}.{public}.{method} has no docstring"


ADDRESSES = {
    "a part is addressed by its name, not by a made one": re.compile(r'getattr\([^,()]+, f"'),
    "random numbers have names": re.compile(r"normals\[\d+ *:"),
}


@pytest.mark.parametrize("why", ADDRESSES)
def test_parts_and_numbers_are_addressed_by_name(why):
    """Only the engine, which knows no names, may do otherwise."""
    found = [
        f"{path.relative_to(SOURCE)}: {match[0]}"
        for path in FILES
        if path.parent.name != "blocks"
        for match in ADDRESSES[why].finditer(path.read_text(encoding="utf-8"))
    ]
    assert not found


SHIPPED = ("benchmark", "fault", "voter", "detector", "recipe", "scheduling")


def test_families_without_a_shipped_member_are_parts_of_a_benchmark():
    assert set(SHIPPED) <= set(kinds.FAMILIES)
    chosen = {
        choice.family for name in kinds.known("benchmark") for choice in kinds.load("benchmark", name).choices.values()
    }
    assert set(kinds.FAMILIES) - set(SHIPPED) <= chosen


@pytest.mark.parametrize("family", SHIPPED)
def test_every_member_is_registered_loads_and_says_what_it_is(family):
    assert kinds.known(family)
    for name in kinds.known(family):
        member = kinds.load(family, name)
        assert inspect.getdoc(member)
    assert len(entry_points(group=f"fddbench.{family}s")) >= len(kinds.known(family))


def _parts(path: Path) -> list[str]:
    """Modules of a package that lie in its folder, as imports write them: ``detection.sliding_mode.observer``."""
    return [
        ".".join(("fddbench", *file.relative_to(SOURCE).with_suffix("").parts)).removesuffix(".__init__")
        for file in sorted(path.rglob("*.py"))
    ]


NAMED = re.compile(r"fddbench(\.\w+)+:\w+")


def _imports(module: str) -> set[str]:
    """Modules that a module of the package imports, or names as the place of a choice."""
    path = SOURCE.joinpath(*module.split(".")[1:])
    file = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    found: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and NAMED.fullmatch(node.value):
            found.add(node.value.split(":")[0])
    return found


def _used(family: str, parts: set[str]) -> set[str]:
    """Registered members of a family, and what they import of these modules, and so on."""
    left = [point.value.split(":")[0] for point in kinds.registered(family).values()]
    found: set[str] = set()
    while left:
        module = left.pop()
        if module in parts and module not in found:
            found.add(module)
            left += _imports(module)
    return found


FAMILY_FOLDERS = [
    ("faults", "fault"),
    ("voting", "voter"),
    ("benchmarks", "benchmark"),
    ("detection", "detector"),
    ("scheduling", "scheduling"),
]


@pytest.mark.parametrize(("folder", "family"), FAMILY_FOLDERS)
def test_every_file_of_a_family_is_registered_or_used_by_one_that_is(folder, family):
    """What nobody reaches is a member that somebody forgot to register; the loops of benchmarks fly faults and voters."""
    parts = {name for name in _parts(SOURCE / folder) if name != f"fddbench.{folder}"}
    loops = _used("benchmark", {name for other, _ in FAMILY_FOLDERS for name in _parts(SOURCE / other)})
    packages = {name for name in parts if (SOURCE.joinpath(*name.split(".")[1:])).is_dir()}
    unused = parts - _used(family, parts) - (loops & parts) - {name for name in packages if _holds(name, family)}
    assert not unused


def _holds(package: str, family: str) -> bool:
    """Whether a folder lies above modules that are reached; its own file says only what they are."""
    return any(name.startswith(f"{package}.") for name in _used(family, set(_parts(SOURCE))))


SHAPES = {**kinds.FAMILIES, "voter": ("about", "vote")}


def _members(folder: str, family: str) -> set[type]:
    """Public classes of a folder that have all that a member needs; kinds of faults know their own name."""
    found = set()
    for module in map(importlib.import_module, _parts(SOURCE / folder)):
        for thing in (getattr(module, name) for name in getattr(module, "__all__", ())):
            if inspect.isclass(thing) and set(SHAPES[family]) <= set(dir(thing)):
                own = getattr(thing, "model_fields", {}).get("kind")
                found |= {thing} if own is None or get_args(own.annotation) else set()
    return found


@pytest.mark.parametrize(("folder", "family"), FAMILY_FOLDERS)
def test_what_looks_like_a_member_is_registered(folder, family):
    assert _members(folder, family) == {kinds.load(family, name) for name in kinds.known(family)}
