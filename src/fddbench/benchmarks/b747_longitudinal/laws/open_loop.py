"""No law: everything stays in trim."""

from types import SimpleNamespace
from typing import Any

from fddbench.benchmarks.b747_longitudinal.law import Orders
from fddbench.benchmarks.b747_longitudinal.manoeuvres import Command
from fddbench.benchmarks.b747_longitudinal.plant import TRIM_POINT, TrimPoint
from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Row

__all__ = ["OpenLoop"]


class OpenLoop:
    """Orders that stay in trim whatever is commanded, as for Fig. 1; a pulse of the manoeuvre still reaches the elevator."""

    reconfigures = False
    states: Layout[Any] = NOTHING
    constants = Layout(TRIM_POINT)
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, sample_s: float) -> None:
        del sample_s

    def prepare(self, at: TrimPoint) -> TrimPoint:
        """The trim."""
        return at

    def start(self, c: TrimPoint) -> Nothing:
        """No state."""
        del c
        return Nothing()

    def step(
        self, x: Nothing, c: TrimPoint, n: Nothing, seen: SimpleNamespace, command: Command, elevator_declared: Row
    ) -> tuple[Nothing, Orders]:
        """The trim."""
        del n, seen, command, elevator_declared
        return x, Orders(elevator_deg=c.elevator_deg, stabiliser_deg=c.stabiliser_deg, thrust_n=c.thrust_n)
