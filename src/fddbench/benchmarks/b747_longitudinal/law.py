"""What a law of the longitudinal benchmark must offer."""

from types import SimpleNamespace
from typing import Any, Protocol

from fddbench.benchmarks.b747_longitudinal.manoeuvres import Command
from fddbench.benchmarks.b747_longitudinal.plant import TrimPoint
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Row, record

__all__ = ["LAW_NEEDS", "Law", "Orders"]

LAW_NEEDS = ("states", "constants", "draws", "prepare", "start", "step")
"""What a class must have to be a `Law`."""


@record
class Orders:
    """Orders to elevator and stabiliser [deg] and thrust per engine [N], trim included, (n_cases,) each.

    Thrust is that at the trim's airspeed: at a held lever it falls with airspeed.
    """

    elevator_deg: Row
    stabiliser_deg: Row
    thrust_n: Row


class Law(Protocol):
    """A control law; a class made from ``(sample_s)``, a block.

    One that does not look at ``elevator_declared`` says ``reconfigures = False``: campaigns with ``reconfigure`` refuse it.
    """

    states: Layout[Any]
    constants: Layout[Any]
    draws: Draws[Any]

    def prepare(self, at: TrimPoint) -> Any:
        """Constants of flights that begin in this trim."""
        ...

    def start(self, c: Any) -> Any:
        """State before sample 0, at which the orders are the trim."""
        ...

    def step(
        self, x: Any, c: Any, n: Any, seen: SimpleNamespace, command: Command, elevator_declared: Row
    ) -> tuple[Any, Orders]:
        """State at the next sample, and orders of this one.

        Parameters
        ----------
        seen : namespace
            Measured signals (`fddbench.benchmarks.b747_longitudinal.sensors.SIGNALS`).
        command : Command
            Deviations from the trim that the manoeuvre asks for; what it adds to the elevator comes later.
        elevator_declared : (n_cases,) row
            1 where a detector has declared the elevator faulty and the campaign reconfigures, else 0.
        """
        ...
