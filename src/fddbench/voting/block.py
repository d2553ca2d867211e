"""A voter as a block: most keep nothing from sample to sample, some do."""

from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Row, Rows
from fddbench.errors import FddbenchError
from fddbench.voting.mean_of_left import mean_of_left

__all__ = ["VoterBlock"]


class VoterBlock:
    """Block whose step is fed with the sensors, (n_sensors, n_cases), and gives the voted signal, (n_cases,).

    Parameters
    ----------
    voter : Voter
        With ``vote(sensors)``; or, if it keeps something, with ``states``, ``start()`` and ``step(x, sensors)``. One that keeps
        something and says ``reconfigures = True`` is handed what is declared, as ``step(x, sensors, declared)``.
    """

    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, voter: Any) -> None:
        self.voter = voter
        self.states: Layout[Any] = getattr(voter, "states", NOTHING)
        self.keeps = self.states.size > 0
        self.is_told = self.keeps and getattr(voter, "reconfigures", False)

    @classmethod
    def on(cls, kind: Any, signal: str, n_sensors: int, sample_s: float) -> "VoterBlock":
        """Block of a kind of voter for a signal; a kind whose numbers depend on it has ``for_signal`` of the same arguments."""
        made = getattr(kind, "for_signal", None)
        return cls(kind() if made is None else made(signal, n_sensors, sample_s))

    def start(self, c: Nothing) -> Any:
        """Of the voter."""
        return self.voter.start() if self.keeps else c

    def step(self, x: Any, c: Nothing, n: Nothing, sensors: Rows, declared: Rows = None) -> tuple[Any, Row]:
        """State at the next sample, and the voted signal at this one.

        Of `declared` sensors, rows of 0 and 1, the vote is taken without them: the mean of those left. Where all are declared
        that says nothing about which to believe, and the vote is that of all; rows of zeros are None, bit for bit.
        """
        del c, n
        if self.is_told:
            after, voted = self.voter.step(x, sensors, declared)
        else:
            after, voted = self.voter.step(x, sensors) if self.keeps else (x, self.voter.vote(sensors))
            voted = voted if declared is None else mean_of_left(sensors, declared, voted)
        if np.shape(voted) != np.shape(sensors)[1:]:
            raise FddbenchError(
                f"the voter {type(self.voter).__name__} gives a signal of shape {np.shape(voted)}, needs (n_cases,): one row"
            )
        return after, voted
