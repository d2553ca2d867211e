"""Whether a loop that somebody else wrote keeps what `fddbench.interfaces.Loop` asks, before anything is flown with it."""

from typing import Any

import numpy as np

from fddbench.errors import FddbenchError, place_of, reason_of
from fddbench.interfaces import Loop, Sample
from fddbench.runner.assembly import Assembly
from fddbench.runner.reconfiguration import nothing_declared, told

__all__ = ["require_sound"]

_NEEDS = ("bus", "states", "constants", "draws", "before", "truth", "prepare", "start", "step")
_SAMPLES = 2


def require_sound(assembly: Assembly) -> None:
    """Fly a few samples of the first case and look at everything that comes back.

    Raises
    ------
    FddbenchError
        With what is wrong, and in which line.
    """
    loop, name = assembly.loop, assembly.plan.campaign.benchmark
    missing = [part for part in _NEEDS if part not in dir(loop)]
    if missing:
        raise FddbenchError(
            f"the loop of benchmark {name!r} has no {' and no '.join(missing)}; see fddbench.interfaces.Loop"
        )
    try:
        wrong = _flown(assembly)
    except FddbenchError:
        raise
    except (Exception, SystemExit) as error:  # somebody else's code may raise anything
        wrong = f"{reason_of(error)}{place_of(error)}"
    if wrong:
        raise FddbenchError(f"the loop of benchmark {name!r} cannot fly: {wrong}")


def _flown(assembly: Assembly) -> str:
    """What is wrong with the first samples; "" for nothing."""
    batch = assembly.batch(np.zeros(2, dtype=np.int64))
    loop = assembly.loop
    x, c = loop.states.unpack(batch.state), loop.constants.unpack(batch.constants)
    more = told(assembly, nothing_declared(assembly, 2))
    with np.errstate(all="ignore"):
        for sample, drawn in enumerate(assembly.normals(loop.draws, batch, 0, _SAMPLES)):
            x, seen = loop.step(x, c, loop.draws.unpack(drawn), np.float64(sample), **more)
            loop.states.check(x, 2)
            wrong = _shown(loop, seen)
            if wrong:
                return wrong
    return ""


def _shown(loop: Loop, seen: Any) -> str:
    """What is wrong with what the loop shows."""
    if not isinstance(seen, Sample):
        return f"step gives (state, Sample), got {type(seen).__name__}; see fddbench.interfaces.Sample"
    for name, rows in loop.bus.signals.items():
        shape = np.shape(vars(seen.measured).get(name, ()))
        if shape != ((rows, 2) if rows else (2,)):
            need = f"({rows}, n_cases)" if rows else "(n_cases,)"
            return f"the bus announces {name} of shape {need}, the step shows {shape}"
    if set(seen.truth) != set(loop.truth):
        return f"truth announces {sorted(loop.truth)}, the step shows {sorted(seen.truth)}; make them equal"
    if np.shape(seen.departed) != (2,):
        return f"departed needs the shape (n_cases,), got {np.shape(seen.departed)}"
    if seen.added is not None and np.shape(seen.added) != (len(loop.bus.sites), 2):
        return (
            f"added needs the shape ({len(loop.bus.sites)}, n_cases), a row for every site, got {np.shape(seen.added)}"
        )
    for name, error in seen.voted.items():
        if np.shape(error) != (2,) or name not in loop.bus.signals:
            return f"voted has the error of voted signals of the bus, (n_cases,) each; got {name} of shape {np.shape(error)}"
    return ""
