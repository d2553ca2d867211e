"""The system's C compiler: found, asked who it is, and never allowed to contract or to reorder."""

import os
import re
import shlex
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from pathlib import Path

from fddbench import private
from fddbench.errors import FddbenchError

__all__ = ["CompileError", "Compiler", "built", "compiler", "selftest_command"]

_FLAGS = ("-std=c99", "-O2")
"""How an exported file is compiled for flights."""
_UNCONTRACTED = ("-ffp-contract=off", "-fno-tree-slp-vectorize")
"""What forbids contraction: GCC 12 at -O3 -march=native fuses a product with alternating sums in spite of the first alone."""
_CHANGES_BITS = re.compile(
    r"-ffast-math|-Ofast|-ffp-contract=(?!off)|-funsafe-math-optimizations|-fassociative-math|-freciprocal-math"
    r"|-ffinite-math-only|-fno-signed-zeros|-mfpmath=(?!sse$)|-ffp-model=(?!strict|precise)|^-m32$|-mno-sse"
    r"|-fsingle-precision-constant|-fexcess-precision=fast|-mdaz-ftz|-fdenormal-fp-math=(?!ieee)"
)
_LONGEST_S = 300.0


class CompileError(FddbenchError):
    """There is no compiler, or it refuses the code."""


@dataclass(frozen=True)
class Compiler:
    """A compiler and its flags.

    Attributes
    ----------
    command : tuple of str
        How it is called, ``("gcc",)`` or ``("zig", "cc")``.
    version : str
        First line of what it says of itself.
    flags : tuple of str
        How it compiles, all of them.
    """

    command: tuple[str, ...]
    version: str
    flags: tuple[str, ...]

    def __str__(self) -> str:
        """Compiler and flags, for a line of a report."""
        return f"{self.version}, {' '.join(self.flags)}"


@cache
def compiler(command: str = "", flags: tuple[str, ...] = ()) -> Compiler:
    """The compiler to fly with: the one named, else ``$CC``, else the first of cc, gcc and clang.

    Parameters
    ----------
    command : str
        Name or path, with arguments if it needs some ("zig cc").
    flags : tuple of str
        Behind the usual ones and ``$CFLAGS``; behind them all what forbids contraction, so that none of them wins.

    Raises
    ------
    CompileError
        There is none, or a flag would change bits.
    """
    wanted = command or os.environ.get("CC", "")
    found = tuple(shlex.split(wanted)) or tuple(filter(None, [next(filter(shutil.which, ("cc", "gcc", "clang")), "")]))
    if not found or shutil.which(found[0]) is None:
        what = f"no compiler {wanted!r} is here" if wanted else "no C compiler is here (looked for cc, gcc and clang)"
        raise CompileError(f"{what}; install one (Debian: apt-get install gcc; PyPI: ziglang), or name it: CC=clang")
    own = (*_FLAGS, *shlex.split(os.environ.get("CFLAGS", "")), *flags)
    refused = [flag for flag in (*found[1:], *own) if _CHANGES_BITS.search(flag)]
    if refused:
        raise CompileError(f"{' '.join(refused)} would change the bits of a flight; take it out of CC or CFLAGS")
    try:
        said = subprocess.run([*found, "--version"], capture_output=True, text=True, timeout=60, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise CompileError(f"{found[0]} does not say who it is: {error}") from error
    return Compiler(found, (said.stdout or said.stderr).split("\n")[0].strip() or found[0], (*own, *_UNCONTRACTED))


def selftest_command(name: str) -> str:
    """How a user compiles and runs the self-test of an export in its folder."""
    return f"cc {' '.join(_FLAGS)} {' '.join(_UNCONTRACTED)} {name}.c {name}_selftest.c -lm && ./a.out"


def built(sources: Mapping[str, str], by: Compiler, main: Sequence[str] = ()) -> Path:
    """Program made of some files, by name; made once and kept in the user's cache.

    Parameters
    ----------
    main : sequence of str
        Files to compile; all that end with .c by default.

    Raises
    ------
    CompileError
        What the compiler says.
    """
    parts = [*by.command, by.version, *by.flags, *(f"{name}\0{text}" for name, text in sorted(sources.items())), *main]
    kept = _place() / f"{sha256(chr(0).join(parts).encode()).hexdigest()[:32]}.flown"
    if not kept.exists() or private.trouble(kept):
        with tempfile.TemporaryDirectory(dir=kept.parent) as aside:
            for name, text in sources.items():
                (Path(aside) / name).parent.mkdir(parents=True, exist_ok=True)
                (Path(aside) / name).write_text(text, encoding="utf-8")
            files = list(main) or sorted(name for name in sources if name.endswith(".c"))
            compile_in(Path(aside), by, files, "flown")
            (Path(aside) / "flown").replace(kept)
    return kept


def compile_in(where: Path, by: Compiler, files: Sequence[str], output: str) -> None:
    """Compile files of a folder to a program in it.

    Raises
    ------
    CompileError
        What the compiler says.
    """
    command = [*by.command, *by.flags, "-o", output, *files, "-lm"]
    try:
        said = subprocess.run(command, cwd=where, capture_output=True, text=True, timeout=_LONGEST_S, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise CompileError(f"{by.version} does not compile: {error}") from error
    if said.returncode:
        lines = [line for line in (said.stderr or said.stdout).splitlines() if line.strip()]
        raise CompileError(f"{by.version} refuses {', '.join(files)}:\n" + "\n".join(lines[:12]))


def _place() -> Path:
    """Where programs are kept: with machine code, in a folder that is this user's alone; else in one of this process."""
    try:
        where = private.made(private.folder())
        with tempfile.TemporaryFile(dir=where):
            return where
    except OSError:
        return Path(_of_this_process().name)


@cache
def _of_this_process() -> tempfile.TemporaryDirectory[str]:
    """A folder that is removed when the process ends."""
    return tempfile.TemporaryDirectory(prefix="fddbench-c-")
