"""Whether what `from_design` gave is a detector, before anything is flown with it."""

import pickle
from collections.abc import Callable, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.blocks.layout import Nothing
from fddbench.designs.adapted import Adapted
from fddbench.designs.one_flight import OneFlight, flights_of
from fddbench.designs.reasons import missing_signal, place_in, same_line
from fddbench.errors import DesignError, raise_interrupt, reason_of
from fddbench.interfaces import Bus, Floats

__all__ = ["Samples", "unsound"]

Samples = Callable[[], Sequence[SimpleNamespace]]
"""Gives the first measured samples of some flights of a campaign, (n_cases,) and (n_rows, n_cases) rows."""

_TRIALS = 3
_BATCHED = "if it is written for many flights side by side, say `batched = True` in it"


def unsound(adapted: Adapted, samples: Samples | None = None) -> str:
    """What is wrong with a detector, in one line; "" for one that can fly.

    A step that raises on plain numbers, gives another shape or no verdict is one; so is one that keeps something in the
    detector itself: its result would depend on what flew before. A detector of ordinary Python is shown the first samples of
    real flights, `samples`, since it may rightly raise on others.
    """
    adapted = adapted.at_every_sample
    named = adapted.recorded
    if not isinstance(named, tuple) or not all(isinstance(name, str) for name in named):
        return "it needs an attribute `recorded`, a tuple of the names of what it shows, () for nothing"
    lacking = [name for name in ("start", "step") if not callable(getattr(adapted.detector, name, None))]
    if lacking:
        return f"from_design gave no detector: it has no {' and no '.join(lacking)}"
    if adapted.batched and not adapted.has_states:
        return "with batched = True it needs an attribute `states`, a fddbench.blocks.layout.Layout; without, leave out both"
    unknown = [name for name in adapted.watches if name not in adapted.bus.names]
    if unknown:
        return f"it watches {unknown}, the sites of this benchmark are {list(adapted.bus.names)}"
    if adapted.one_by_one and adapted.obstacle.mistake and (wrong := _tried_together(adapted)):
        return wrong  # a detector of rows, as its `states` say, with a mistake in it
    if adapted.one_by_one:
        return _tried_alone(adapted, (samples or _made_up(adapted.bus, 1))())
    return _tried_together(adapted)


def _tried_together(adapted: Adapted) -> str:
    """What goes wrong in a few steps of two flights side by side on made-up numbers; "" for nothing."""
    detector, before = adapted.detector, _fingerprint(adapted.detector)
    try:
        state = adapted.states.spread(adapted.start(Nothing()), 2)
    except BaseException as error:
        raise_interrupt(error)
        return f"its start is no record of its states: {reason_of(error)}{place_in(error, detector, 'start')}"
    normals = adapted.draws.unpack(np.zeros((adapted.draws.size, 2)))
    with np.errstate(all="ignore"):
        for measured in _made_up(adapted.bus, 2)():
            try:
                state, _ = adapted.step(state, Nothing(), normals, measured)
            except BaseException as error:
                return _raised(error, adapted)
            try:
                adapted.states.check(state, 2)
            except TypeError as error:
                return f"its step gives no record of its states: {error}{place_in(error, detector, 'step')}"
    if before is not None and _fingerprint(detector) != before:
        return "its step keeps something in the detector itself; keep it in the state, which is passed in and out"
    return ""


def _tried_alone(adapted: Adapted, samples: Sequence[SimpleNamespace]) -> str:
    """What goes wrong in the first steps of every one of some flights, one at a time; "" unless it is always the same."""
    one = OneFlight(adapted)
    wrong: dict[tuple[str, str], str] = {}
    flights = list(zip(*(flights_of(measured) for measured in samples), strict=True))
    normals = adapted.draws.unpack(np.zeros(adapted.draws.size))
    for flight in flights:
        try:
            state = one.start()
        except BaseException as error:
            raise_interrupt(error)
            return f"its start raised {reason_of(error)}{place_in(error, adapted.detector, 'start')}"
        try:
            with np.errstate(all="ignore"):
                for measured in flight:
                    state, _ = one.step(state, normals, measured)
        except BaseException as error:
            wrong.setdefault(same_line(error, adapted.detector), _raised(error, adapted))
        else:
            return ""
    if len(wrong) != 1:
        return ""
    why = " ".join(adapted.opaque.split())
    hint = f"; {_BATCHED}" if adapted.has_states else ""
    return f"{next(iter(wrong.values()))}. It sees one flight at a time, numbers and 1-D arrays, since {why}{hint}"


def _raised(error: BaseException, adapted: Adapted) -> str:
    """What a step raised, in one line."""
    raise_interrupt(error)
    place = place_in(error, adapted.detector, "step")
    if isinstance(error, DesignError):
        return f"{error}{place}"
    return f"its step raised {reason_of(error)}{missing_signal(error, adapted.bus)}{place}"


def _made_up(bus: Bus, n_cases: int) -> Samples:
    """A few samples of made-up signals that nobody may write into, as in flight."""

    def signal(rows: int, value: float) -> Floats:
        shown = np.full((rows, n_cases) if rows else (n_cases,), value)
        shown.flags.writeable = False
        return shown

    return lambda: [
        SimpleNamespace(**{name: signal(rows, 0.1 * (trial + 1.0)) for name, rows in bus.signals.items()})
        for trial in range(_TRIALS)
    ]


def _fingerprint(detector: Any) -> bytes | None:
    """Everything the detector holds, as bytes; None when that cannot be told."""
    try:
        return pickle.dumps(vars(detector))
    except Exception:
        return None
