"""Disconnection: a surface comes loose and floats to where the air puts it."""

from typing import ClassVar, Literal

import numpy as np

from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Layout, Rows, record
from fddbench.errors import FddbenchError
from fddbench.faults.profile import constants_of
from fddbench.faults.specification import FaultSpecification, Positive
from fddbench.interfaces import Floats, Instant, Site

__all__ = ["Disconnection"]


@record
class Lag:
    """Corner frequency of the lag [rad/s]."""

    rate_rad_s: Rows


@record
class Loose:
    """Where the sites stood at the sample before, in their unit."""

    position: Rows


class DisconnectionBlock:
    """``y[k] = f[k] + exp(-T / lag) (y[k-1] - f[k])``: exact for a floating position f that is held over the sample."""

    def __init__(self, n_sites: int, sample_s: float) -> None:
        self.sample_s = sample_s
        self.constants = constants_of(Lag, n_sites)
        self.states = Layout(Loose(position=n_sites))

    def start(self, c: Lag) -> Loose:
        """Not loose yet."""
        del c
        return Loose(position=0.0)

    def step(self, x: Loose, c: Lag, reading: Rows, now: Instant) -> tuple[Loose, Rows]:
        """What the sites show; at the onset they come from the last reading, which stands in `reading`.

        Raises
        ------
        FddbenchError
            The loop does not say where the sites float to.
        """
        if now.free is None:
            raise FddbenchError(
                "a disconnection needs the floating position of its sites: a loop with sites that say floats=True hands it "
                "to SignalFaults.step as free=rows, in the order of its sites"
            )
        decay_ratio = exp(-c.rate_rad_s * self.sample_s)
        before = np.where(now.since_samples == 0.0, reading, x.position)
        shown = now.free + decay_ratio * (before - now.free)
        return Loose(position=shown), shown


class Disconnection(FaultSpecification):
    """The site no longer follows its order: it goes with a first-order lag to the position at which it floats.

    The floating position is the aircraft's business (a share of the local angle of attack, say), so only sites that say
    `floats` may have it. It stands in place of the signal from its last reading on, like a freeze that gives way.

    Attributes
    ----------
    lag_s : float
        Time constant of the way there [s]; 0.1 s is our choice.
    """

    about: ClassVar[str] = "a surface that floats"

    kind: Literal["disconnection"]
    mode: Literal["replace"] = "replace"
    correlation: Literal["identical", "independent"] = "identical"
    freeze: Literal[True] = True
    lag_s: Positive = 0.1

    def numbers(self, site: Site, uniform: Floats) -> Lag:
        """Corner frequency of the lag."""
        del site, uniform
        return Lag(rate_rad_s=1.0 / self.lag_s)

    def unfit_on(self, site: Site) -> str:
        """Only what floats can come loose."""
        return "" if site.floats else "it does not float"

    @classmethod
    def block(cls, n_sites: int, sample_s: float) -> DisconnectionBlock:
        """What flies of it."""
        return DisconnectionBlock(n_sites, sample_s)
