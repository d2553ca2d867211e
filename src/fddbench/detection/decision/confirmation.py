"""Suspicions that stand long enough become declarations, for good."""

from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.blocks.primitives import rarely
from fddbench.detection.confirmation import held_samples, samples

__all__ = ["Confirmation", "ConfirmationState"]


@record
class ConfirmationState:
    """For how many samples each site has been suspected, and 1 where it is declared, (n_sites, n_cases) each."""

    held_samples: Rows
    declared: Rows


class Confirmation:
    """Declares a site, for good, that has been suspected for a time without a break.

    Parameters
    ----------
    confirm_s : float
        How long a suspicion must stand [s]; one that is true at samples k0 to k has stood for k - k0 samples.
    sample_s : float
        Sample time [s].
    n_sites : int
        Sites, each by itself.

    Raises
    ------
    DesignError
        The time does not fit the clock.
    """

    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, confirm_s: float, *, sample_s: float, n_sites: int) -> None:
        self.confirm_samples = samples("confirm_s", confirm_s, sample_s)
        self.states = Layout(ConfirmationState(held_samples=n_sites, declared=n_sites))

    def start(self, c: Nothing) -> ConfirmationState:
        """Nothing suspected."""
        del c
        return ConfirmationState(held_samples=0.0, declared=0.0)

    def step(self, x: ConfirmationState, c: Nothing, n: Nothing, suspected: Rows) -> tuple[ConfirmationState, Rows]:
        """State, and the declared sites as 1 or 0, (n_sites, n_cases), of suspicions that are true or false."""
        del c, n
        held = held_samples(x.held_samples, suspected)
        declared = np.where(rarely(held - 1.0 >= self.confirm_samples), 1.0, x.declared)
        return ConfirmationState(held_samples=held, declared=declared), declared
