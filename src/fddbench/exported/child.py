"""Exported code in a process of its own: a small main around it that steps many flights at a request."""

import os
import select
import signal
import struct
import subprocess
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.errors import EndedError, signal_name
from fddbench.exported.child_main import ANSWER, MAGIC, SHORT_OF_MEMORY

__all__ = ["Child", "CodeError", "GoneError"]

Bytes = npt.NDArray[np.uint8]
PATIENCE_S = 20.0
"""How long a step of all flights may last [s]."""
_LAST_S = 1.0
"""How long code may go on whose files are closed [s]."""


class CodeError(EndedError):
    """Code crashed, hung or spoke nonsense."""


class GoneError(CodeError):
    """Its process ended: perhaps not of itself, or for what it had kept from earlier steps."""


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
    memory_mb : float
        Memory that it may take beyond what it has when it begins [MB]; 0: any.
    """

    def __init__(
        self, program: Path, wrapper: tuple[str, ...] = (), *, patience_s: float = PATIENCE_S, memory_mb: float = 0.0
    ) -> None:
        self.patience_s, self._memory_mb, self._swapped, self._answers = patience_s, memory_mb, False, 0
        self._until = time.monotonic() + patience_s
        try:
            self._process = subprocess.Popen(
                [*wrapper, str(program), str(os.getpid()), f"{memory_mb:.0f}"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                bufsize=0,
                start_new_session=True,
            )
        except OSError as error:
            raise CodeError("error", f"{program} cannot be run: {error}") from error
        assert self._process.stdin is not None
        os.set_blocking(self._process.stdin.fileno(), False)  # it may stop reading
        head = self._read(16)
        self._swapped = struct.unpack("=I", head[:4])[0] != MAGIC
        magic, self.state_size, self.inputs_size, self.outputs_size = struct.unpack(self._order + "4I", head)
        if magic != MAGIC:
            raise CodeError(
                "error", "the code wrote to its standard output while it was loaded, which belongs to the flight"
            )
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
        self._until, self._answers = time.monotonic() + self.patience_s, self._answers + 1
        self._write(struct.pack(self._order + "I", n) + np.concatenate([state, inputs], axis=1).tobytes())
        if struct.unpack(self._order + "2I", self._read(8)) != (ANSWER, self._answers):
            self._kill()
            raise CodeError("crashed", "it wrote to files that are not its own")
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
        if self._process.returncode is None:
            self._wait(2.0)

    def __del__(self) -> None:
        """A program does not outlive its flights."""
        if hasattr(self, "_process"):
            self.close()

    def _write(self, data: bytes) -> None:
        assert self._process.stdin is not None
        view = memoryview(data)
        try:
            while view:
                self._wait_for([], [self._process.stdin])
                view = view[self._process.stdin.write(view) or 0 :]
        except OSError as error:
            raise self._ended() from error

    def _read(self, size: int) -> bytes:
        assert self._process.stdout is not None
        parts, left = [], size
        while left:
            self._wait_for([self._process.stdout], [])
            part = self._process.stdout.read(left)
            if not part:
                raise self._ended()
            parts.append(part)
            left -= len(part)
        return b"".join(parts)

    def _wait_for(self, reading: list[Any], writing: list[Any]) -> None:
        """Until a pipe is ready; the time of a step is that of all its parts."""
        if not any(select.select(reading, writing, [], max(self._until - time.monotonic(), 0.0))):
            self._kill()
            raise CodeError("timeout", f"no answer in {self.patience_s:g} s")

    def _kill(self) -> None:
        """End it, and what it has begun: it leads a group of its own."""
        with suppress(OSError):
            os.killpg(self._process.pid, signal.SIGKILL)

    def _wait(self, patience_s: float) -> bool:
        """Whether it ends by itself; what it has begun ends with it."""
        try:
            self._process.wait(patience_s)
            ended = True
        except subprocess.TimeoutExpired:
            ended = False
        self._kill()
        self._process.wait()
        return ended

    def _ended(self) -> CodeError:
        """Why it is gone."""
        if not self._wait(_LAST_S):
            return CodeError("crashed", "it closed files that are not its own")
        code = self._process.returncode
        if code == SHORT_OF_MEMORY:
            return GoneError("memory", f"it needs more than {self._memory_mb:g} MB")
        what = (
            f"its process died of {signal_name(-code)}" if code < 0 else f"it ended its process with exit code {code}"
        )
        return GoneError("crashed", what)
