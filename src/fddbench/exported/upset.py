"""What an exported detector does with an input that is no number: measured on the flight of its vectors, told in its header."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fddbench.blocks.interpreter import Interpreter
from fddbench.exported.interface import Interface
from fddbench.exported.vectors import Vectors

__all__ = ["Upset", "flown_with_upsets"]

Floats = npt.NDArray[np.float64]
_KINDS = {"not-a-number": np.nan, "infinity": np.inf, "1e308": 1e308}


@dataclass(frozen=True)
class Upset:
    """One sample of one signal replaced.

    Attributes
    ----------
    signal, kind : str
        What was replaced, and by what.
    recovers : int or None
        Samples until every output is again, and stays, that of the undisturbed flight; None: not within the flight.
    finite : bool
        Whether all states are finite numbers at the end.
    """

    signal: str
    kind: str
    recovers: int | None
    finite: bool

    @property
    def effect(self) -> str:
        """What comes of it, in words."""
        if self.recovers == 0:
            return "no output changes"
        if self.recovers is not None:
            return f"outputs recover after {self.recovers} samples"
        return "stays finite, outputs still differ at the end" if self.finite else "stays in the state until init"


def flown_with_upsets(interface: Interface, signals: Mapping[str, Floats]) -> tuple[Vectors, list[Upset]]:
    """Vectors of a flight, and what one bad sample in its middle does, signal by signal.

    Parameters
    ----------
    signals : mapping of str to (n_samples, n_rows) arrays
        Measured signals by name.
    """
    cases = [(m.source, kind) for m in interface.inputs for kind in _KINDS]
    n, width = len(next(iter(signals.values()))) if signals else 1, len(cases) + 1
    interpreter, at = Interpreter(interface.program), n // 2
    state, given = np.repeat(interface.start[:, np.newaxis], width, axis=1), []
    for k in range(n):
        own = {m.source: np.repeat(signals[m.source][k][:, np.newaxis], width, axis=1) for m in interface.inputs}
        if k == at:
            for column, (signal, kind) in enumerate(cases, start=1):
                own[signal][:, column] = _KINDS[kind]
        own = {name: rows if interface.program.inputs[name] else rows[0] for name, rows in own.items()}
        out = interpreter.run(state=state, normals=np.zeros((0, width)), **own)
        state = np.broadcast_to(out["state"], (len(interface.start), width))
        given.append(np.concatenate([np.broadcast_to(out[m.source], (m.size, width)) for m in interface.outputs]))
    outputs = np.array(given)
    columns = [signals[m.source] for m in interface.inputs] or [np.zeros((n, 1))]
    upsets = []
    for column, (signal, kind) in enumerate(cases, start=1):
        apart = np.flatnonzero((outputs[:, :, column] != outputs[:, :, 0]).any(axis=1))
        last = int(apart[-1]) + 1 if len(apart) else at
        finite = bool(np.isfinite(state[:, column]).all())
        upsets.append(Upset(signal, kind, last - at if last < n and finite else None, finite))
    return Vectors(np.concatenate(columns, axis=1), outputs[:, :, 0]), upsets
