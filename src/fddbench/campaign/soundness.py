"""Whether what `from_design` gave is a detector, before anything is flown with it."""

import pickle
from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.blocks.layout import Layout
from fddbench.errors import reason_of
from fddbench.interfaces import Bus

__all__ = ["unsound"]

_TRIALS = 3


def unsound(detector: Any, bus: Bus) -> str:
    """What is wrong with a detector, in one line; "" for one that can fly.

    A step that raises is no reason: it may do so for these numbers only, and becomes a row. A step that keeps something in
    the detector itself is one: its result would depend on what flew before.
    """
    if not isinstance(getattr(detector, "states", None), Layout):
        return "from_design gave no detector: it needs an attribute `states`, a fddbench.blocks.layout.Layout"
    names = getattr(detector, "recorded", None)
    if not isinstance(names, tuple) or not all(isinstance(name, str) for name in names):
        return "it needs an attribute `recorded`, a tuple of the names of what it shows, () for nothing"
    try:
        state = detector.start(2)
    except (Exception, SystemExit) as error:
        return f"start(2) raised {reason_of(error)}"
    if np.shape(state) != (detector.states.size, 2):
        return f"start(2) needs to give an array of shape {(detector.states.size, 2)}, got {np.shape(state)}"
    before = _fingerprint(detector)
    _try(detector, np.asarray(state, dtype=float), bus)
    if before is not None and _fingerprint(detector) != before:
        return "its step keeps something in the detector itself; keep it in the state, which is passed in and out"
    return ""


def _try(detector: Any, state: Any, bus: Bus) -> None:
    """A few steps on plain numbers; what they raise does not matter here."""
    with np.errstate(all="ignore"):
        for trial in range(_TRIALS):
            measured = {
                name: np.full((rows, 2) if rows else (2,), 0.1 * (trial + 1.0)) for name, rows in bus.signals.items()
            }
            try:
                state, _ = detector.step(state, SimpleNamespace(**measured))
            except (Exception, SystemExit):
                return


def _fingerprint(detector: Any) -> bytes | None:
    """Everything the detector holds, as bytes; None when that cannot be told."""
    try:
        return pickle.dumps(vars(detector))
    except Exception:
        return None
