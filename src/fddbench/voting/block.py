"""A voter as a block: most keep nothing from sample to sample, some do."""

from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Row, Rows
from fddbench.errors import FddbenchError

__all__ = ["VoterBlock"]


class VoterBlock:
    """Block whose step is fed with the sensors, (n_sensors, n_cases), and gives the voted signal, (n_cases,).

    Parameters
    ----------
    voter : Voter
        With ``vote(sensors)``; or, if it keeps something, with ``states``, ``start()`` and ``step(x, sensors)``.
    """

    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, voter: Any) -> None:
        self.voter = voter
        self.states: Layout[Any] = getattr(voter, "states", NOTHING)
        self.keeps = self.states.size > 0

    def start(self, c: Nothing) -> Any:
        """Of the voter."""
        return self.voter.start() if self.keeps else c

    def step(self, x: Any, c: Nothing, n: Nothing, sensors: Rows) -> tuple[Any, Row]:
        """State at the next sample, and the voted signal at this one."""
        del c, n
        after, voted = self.voter.step(x, sensors) if self.keeps else (x, self.voter.vote(sensors))
        if np.shape(voted) != np.shape(sensors)[1:]:
            raise FddbenchError(
                f"the voter {type(self.voter).__name__} gives a signal of shape {np.shape(voted)}, needs (n_cases,): one row"
            )
        return after, voted
