"""Who starts and ends the server and the stages of opaque detectors."""

import atexit
import os
import socket
import subprocess
import sys
from threading import RLock, current_thread, main_thread
from typing import Any

from fddbench.errors import FddbenchError
from fddbench.runner.supervised.order import Order
from fddbench.runner.supervised.wire import ask, told

__all__ = ["Stage", "can_supervise"]

_TRIES = 3
_READY_S = 120.0
_lock = RLock()


def can_supervise() -> bool:
    """Whether this system can: it forks, and passes open files between processes."""
    return hasattr(os, "fork") and hasattr(socket, "send_fds") and bool(sys.executable)


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
        if self.process is None:
            atexit.register(self.stop)
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


def _own() -> int:
    """Process with which the server ends, this one; 0 in other threads, whose end is not that of the process."""
    return os.getpid() if current_thread() is main_thread() else 0
