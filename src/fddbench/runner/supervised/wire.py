"""What goes between a run and a flight process: arrays of one length, and now and then what a step has raised."""

import json
import pickle
import socket
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.designs.adapted import Adapted
from fddbench.interfaces import Floats, Verdict

__all__ = ["BROKEN", "HEADER", "Flags", "Shape", "ask", "receive", "received", "tell", "told"]

Flags = npt.NDArray[np.bool_]

HEADER = struct.Struct("<BI")
"""Whether a verdict follows, and bytes of JSON behind it."""

BROKEN = 71
"""Exit code of a process whose socket was closed, by its parent or by the detector."""

_LENGTH = struct.Struct("<I")
_LONGEST = 50_000_000


@dataclass(frozen=True, kw_only=True)
class Shape:
    """Lengths of the messages about some flights of one detector.

    Attributes
    ----------
    n_cases : int
        Flights.
    signals : mapping of str to int
        Rows of each measured signal, 0 for a single one.
    normals : int
        Rows of random numbers.
    sites, estimates : int
        Rows of the declaration and of the estimate; -1 estimates: a single row, seen as (n_cases,).
    recorded : tuple of str
        Names of what it shows.
    """

    n_cases: int
    signals: Mapping[str, int]
    normals: int
    sites: int
    estimates: int
    recorded: tuple[str, ...]

    @classmethod
    def of(cls, detector: Adapted, n_cases: int) -> "Shape":
        """Shape for some flights of a detector."""
        sites = len(detector.bus.names)
        return cls(
            n_cases=n_cases,
            signals=dict(detector.bus.signals),
            normals=detector.draws.size,
            sites=sites,
            estimates={None: 0, "sites": sites}.get(detector.estimates, -1),
            recorded=tuple(detector.recorded),
        )

    @property
    def sample_bytes(self) -> int:
        """Length of a sample."""
        rows = sum(rows or 1 for rows in self.signals.values()) + self.normals
        return self.n_cases * (1 + 8 * rows)

    def sample(self, normals: Floats, measured: SimpleNamespace, active: Flags) -> bytes:
        """Message with what is measured at one sample."""
        own = vars(measured)
        rows = [np.asarray(own[name], dtype=np.float64).tobytes() for name in self.signals]
        return b"".join([*rows, normals.tobytes(), active.tobytes()])

    def read_sample(self, message: bytearray) -> tuple[Floats, SimpleNamespace, Flags]:
        """Random numbers, signals into which nobody can write, and which flights are active."""
        n = self.n_cases
        kept = bytes(message)
        rows = np.frombuffer(kept, dtype=np.float64, count=(len(kept) - n) // 8).reshape(-1, n)
        measured, at = {}, 0
        for name, count in self.signals.items():
            measured[name] = rows[at : at + count] if count else rows[at]
            at += count or 1
        return rows[at:], SimpleNamespace(**measured), np.frombuffer(kept, dtype=bool, offset=len(kept) - n)

    @property
    def verdict_rows(self) -> int:
        """Rows of a verdict."""
        return self.sites + 2 + abs(self.estimates) + len(self.recorded)

    def verdict(self, verdict: Verdict) -> bytes:
        """Message with a verdict."""
        rows = np.empty((self.verdict_rows, self.n_cases))
        after = self.sites + 2 + abs(self.estimates)
        rows[: self.sites], rows[self.sites], rows[self.sites + 1] = verdict.declared, verdict.alarm, verdict.residual
        if self.estimates:
            rows[self.sites + 2 : after] = verdict.estimate
        for j, name in enumerate(self.recorded):
            rows[after + j] = verdict.signals[name]
        return rows.tobytes()

    def read_verdict(self, rows: Floats) -> Verdict:
        """Verdict of rows, (verdict_rows, n_cases)."""
        sites, after = self.sites, self.sites + 2 + abs(self.estimates)
        estimate = None if not self.estimates else rows[sites + 2] if self.estimates < 0 else rows[sites + 2 : after]
        return Verdict(
            rows[:sites],
            rows[sites + 1],
            signals=dict(zip(self.recorded, rows[after:], strict=True)),
            alarm=rows[sites],
            estimate=estimate,
        )


def received(connection: socket.socket, length: int) -> bytearray:
    """So many bytes.

    Raises
    ------
    EOFError
        The other side is gone.
    OSError
        As the socket; TimeoutError where it has a timeout.
    """
    found = bytearray(length)
    view = memoryview(found)
    while view:
        count = connection.recv_into(view)
        if not count:
            raise EOFError
        view = view[count:]
    return found


def ask(connection: socket.socket, request: Any, fds: Sequence[int] = ()) -> None:
    """Send a request to a process of ours, with open files."""
    payload = pickle.dumps(request)
    head = _LENGTH.pack(len(payload))
    if fds:
        socket.send_fds(connection, [head], list(fds))
    else:
        connection.sendall(head)
    connection.sendall(payload)


def receive(connection: socket.socket, most_fds: int = 2) -> tuple[Any, list[int]]:
    """A request and its files; raises EOFError where the other side is gone."""
    head, fds, _, _ = socket.recv_fds(connection, _LENGTH.size, most_fds)
    if not head:
        raise EOFError
    head += bytes(received(connection, _LENGTH.size - len(head)))
    return pickle.loads(bytes(received(connection, *_LENGTH.unpack(head)))), fds


def tell(connection: socket.socket, answer: Any) -> None:
    """Answer in JSON: what comes from a process with somebody else's code is never unpickled."""
    payload = json.dumps(answer).encode()
    connection.sendall(_LENGTH.pack(len(payload)) + payload)


def told(connection: socket.socket) -> Any:
    """An answer; raises EOFError where the other side is gone or does not keep to this."""
    (length,) = _LENGTH.unpack(received(connection, _LENGTH.size))
    if length > _LONGEST:
        raise EOFError
    try:
        return json.loads(received(connection, length))
    except ValueError:
        raise EOFError from None
