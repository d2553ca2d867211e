"""The hand-written step, compiled for this machine when it is needed."""

import ctypes
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

from tests.bench import step
from tests.bench.absent import AbsentError

FLAGS = ("-O3", "-march=native", "-ffast-math", "-std=c++17", "-fPIC", "-w", "-Wno-psabi")

EXACT = "-ffp-contract=off"


def compiler() -> str:
    """Path of a C++ compiler, or `AbsentError`."""
    for name in ("g++", "clang++", "c++"):
        if path := shutil.which(name):
            return path
    raise AbsentError("no C++ compiler")


@cache
def build(*, noise: bool, lanes: int, exact: bool = False):
    """Function (n, first, last, state, after, constants, key) of the library; `exact`: rounded as ours, nothing fused."""
    flags = [EXACT if flag == "-ffast-math" and exact else flag for flag in FLAGS]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "consts.h").write_text(_constants(), encoding="utf-8")
        part, library = str(folder / "step.o"), str(folder / "step.so")
        given = [
            f"-DW={lanes}",
            *(["-DNOISE"] if noise else []),
            f"-I{folder}",
            str(Path(__file__).with_name("step.cpp")),
        ]
        subprocess.run([compiler(), *flags, *given, "-c", "-o", part], check=True)
        # linked without -ffast-math, with which a library turns denormal numbers to zero in the whole process
        subprocess.run([compiler(), "-shared", "-o", library, part], check=True)
        fly = ctypes.CDLL(library).fly
    fly.argtypes = [ctypes.c_long] * 3 + [ctypes.c_void_p] * 3 + [ctypes.c_uint64]
    return fly


def _constants() -> str:
    tables = {name: getattr(step, name) for name in ("A", "B", "LAW", "RATE", "A_O", "B_O", "L_O")}
    lines = [f"#define NS {step.STATES.size}", f"#define NC {step.CONSTANTS.size}"]
    for name, values in tables.items():
        shape = "".join(f"[{n}]" for n in values.shape)
        text = repr(np.asarray(values).tolist()).replace("[", "{").replace("]", "}")
        lines.append(f"static constexpr double {name}{shape} = {text};")
    return "\n".join(lines) + "\n"
