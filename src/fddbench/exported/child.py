"""Exported code in a process of its own: a small main around it that steps many flights at a request."""

import os
import select
import struct
import subprocess
from pathlib import Path

import numpy as np
import numpy.typing as npt

from fddbench.errors import FddbenchError, signal_name

__all__ = ["IMPATIENT_S", "Child", "CodeError", "HungError", "main_text"]

Bytes = npt.NDArray[np.uint8]
_MAGIC = 0x0FDDBE4C
PATIENCE_S = 20.0
IMPATIENT_S = 2.0
"""How long a step of all flights may last [s], and how long once the code has hung."""


_MAIN = """\
/* Steps many flights of {name} at a request: a count, then state and inputs of each; back come state and outputs.
 * What the code itself prints goes nowhere, and what it reads is empty. */
#define _POSIX_C_SOURCE 200809L

#include "{name}.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int main(void)
{{
    static {name}_state_t start;
    uint32_t sizes[4] = {{
        {magic}U, (uint32_t)sizeof({name}_state_t), (uint32_t)sizeof({name}_inputs_t), (uint32_t)sizeof({name}_outputs_t)
    }};
    unsigned char *taken = NULL;
    unsigned char *given = NULL;
    uint32_t room = 0U;
    uint32_t n = 0U;
    size_t in = sizeof({name}_state_t) + sizeof({name}_inputs_t);
    size_t out = sizeof({name}_state_t) + sizeof({name}_outputs_t);
    FILE *from = fdopen(dup(0), "rb");
    FILE *to = fdopen(dup(1), "wb");
    if ((from == NULL) || (to == NULL) || (freopen("/dev/null", "r", stdin) == NULL)
        || (freopen("/dev/null", "w", stdout) == NULL))
    {{
        return 5;
    }}
    (void)memset(&start, 0, sizeof(start));
    {name}_init(&start);
    (void)fwrite(sizes, sizeof(sizes), 1, to);
    (void)fwrite(&start, sizeof(start), 1, to);
    (void)fflush(to);
    while (fread(&n, sizeof(n), 1, from) == 1U)
    {{
        uint32_t k;
        if (n > room)
        {{
            free(taken);
            free(given);
            room = n;
            taken = malloc(room * in);
            given = malloc(room * out);
            if ((taken == NULL) || (given == NULL)) {{ return 3; }}
        }}
        if ((n > 0U) && (fread(taken, in, n, from) != n)) {{ return 4; }}
        for (k = 0U; k < n; k++)
        {{
            {name}_state_t state;
            {name}_inputs_t inputs;
            {name}_outputs_t outputs;
            (void)memcpy(&state, taken + (k * in), sizeof(state));
            (void)memcpy(&inputs, taken + (k * in) + sizeof(state), sizeof(inputs));
            (void)memset(&outputs, 0, sizeof(outputs));
            {name}_step(&inputs, &state, &outputs);
            (void)memcpy(given + (k * out), &state, sizeof(state));
            (void)memcpy(given + (k * out) + sizeof(state), &outputs, sizeof(outputs));
        }}
        (void)fwrite(given, out, n, to);
        (void)fflush(to);
    }}
    return 0;
}}
"""


class CodeError(FddbenchError):
    """Foreign code crashed, hung or spoke nonsense."""


class HungError(CodeError):
    """It does not answer."""


def main_text(name: str) -> str:
    """Text of the main around a detector."""
    return _MAIN.format(name=name, magic=_MAGIC)


class Child:
    """A running program.

    Parameters
    ----------
    program : Path
        Made of `main_text` and the code.
    wrapper : tuple of str
        What runs it: qemu, valgrind; nothing by default.
    patience_s : float
        How long a step of all flights may last [s].
    """

    def __init__(self, program: Path, wrapper: tuple[str, ...] = (), patience_s: float = PATIENCE_S) -> None:
        self._patience_s, self._swapped = patience_s, False
        try:
            self._process = subprocess.Popen(
                [*wrapper, str(program)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, bufsize=0,
                start_new_session=True,
            )  # fmt: skip
        except OSError as error:
            raise CodeError(f"{program} cannot be run: {error}") from error
        head = self._read(16)
        self._swapped = struct.unpack("=I", head[:4])[0] != _MAGIC
        magic, self.state_size, self.inputs_size, self.outputs_size = struct.unpack(self._order + "4I", head)
        if magic != _MAGIC:
            raise CodeError("the code wrote to its standard output while it was loaded, which belongs to the flight")
        self.start = np.frombuffer(self._read(self.state_size), dtype=np.uint8)

    @property
    def _order(self) -> str:
        return (">" if os.sys.byteorder == "little" else "<") if self._swapped else "="  # type: ignore[attr-defined]

    @property
    def number_type(self) -> str:
        """Byte order of its numbers, for NumPy."""
        return self._order

    def step(self, state: Bytes, inputs: Bytes) -> tuple[Bytes, Bytes]:
        """State after a sample and outputs of many flights, (n_flights, n_bytes) each.

        Raises
        ------
        CodeError
            It crashed or does not answer.
        """
        n = len(state)
        self._write(struct.pack(self._order + "I", n) + np.concatenate([state, inputs], axis=1).tobytes())
        size = self.state_size + self.outputs_size
        rows = np.frombuffer(self._read(n * size), dtype=np.uint8).reshape(n, size)
        return rows[:, : self.state_size], rows[:, self.state_size :]

    def close(self) -> None:
        """End it."""
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                try:
                    stream.close()
                except OSError:
                    continue
        if self._process.poll() is None:
            try:
                self._process.wait(2.0)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()

    def __del__(self) -> None:
        """A program does not outlive its flights."""
        if hasattr(self, "_process"):
            self.close()

    def _write(self, data: bytes) -> None:
        assert self._process.stdin is not None
        view = memoryview(data)
        try:
            while view:
                view = view[self._process.stdin.write(view) :]
        except OSError as error:
            raise self._ended() from error

    def _read(self, size: int) -> bytes:
        assert self._process.stdout is not None
        parts, left = [], size
        while left:
            ready, _, _ = select.select([self._process.stdout], [], [], self._patience_s)
            if not ready:
                self._process.kill()
                raise HungError("the code does not answer: a loop without end?")
            part = self._process.stdout.read(left)
            if not part:
                raise self._ended()
            parts.append(part)
            left -= len(part)
        return b"".join(parts)

    def _ended(self) -> CodeError:
        code = self._process.wait()
        if code < 0:
            return CodeError(f"the code crashed: {signal_name(-code)}")
        return CodeError(f"the code ended its process with {code}; a step only returns")
