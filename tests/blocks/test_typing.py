"""A type checker refuses a misspelt state: the whole reason for records."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BLOCK = '''
"""A lag that counts."""

from typing import Any

from fddbench.blocks.block import NO_DRAWS, NOTHING, Block
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, record


@record
class FilterState:
    """Level, and for how many samples it has stood."""

    level: Row
    held_samples: Row


class Filter:
    """A first-order lag that counts."""

    states = Layout(FilterState(level=ROW, held_samples=ROW))
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def start(self, c: Nothing) -> FilterState:
        """At rest."""
        return FilterState(level=0.0, {start}=0.0)

    def step(self, x: FilterState, c: Nothing, n: Nothing, u: Row) -> tuple[FilterState, Row]:
        """One sample."""
        level = 0.9 * x.{read} + 0.1 * u
        return FilterState(level=level, held_samples=x.held_samples + 1.0), level


block: Block[FilterState, Nothing, Nothing, Row] = Filter()
first = block.start(Nothing()).{seen}
'''
RIGHT = {"start": "held_samples", "read": "level", "seen": "level"}
WRONG = {"start": "held_sample", "read": "levle", "seen": "levels"}


@pytest.mark.slow
def test_strict_mypy_refuses_three_misspelt_states_and_nothing_else(tmp_path):
    pytest.importorskip("mypy")
    for name, names in (("right", RIGHT), ("wrong", WRONG)):
        (tmp_path / f"{name}.py").write_text(BLOCK.format(**names), encoding="utf-8")
    options = ["--strict", "--no-error-summary", "--no-pretty", "--config-file", str(ROOT / "pyproject.toml")]
    # the cache of `make lint`, where there is one: the package itself need not be looked at again
    options += ["--cache-dir", str(ROOT / ".mypy_cache"), str(tmp_path / "right.py"), str(tmp_path / "wrong.py")]
    done = subprocess.run(
        [sys.executable, "-m", "mypy", *options], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.stderr == ""
    errors = [line for line in done.stdout.splitlines() if ": error: " in line]
    assert len(errors) == len(WRONG), done.stdout
    for name, line in zip(WRONG.values(), errors, strict=True):
        assert "wrong.py" in line
        assert f'"{name}"' in line, line
