"""Who starts and ends the processes of opaque detectors, and notices when one does not answer."""

import json
import mmap
import os
import select
import signal
import socket
import subprocess
import sys
import tempfile
import time
from threading import RLock, current_thread, main_thread
from typing import Any

import numpy as np

from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats
from fddbench.runner.supervised.order import Order
from fddbench.runner.supervised.wire import BROKEN, HEADER, Shape, ask, received, told

__all__ = ["DiedError", "FlightProcess", "Raisings", "Stage", "can_supervise"]

Raisings = list[tuple[int, str, tuple[str, str]]]
"""What has been raised since the last answer: flight, reason, and what the same errors share."""

_TRIES = 3
_READY_S = 120.0
_PATIENCE_S = 0.5
_LOOKS = 8
"""How often in the time of a step one looks whether it goes on."""
_LONGEST_EXTRA = 10_000_000
_lock = RLock()


def can_supervise() -> bool:
    """Whether this system can: it forks, and passes open files between processes."""
    return hasattr(os, "fork") and hasattr(socket, "send_fds") and bool(sys.executable)


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


class _Server:
    """The process from which all stages are forked, started when it is needed."""

    def __init__(self) -> None:
        self.process: subprocess.Popen[bytes] | None = None
        self.control: socket.socket | None = None
        self.of = 0

    def stage(self, order: Order) -> socket.socket:
        """Socket of a new stage, whose first word is READY or what is wrong.

        Raises
        ------
        OSError, EOFError
            The server is gone; the next call starts another one.
        """
        if self.control is None or self.of != os.getpid():
            self._start()
        assert self.control is not None
        ours, theirs = socket.socketpair()
        try:
            ask(self.control, order, [theirs.fileno()])
        except OSError:
            self.stop()
            raise
        finally:
            theirs.close()
        ours.settimeout(_READY_S)
        return ours

    def _start(self) -> None:
        ours, theirs = socket.socketpair()
        arguments = [sys.executable, "-m", "fddbench.runner.supervised.server", str(theirs.fileno()), str(_own())]
        self.process = subprocess.Popen(
            arguments,
            pass_fds=[theirs.fileno()],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            env={**os.environ, "PYTHONSAFEPATH": "1"},
            start_new_session=True,
        )
        theirs.close()
        ours.settimeout(_READY_S)
        self.control, self.of = ours, os.getpid()
        try:
            if told(ours) != "READY":
                raise EOFError
        except (OSError, EOFError):
            self.stop()
            raise
        ours.settimeout(None)

    def stop(self) -> None:
        """End it; the next stage has a new one."""
        if self.control is not None:
            self.control.close()
        if self.process is not None and self.of == os.getpid():
            self.process.kill()
            self.process.wait()
        self.process = self.control = None


_server = _Server()


class Stage:
    """A detector built in a process of its own, from which flight processes are forked.

    A death before it says READY is nobody's flight; it is tried three times.

    Raises
    ------
    FddbenchError
        It does not start, or cannot build the detector.
    """

    def __init__(self, order: Order) -> None:
        self.order, self.of = order, 0
        self.control: socket.socket | None = None

    def _ready(self) -> socket.socket:
        """Its socket; started anew where it is gone."""
        if self.control is not None and self.of == os.getpid():
            return self.control
        word = "it ended before it was ready"
        for _ in range(_TRIES):
            try:
                control = _server.stage(self.order)
                word = told(control)
            except (OSError, EOFError):
                _server.stop()
                continue
            if word == "READY":
                control.settimeout(_READY_S)
                self.control, self.of = control, os.getpid()
                return control
            control.close()
            break
        raise FddbenchError(f"{self.order.name} cannot be made in a process of its own: {word}")

    def fork(self, request: dict[str, Any], fds: list[int]) -> int:
        """A new flight process, its number."""
        with _lock:
            for _ in range(_TRIES):
                control = self._ready()
                try:
                    ask(control, request, fds)
                    return int(told(control))
                except (OSError, EOFError):
                    self.close()
        raise FddbenchError(
            f"{self.order.name}: its process ended {_TRIES} times while it waited; is there enough memory?"
        )

    def end(self, process: int, patience_s: float = 0.0) -> int | None:
        """End a flight process, if it does not in some time by itself; its status, None where nobody knows."""
        with _lock:
            if self.control is None or self.of != os.getpid():
                return None
            try:
                ask(self.control, {"end": process, "patience_s": patience_s})
                status = told(self.control)
            except (OSError, EOFError):
                self.close()
                return None
        return int(status) if status is not None else None

    def close(self) -> None:
        """End it; a later flight starts it anew."""
        if self.control is not None:
            self.control.close()
        self.control = None

    def __del__(self) -> None:
        """Its socket ends it."""
        self.close()


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
            return DiedError("crashed", f"its process died of {signal.Signals(os.WTERMSIG(status)).name}", flight)
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


def _own() -> int:
    """Process with which the server ends, this one; 0 in other threads, whose end is not that of the process."""
    return os.getpid() if current_thread() is main_thread() else 0
