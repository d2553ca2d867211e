"""Exported code in a process of its own: a small main around it that steps many flights at a request."""

import os
import select
import struct
import subprocess
from pathlib import Path

import numpy as np
import numpy.typing as npt

from fddbench.errors import EndedError, signal_name
from fddbench.exported.child_main import MAGIC, SHORT_OF_MEMORY

__all__ = ["Child", "CodeError", "CrashedError"]

Bytes = npt.NDArray[np.uint8]
PATIENCE_S = 20.0
"""How long a step of all flights may last [s]."""
_LAST_S = 1.0
"""How long code may go on whose files are closed [s]."""


class CodeError(EndedError):
    """Code crashed, hung or spoke nonsense."""


class CrashedError(CodeError):
    """It ended, by itself or by a signal: perhaps not of itself."""


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
        self.patience_s, self._memory_mb, self._swapped = patience_s, memory_mb, False
        try:
            self._process = subprocess.Popen(
                [*wrapper, str(program), f"{memory_mb:.0f}"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                bufsize=0,
                start_new_session=True,
            )
        except OSError as error:
            raise CodeError(f"{program} cannot be run: {error}") from error
        head = self._read(16)
        self._swapped = struct.unpack("=I", head[:4])[0] != MAGIC
        magic, self.state_size, self.inputs_size, self.outputs_size = struct.unpack(self._order + "4I", head)
        if magic != MAGIC:
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
            ready, _, _ = select.select([self._process.stdout], [], [], self.patience_s)
            if not ready:
                self._process.kill()
                raise CodeError(f"timeout: no answer in {self.patience_s:g} s")
            part = self._process.stdout.read(left)
            if not part:
                raise self._ended()
            parts.append(part)
            left -= len(part)
        return b"".join(parts)

    def _ended(self) -> CodeError:
        """Why it is gone; it may have closed its files and gone on."""
        try:
            code = self._process.wait(_LAST_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            code = self._process.wait()
        if code == SHORT_OF_MEMORY:
            return CodeError(f"memory: it needs more than {self._memory_mb:g} MB")
        if code < 0:
            return CrashedError(f"crashed: its process died of {signal_name(-code)}")
        return CrashedError(f"crashed: it ended its process with exit code {code}")
