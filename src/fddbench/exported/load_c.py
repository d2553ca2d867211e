"""What exported C takes on a processor: bytes of code and tables, stack, state, and time-stamp ticks of a step."""

import re
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from fddbench.exported.compiling import CompileError, Compiler, compile_in
from fddbench.exported.interface import Interface

__all__ = ["LoadInC", "load_in_c"]

_BLOCKS, _STEPS = 50, 400
_LONGEST_S = 300.0
_MAIN = """\
#include "{name}.h"

#include <stdio.h>
#include <string.h>
#if defined(__x86_64__)
#include <x86intrin.h>
#define TICKS() __rdtsc()
#else
#define TICKS() 0ULL
#endif

int main(void)
{{
    static {name}_state_t x;
    static {name}_inputs_t in;
    static {name}_outputs_t out;
    unsigned long long least = 0ULL;
    int k;
    (void)memset(&in, 0, sizeof(in));
    {name}_init(&x);
    for (k = 0; k < {blocks}; k++)
    {{
        const unsigned long long begun = TICKS();
        unsigned long long spent;
        int j;
        for (j = 0; j < {steps}; j++)
        {{
            {name}_step(&in, &x, &out);
        }}
        spent = (TICKS() - begun) / {steps}ULL;
        least = ((k == 0) || (spent < least)) ? spent : least;
    }}
    (void)printf("%llu %lu\\n", least, (unsigned long)sizeof(x));
    return 0;
}}
"""


@dataclass(frozen=True, kw_only=True)
class LoadInC:
    """Load of a step in C; no loop depends on data, but a choice may compute one of its sides only.

    Attributes
    ----------
    code_bytes, table_bytes, state_bytes : int
        Machine code, constants, and the state.
    stack_bytes : int or None
        Frames of the step and of all functions that it may call together, so at least what it takes but for math.h; None where
        the compiler does not say it.
    ticks : int or None
        Of the time-stamp counter (constant rate, not cycles of the core), the mean of 400 steps with inputs of 0, fewest of 50
        times; None where there is no such counter.
    by : str
        Compiler and flags.
    """

    code_bytes: int
    table_bytes: int
    state_bytes: int
    stack_bytes: int | None
    ticks: int | None
    by: str

    def __str__(self) -> str:
        """In one line."""
        stack = "" if self.stack_bytes is None else f", stack {self.stack_bytes} B"
        ticks = "" if self.ticks is None else f"; {self.ticks} time-stamp ticks a step here, all inputs 0"
        return (
            f"in C: code {self.code_bytes} B, tables {self.table_bytes} B, state {self.state_bytes} B{stack}{ticks}; no loop "
            f"depends on data ({self.by})"
        )


def load_in_c(interface: Interface, files: Mapping[str, str], by: Compiler) -> LoadInC:
    """Compile and time exported code.

    Raises
    ------
    CompileError
        The compiler refuses it, or the size of an object cannot be asked (binutils).
    """
    name = interface.name
    with tempfile.TemporaryDirectory() as folder:
        where = Path(folder)
        for file, text in {**files, "timed.c": _MAIN.format(name=name, blocks=_BLOCKS, steps=_STEPS)}.items():
            (where / file).write_text(text, encoding="utf-8")
        usage = ["-fstack-usage"] if "clang" not in by.version else []
        if shutil.which("size") is None:
            raise CompileError("there is no `size`, which says how large an object is; install it (Debian: binutils)")
        _said([*by.command, *by.flags, *usage, "-c", f"{name}.c", "-o", "own.o"], where)
        sections = _said(["size", "-A", "own.o"], where)
        sizes = {part: int(n) for part, n in re.findall(r"^(\.[\w.]+)\s+(\d+)", sections, flags=re.MULTILINE)}
        compile_in(where, by, [f"{name}.c", "timed.c"], "timed")
        ticks, state = _said(["./timed"], where).split()
        stack = _stack(where / "own.su", name)
    return LoadInC(
        code_bytes=sum(n for part, n in sizes.items() if part.startswith(".text")),
        table_bytes=sum(n for part, n in sizes.items() if part.startswith(".rodata")),
        state_bytes=int(state), stack_bytes=stack, ticks=int(ticks) or None, by=str(by),
    )  # fmt: skip


def _said(command: list[str], where: Path) -> str:
    """What a command says that must end well."""
    try:
        return subprocess.run(command, cwd=where, capture_output=True, text=True, check=True, timeout=_LONGEST_S).stdout
    except subprocess.CalledProcessError as error:
        raise CompileError(f"{command[0]} ended with {error.returncode}: {error.stderr.strip()[:500]}") from error
    except (OSError, subprocess.TimeoutExpired) as error:
        raise CompileError(f"{command[0]} cannot be run: {error}") from error


def _stack(usage: Path, name: str) -> int | None:
    """Bytes of stack of the step and what it calls; the other functions of the header are no part of a step."""
    if not usage.exists():
        return None
    others = {f"{name}_{each}" for each in ("init", "usable", "sound")}
    frames = [line.split("\t") for line in usage.read_text().splitlines()]
    return sum(int(size) for where, size, *_ in frames if where.rsplit(":", 1)[-1] not in others)
