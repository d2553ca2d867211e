"""The keys of a recipe that makes a `yaw_moment_parity`, and the parity vector that they give."""

from typing import Annotated

import numpy as np
from pydantic import Field

from fddbench.design.parity import best_parity_vector, parity_vectors
from fddbench.design.recipes.recipe import Made, Recipe, short

__all__ = ["YawMomentParityRecipe"]

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]


class YawMomentParityRecipe(Recipe):
    """How the numbers of a `yaw_moment_parity` design come about: the best parity vector of a window.

    Attributes
    ----------
    sample_s, block_s : float
        Clock, and what is averaged to one sample of the window [s].
    window_blocks : int
        Order of the parity relation.
    r_deg_s : float
        Standard deviation of a sample of a sensor [deg/s].
    yaw_walk_deg_s2 : float
        White noise in the yaw acceleration [deg/s^2 per root hertz].
    yaw_off_deg_s2 : float
        Standard deviation of a yaw acceleration that the model does not have and that lasts the window [deg/s^2].
    fault_age_s : float
        How long ago the step that it looks for was, in the mean [s].
    decision : mapping
        Copied into the gains.
    """

    sample_s: Positive
    block_s: Positive
    window_blocks: Annotated[int, Field(ge=1, le=200)]
    r_deg_s: Positive
    yaw_walk_deg_s2: NonNegative
    yaw_off_deg_s2: NonNegative
    fault_age_s: Positive
    decision: dict[str, float]

    def make(self) -> Made:
        """Parity vector that tells a step somewhere in the window best from noise; newest block first."""
        n = self.window_blocks + 1
        # what the yaw rate was before the window adds the same to every block: O is a column of ones
        vectors = parity_vectors(np.ones((n, 1)), np.zeros((n, 0)), "no disturbance")
        time_s = self.block_s * np.arange(n)
        walk = np.minimum.outer(time_s, time_s)
        noise = self.r_deg_s**2 * self.sample_s / self.block_s * np.eye(n) + self.yaw_walk_deg_s2**2 * walk
        noise = noise + self.yaw_off_deg_s2**2 * np.outer(time_s, time_s)
        steps = np.tril(np.ones((n, n)))  # column j: a unit step at block j, which is then so old:
        weight = np.exp(-time_s[::-1] / self.fault_age_s)
        v, ratio = best_parity_vector(vectors, steps * weight @ steps.T / weight.sum(), noise)
        gains = {"block_s": self.block_s, "v": v[::-1].tolist(), **self.decision}
        return Made(gains=gains, found={"step_over_noise": short(float(np.sqrt(ratio)))})
