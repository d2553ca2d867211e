"""Whether what `from_design` gave is a detector, before anything is flown with it."""

import pickle
import traceback
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.blocks.layout import Layout, Nothing
from fddbench.designs.adapted import Adapted
from fddbench.errors import DesignError, did_you_mean, reason_of
from fddbench.interfaces import Bus, Floats

__all__ = ["line_of", "unsound"]

_TRIALS = 3


def unsound(detector: Any, bus: Bus) -> str:
    """What is wrong with a detector, in one line; "" for one that can fly.

    A step that raises on plain numbers, gives another shape or no verdict is one; so is one that keeps something in the
    detector itself: its result would depend on what flew before.
    """
    if not isinstance(getattr(detector, "states", None), Layout):
        return "from_design gave no detector: it needs an attribute `states`, a fddbench.blocks.layout.Layout"
    names = getattr(detector, "recorded", None)
    if not isinstance(names, tuple) or not all(isinstance(name, str) for name in names):
        return "it needs an attribute `recorded`, a tuple of the names of what it shows, () for nothing"
    before = _fingerprint(detector)
    wrong = _tried(detector, bus)
    if wrong:
        return wrong
    if before is not None and _fingerprint(detector) != before:
        return "its step keeps something in the detector itself; keep it in the state, which is passed in and out"
    return ""


def _tried(detector: Any, bus: Bus) -> str:
    """What goes wrong in a few steps on plain numbers; "" for nothing."""
    try:
        adapted = Adapted(detector, bus)
    except (Exception, SystemExit) as error:
        return f"it is no detector: {reason_of(error)}"
    unknown = [name for name in adapted.watches if name not in bus.names]
    if unknown:
        return f"it watches {unknown}, the sites of this benchmark are {list(bus.names)}"
    try:
        state = adapted.states.spread(adapted.start(Nothing()), 2)
    except (Exception, SystemExit) as error:
        return f"its start is no record of its states: {reason_of(error)}{line_of(error, detector, 'start')}"
    normals = adapted.draws.unpack(np.zeros((adapted.draws.size, 2)))
    with np.errstate(all="ignore"):
        for trial in range(_TRIALS):
            measured = SimpleNamespace(
                **{name: _shown(rows, 0.1 * (trial + 1.0)) for name, rows in bus.signals.items()}
            )
            try:
                state, _ = adapted.step(state, Nothing(), normals, measured)
            except DesignError as error:
                return f"{error}{line_of(error, detector, 'step')}"
            except (Exception, SystemExit) as error:
                return f"its step raised {reason_of(error)}{_missing(error, bus)}{line_of(error, detector, 'step')}"
            try:
                adapted.states.check(state, 2)
            except TypeError as error:
                return f"its step gives no record of its states: {error}{line_of(error, detector, 'step')}"
    return ""


def _shown(rows: int, value: float) -> Floats:
    """A signal of two cases that nobody may write into, as in flight."""
    shown = np.full((rows, 2) if rows else (2,), value)
    shown.flags.writeable = False
    return shown


def _missing(error: BaseException, bus: Bus) -> str:
    """Which signals there are, when a step asked for one that is not measured."""
    if not (isinstance(error, AttributeError) and isinstance(error.obj, SimpleNamespace)):
        return ""
    close = did_you_mean(str(error.name), bus.signals)
    return f". Measured are {', '.join(bus.signals)}{'. ' + close if close else ''}"


def line_of(error: BaseException, detector: Any, method: str) -> str:
    """Line of the author's code that raised, in brackets; where nothing raised, that of the method itself."""
    code = getattr(getattr(detector, method, None), "__code__", None)
    if code is None:
        return ""
    own = Path(code.co_filename).parent
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if Path(frame.filename).is_relative_to(own)]
    if frames:
        return f" ({frames[-1].filename}:{frames[-1].lineno})"
    return f" ({code.co_filename}:{code.co_firstlineno})"


def _fingerprint(detector: Any) -> bytes | None:
    """Everything the detector holds, as bytes; None when that cannot be told."""
    try:
        return pickle.dumps(vars(detector))
    except Exception:
        return None
