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
    """Load of a step in C; every path is the longest, for none depends on data.

    Attributes
    ----------
    code_bytes, table_bytes, state_bytes : int
        Machine code, constants, and the state.
    stack_bytes : int or None
        Of the step and all its functions together; None where the compiler does not say it.
    ticks : int or None
        Of the time-stamp counter (constant rate, not cycles of the core), the mean of 400 steps, fewest of 50 times; None where
        there is no such counter.
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
        ticks = "" if self.ticks is None else f"; {self.ticks} time-stamp ticks a step here"
        return (
            f"in C: code {self.code_bytes} B, tables {self.table_bytes} B, state {self.state_bytes} B{stack}{ticks}; one path, "
            f"the longest ({self.by})"
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
        made = subprocess.run(
            [*by.command, *by.flags, *usage, "-c", f"{name}.c", "-o", "own.o"],
            cwd=where,
            capture_output=True,
            check=False,
        )
        if made.returncode or shutil.which("size") is None:
            raise CompileError(f"{by.version} makes no object of {name}.c, or there is no `size` (Debian: binutils)")
        sections = subprocess.run(["size", "-A", "own.o"], cwd=where, capture_output=True, text=True, check=True).stdout
        sizes = {part: int(n) for part, n in re.findall(r"^(\.[\w.]+)\s+(\d+)", sections, flags=re.MULTILINE)}
        compile_in(where, by, [f"{name}.c", "timed.c"], "timed")
        ticks, state = subprocess.run(["./timed"], cwd=where, capture_output=True, text=True, check=True).stdout.split()
        stack = (
            [int(line.split("\t")[1]) for line in (where / "own.su").read_text().splitlines()]
            if (where / "own.su").exists()
            else None
        )
    return LoadInC(
        code_bytes=sum(n for part, n in sizes.items() if part.startswith(".text")),
        table_bytes=sum(n for part, n in sizes.items() if part.startswith(".rodata")),
        state_bytes=int(state), stack_bytes=None if stack is None else sum(stack), ticks=int(ticks) or None, by=str(by),
    )  # fmt: skip
