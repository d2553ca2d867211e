"""The processes themselves: the server, stages of one detector each, and flight processes. Started as a module."""

import json
import mmap
import os
import signal
import socket
import sys
import time
import warnings
from contextlib import suppress
from typing import Any, NoReturn

import numpy as np

from fddbench.designs.adapted import Adapted
from fddbench.errors import DesignError, reason_of
from fddbench.runner.supervised.manners import die_with, limit_memory, new_luck, print_little
from fddbench.runner.supervised.wire import BROKEN, HEADER, Shape, receive, received, tell
from fddbench.runner.verdicts import OneByOne, SideBySide, verdicts_of

__all__ = ["main"]

_PAUSE_S = 0.005


def main(fd: int, parent: int) -> NoReturn:
    """Fork a stage for everybody who asks, until the parent is gone."""
    die_with(parent)
    control = socket.socket(fileno=fd)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    warnings.filterwarnings("ignore", message=".*fork.*", category=DeprecationWarning)
    tell(control, "READY")
    while True:
        order, (stage,) = _next(control)
        if _forked() == 0:
            control.close()
            _stage(socket.socket(fileno=stage), order)
        os.close(stage)


def _next(control: socket.socket) -> tuple[Any, list[int]]:
    """Next request; the end of this process where nobody asks any more."""
    try:
        return receive(control)
    except (EOFError, OSError):
        os._exit(0)


def _forked() -> int:
    """0 in a new process, which dies with this one; its number here."""
    parent = os.getpid()
    child = os.fork()
    if child == 0:
        die_with(parent)
    return child


def _stage(control: socket.socket, order: Any) -> NoReturn:
    """Build a detector, say so, and fork a flight process for every batch."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    os.setpgrp()
    new_luck()
    print_little()
    try:
        detector = order.built()
        _ = detector.opaque  # traced once, not in every flight process
        tell(control, "READY")
    except BaseException as error:
        tell(control, str(error) if isinstance(error, DesignError) else reason_of(error))
        os._exit(1)
    flying: set[int] = set()
    while True:
        try:
            request, fds = receive(control)
        except (EOFError, OSError):
            for process in flying:
                _end(process)
            os._exit(0)
        _reap(flying, besides=request.get("end", 0))
        if "end" in request:
            flying.discard(request["end"])
            tell(control, _end(request["end"], patience_s=request["patience_s"]))
            continue
        process = _forked()
        if process == 0:
            control.close()
            _fly(detector, Shape.of(detector, request["n_cases"]), request, *fds)
        for fd in fds:
            os.close(fd)
        flying.add(process)
        tell(control, process)


def _reap(flying: set[int], besides: int) -> None:
    """Forget flight processes that have ended because nobody asked them any more."""
    for process in flying - {besides}:
        with suppress(ChildProcessError):
            if os.waitpid(process, os.WNOHANG)[0]:
                flying.discard(process)


def _end(process: int, patience_s: float = 0.0) -> int | None:
    """End a flight process and all of its group, if it does not end in some time itself; its status, None without any."""
    status, until = None, time.monotonic() + patience_s
    with suppress(OSError):
        ended = 0
        while not ended and time.monotonic() < until:
            ended, status = os.waitpid(process, os.WNOHANG)
            time.sleep(0.0 if ended else _PAUSE_S)
        for kill in (os.killpg, *(() if ended else (os.kill,))):
            with suppress(OSError):
                kill(process, signal.SIGKILL)
        return status if ended else os.waitpid(process, 0)[1]
    return None


def _fly(detector: Adapted, shape: Shape, request: dict[str, Any], fd: int, progress: int) -> NoReturn:
    """Step flights on what comes, and answer with verdicts, until nobody asks any more."""
    try:
        os.setpgrp()
        new_luck()
        own, connection = os.getpid(), socket.socket(fileno=fd)
        where = memoryview(mmap.mmap(progress, 0)).cast("q")
        os.close(progress)
        limit_memory(request["memory_mb"])

        def watch(flight: int) -> None:
            where[0] = flight
            where[1] += 1

        with np.errstate(all="ignore"):
            verdicts = verdicts_of(detector, shape.n_cases, watch=watch, too_much=request["too_much"])
            connection.sendall(_answer(shape, verdicts, None, known := [False] * shape.n_cases))
            while True:
                normals, measured, active = shape.read_sample(received(connection, shape.sample_bytes))
                verdict = verdicts.step(normals, measured, active)
                if os.getpid() != own:  # a step has forked: only one of both answers
                    os._exit(0)
                connection.sendall(_answer(shape, verdicts, verdict, known))
    except BaseException:
        os._exit(BROKEN)


def _answer(shape: Shape, verdicts: OneByOne | SideBySide, verdict: Any, known: list[bool]) -> bytes:
    """Verdict, and what was raised that is not known yet."""
    new = []
    for i, raised in enumerate(verdicts.raised):
        if raised and not known[i]:
            known[i] = True
            new.append([i, raised[0], *raised[1]])
    extra = json.dumps(new).encode() if new else b""
    rows = b"" if verdict is None else shape.verdict(verdict)
    return HEADER.pack(verdict is not None, len(extra)) + rows + extra


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
