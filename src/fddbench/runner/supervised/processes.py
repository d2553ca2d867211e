"""A process that steps flights, and who notices when it does not answer."""

import json
import mmap
import os
import select
import signal
import socket
import tempfile
import time

import numpy as np

from fddbench.errors import signal_name
from fddbench.interfaces import Floats
from fddbench.runner.supervised.stages import Stage
from fddbench.runner.supervised.wire import BROKEN, HEADER, Shape, received

__all__ = ["DiedError", "FlightProcess", "Raisings"]

Raisings = list[tuple[int, str, tuple[str, str]]]
"""What has been raised since the last answer: flight, reason, and what the same errors share."""

_PATIENCE_S = 0.5
_LOOKS = 8
"""How often in the time of a step one looks whether it goes on."""
_LONGEST_EXTRA = 10_000_000


class DiedError(Exception):
    """A flight process is gone, or was ended because it did not answer.

    Parameters
    ----------
    kind, text : str
        ``crashed`` or ``timeout``, and what is known.
    flight : int
        Which flight it was stepping.
    """

    def __init__(self, kind: str, text: str, flight: int) -> None:
        super().__init__(f"{kind}: {text}")
        self.kind, self.flight = kind, flight


class FlightProcess:
    """A process that steps some flights of one detector.

    Parameters
    ----------
    stage : Stage
        The detector.
    shape : Shape
        What is said.
    step_s, memory_mb : float
        Longest step of a flight [s], and memory beyond what the detector has when it is built [MB].
    """

    def __init__(self, stage: Stage, shape: Shape, *, step_s: float, memory_mb: float) -> None:
        self.stage, self.shape, self.step_s = stage, shape, step_s
        self.connection, theirs = socket.socketpair()
        self.connection.settimeout(step_s)
        self.number = 0
        with theirs, tempfile.TemporaryFile() as file:
            file.truncate(16)
            self.where = memoryview(mmap.mmap(file.fileno(), 16)).cast("q")
            too_much = f"memory: it needs more than {memory_mb:g} MB"
            request = {"n_cases": shape.n_cases, "memory_mb": memory_mb, "too_much": too_much}
            self.number = stage.fork(request, [theirs.fileno(), file.fileno()])
        self.poll = select.poll()
        self.poll.register(self.connection, select.POLLIN)

    def begin(self) -> Raisings:
        """What is raised when flights begin.

        Raises
        ------
        DiedError
            As `step`.
        """
        return self._answer()[1]

    def step(self, message: bytes) -> tuple[Floats | None, Raisings]:
        """Verdict on one sample, None where all flights have raised, and what has been raised now.

        Raises
        ------
        DiedError
            The process is gone, or a flight took longer than a step may; then it has been ended.
        """
        try:
            self.connection.sendall(message)
        except TimeoutError:
            raise self._late() from None
        except OSError:
            raise self._gone() from None
        return self._answer()

    def _answer(self) -> tuple[Floats | None, Raisings]:
        self._wait()
        shape = self.shape
        try:
            there, extra = HEADER.unpack(received(self.connection, HEADER.size))
            if there > 1 or extra > _LONGEST_EXTRA:
                raise EOFError
            rows = None
            if there:
                numbers = received(self.connection, 8 * shape.verdict_rows * shape.n_cases)
                rows = np.frombuffer(numbers, dtype=np.float64).reshape(-1, shape.n_cases)
            raised = _raisings(received(self.connection, extra), shape.n_cases) if extra else []
        except TimeoutError:
            raise self._late() from None
        except (OSError, EOFError):
            raise self._gone() from None
        return rows, raised

    def _wait(self) -> None:
        """Wait for an answer as long as steps of flights go on."""
        seen, since = self.where[1], time.monotonic()
        while not self.poll.poll(max(1000.0 * self.step_s / _LOOKS, 1.0)):
            if self.where[1] != seen:
                seen, since = self.where[1], time.monotonic()
            elif time.monotonic() - since >= self.step_s:
                raise self._late()

    def _late(self) -> DiedError:
        flight = self._flight
        self.close()
        return DiedError("timeout", f"a step took longer than {self.step_s:g} s", flight)

    def _gone(self) -> DiedError:
        flight = self._flight
        status = self.close(_PATIENCE_S)  # until its status is known
        if status is None or (os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGKILL):
            return DiedError(
                "crashed", "its process was ended from outside, or closed files that are not its own", flight
            )
        if os.WIFSIGNALED(status):
            return DiedError("crashed", f"its process died of {signal_name(os.WTERMSIG(status))}", flight)
        code = os.waitstatus_to_exitcode(status)
        what = (
            "it closed files that are not its own" if code == BROKEN else f"it ended its process with exit code {code}"
        )
        return DiedError("crashed", what, flight)

    @property
    def _flight(self) -> int:
        """Flight that it was stepping."""
        return int(np.clip(self.where[0], 0, self.shape.n_cases - 1))

    def close(self, patience_s: float = 0.0) -> int | None:
        """End it; its status."""
        self.connection.close()
        number, self.number = self.number, 0
        return self.stage.end(number, patience_s) if number else None

    def __del__(self) -> None:
        """Its socket ends it."""
        self.connection.close()


def _raisings(text: bytearray, n_cases: int) -> Raisings:
    """What a process says was raised; raises EOFError where it does not keep to that."""
    try:
        found = [(int(i), str(reason), (str(kind), str(line))) for i, reason, kind, line in json.loads(text)]
    except (ValueError, TypeError):
        raise EOFError from None
    if not all(0 <= i < n_cases for i, *_ in found):
        raise EOFError
    return found
