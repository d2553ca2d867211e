"""Measure, and print what was measured beside what was asked."""

import argparse
import os
import platform
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from fddbench.blocks import llvm
from tests.bench import growth, ratios, six, whole
from tests.bench.report import HEADER, Line


def main() -> None:
    """Print the table line by line."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench", description=__doc__)
    parser.add_argument("--repeats", type=int, default=7, help="turns of every peer (default 7)")
    parser.add_argument("--only", choices=("ratios", "six", "growth", "whole"), help="one part of the table")
    given = parser.parse_args()
    print("\n".join(_where()), f"\n{HEADER}")
    for line in _lines(given.only, given.repeats):
        print(line, flush=True)
    print(f"load average now {_load()}")


def _lines(only: str | None, repeats: int) -> Iterator[Line]:
    if only in {None, "ratios"}:
        yield from ratios.lines(repeats=repeats, turn_s=0.2)
    if only in {None, "six"}:
        yield from six.lines(repeats=max(3, repeats // 2), turn_s=0.2)
    if only in {None, "growth"}:
        yield from growth.lines(repeats=max(3, repeats // 2))
    if only in {None, "whole"}:
        yield from whole.lines(repeats=max(3, repeats // 2))


def _where() -> Iterator[str]:
    names = ("numpy", "llvmlite", "scipy", "control", "heyoka", "jax", "jsbsim")
    found = " ".join(f"{name} {_version(name)}" for name in names)
    machine = llvm.machine()
    yield f"{_processor()}, {os.cpu_count()} cores, {machine.cpu if machine else ''}, {machine.lanes if machine else 0} lanes"
    yield f"Python {platform.python_version()} {found}"
    yield f"load average {_load()}; ratios are of run-steps per CPU second, taken in turn; above 1 we are faster"


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "absent"


def _processor() -> str:
    path = Path("/proc/cpuinfo")
    lines = path.read_text(encoding="utf-8").splitlines() if path.is_file() else []
    return next(
        (line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.processor()
    )


def _load() -> str:
    return " ".join(f"{x:.1f}" for x in os.getloadavg()) if hasattr(os, "getloadavg") else "unknown"


if __name__ == "__main__":
    main()
