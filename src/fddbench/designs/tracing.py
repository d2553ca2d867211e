"""A detector's step as a program, where it can be one."""

from collections.abc import Mapping
from types import SimpleNamespace
from typing import TYPE_CHECKING, NamedTuple

from fddbench.blocks.layout import Nothing, Rows
from fddbench.blocks.program import Program, trace
from fddbench.blocks.trouble import TraceError
from fddbench.errors import DesignError, FddbenchError, raise_interrupt, reason_of
from fddbench.interfaces import Bus

if TYPE_CHECKING:
    from fddbench.designs.adapted import Adapted

__all__ = ["Obstacle", "detector_program", "obstacle", "why_opaque"]


def detector_program(detector: "Adapted", bus: Bus) -> Program:
    """One step of a detector alone as a program with the inputs ``state``, ``normals`` and the signals of the bus.

    Raises
    ------
    Exception
        Whatever its step raises on traced values.
    """

    def step(state: Rows, normals: Rows, **signals: Rows) -> Mapping[str, Rows]:
        before = {name: value.ids.copy() for name, value in signals.items()}
        x, n = detector.states.unpack(state), detector.draws.unpack(normals)
        after, verdict = detector.step(x, Nothing(), n, SimpleNamespace(**signals))
        if any((signals[name].ids != ids).any() for name, ids in before.items()):
            raise DesignError("its step writes into measured signals, which are everybody's; copy them first")
        rows = {"declared": verdict.declared, "alarm": verdict.alarm, "residual": verdict.residual}
        rows |= {} if verdict.estimate is None else {"estimate": verdict.estimate}
        return {"state": detector.states.pack(after), **rows, **verdict.signals}

    return trace(step, state=detector.states.size, normals=detector.draws.size, **bus.signals)


def why_opaque(detector: "Adapted", bus: Bus) -> str:
    """Why a detector cannot be traced, in one line; "" when it can."""
    return obstacle(detector, bus).reason


class Obstacle(NamedTuple):
    """Why a step cannot be traced, "" when it can; and whether the same would go wrong on plain rows, for all we know."""

    reason: str
    mistake: bool = False


def obstacle(detector: "Adapted", bus: Bus) -> Obstacle:
    """What is in the way of tracing a detector.

    A step that keeps something between two calls gives two different programs, and is opaque for that.
    """
    if not detector.has_states:
        return Obstacle("it has no `states`: ordinary Python")
    try:
        if detector_program(detector, bus).hash != detector_program(detector, bus).hash:
            return Obstacle("its step keeps something between two calls")
    except TraceError as error:
        return Obstacle(" ".join(str(error).split()))
    except BaseException as error:  # a user's step may raise anything on values that are not arrays
        raise_interrupt(error)
        return Obstacle(
            " ".join(str(error).split()) if isinstance(error, FddbenchError) else reason_of(error), mistake=True
        )
    return Obstacle("")
