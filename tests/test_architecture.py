"""The house rules that a machine can hold: room sizes, documented names, registered members."""

import ast
import importlib
import inspect
import pkgutil
from importlib.metadata import entry_points
from pathlib import Path

import pytest

import fddbench
from fddbench import registry

SOURCE = Path(fddbench.__file__).parent
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


@pytest.mark.parametrize("name", MODULES)
def test_public_names_are_documented_and_listed(name):
    module = importlib.import_module(name)
    assert module.__doc__
    if name.count(".") > 1 and not name.endswith("__init__"):
        for public in getattr(module, "__all__", ()):
            thing = getattr(module, public)
            if inspect.isfunction(thing) or inspect.isclass(thing):
                assert inspect.getdoc(thing), f"{name}.{public} has no docstring"


@pytest.mark.parametrize("family", registry.FAMILIES)
def test_every_member_is_registered_loads_and_says_what_it_is(family):
    assert registry.kinds(family)
    for name in registry.kinds(family):
        member = registry.load(family, name)
        assert inspect.getdoc(member)
    assert len(entry_points(group=f"fddbench.{family}s")) >= len(registry.kinds(family))


def _members(folder: str, apart: set[str]) -> set[str]:
    paths = (SOURCE / folder).iterdir()
    return {path.stem for path in paths if not path.name.startswith("_") and path.suffix in ("", ".py")} - apart


@pytest.mark.parametrize(
    ("folder", "family", "apart"),
    [
        ("faults", "fault", {"specification", "injection"}),
        ("voting", "voter", set()),
        ("benchmarks", "benchmark", set()),
        ("detection", "detector", {"consolidation", "confirmation", "isolation"}),
    ],
)
def test_every_file_of_a_family_is_registered(folder, family, apart):
    assert _members(folder, apart) == set(registry.kinds(family))
