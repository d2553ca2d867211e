"""The keys of a recipe that makes an `unknown_input_observer`, and the gains that they give."""

from typing import Annotated, Any

import numpy as np
from pydantic import Field
from scipy.linalg import solve_discrete_are

from fddbench.design.recipes.recipe import Made, Recipe, short
from fddbench.design.unknown_input import decoupled
from fddbench.errors import DesignError
from fddbench.flight.lateral_lpv import lateral_lpv
from fddbench.interfaces import Floats
from fddbench.units import RAD_PER_DEG

__all__ = ["UnknownInputObserverRecipe"]

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
GUST = np.array([[0.0], [1.0], [0.0], [0.0]])
"""How the change of the gust enters the states phi, V_y, p, r: V_y is that against the air."""
_KEPT, _V_M_S = (0, 2, 3), 199.28
"""States that are observed, phi, p, r; true airspeed at the centre of the box [m/s]."""


class UnknownInputObserverRecipe(Recipe):
    """How the numbers of an `unknown_input_observer` design come about: steady gains of what the gust leaves.

    Attributes
    ----------
    sample_s : float
        Clock [s].
    phi_deg, beta_deg, p_deg_s, r_deg_s : float
        Standard deviation of each sample of these.
    roll_walk_deg_s2, yaw_walk_deg_s2 : float
        White noise in the accelerations [deg/s^2 per root hertz].
    decision : mapping
        Copied into the gains.
    """

    sample_s: Positive
    phi_deg: Positive
    beta_deg: Positive
    p_deg_s: Positive
    r_deg_s: Positive
    roll_walk_deg_s2: Positive
    yaw_walk_deg_s2: Positive
    decision: dict[str, float]

    def make(self) -> Made:
        """Gains at the centre of the box; existence and stability at its vertices."""
        A = self._kept(np.zeros(4))
        Q, R = self._noise(), np.diag(np.square([self.phi_deg, self.p_deg_s, self.r_deg_s])) * RAD_PER_DEG**2
        P = np.asarray(solve_discrete_are(A.T, np.eye(3), Q, R))
        S = P + R
        K = P @ np.linalg.inv(S)
        radius = max(
            float(np.abs(np.linalg.eigvals(self._kept(rho) @ (np.eye(3) - K))).max())
            for rho in lateral_lpv().vertices().T
        )
        if radius >= 1.0:
            raise DesignError(f"recipe: spectral radius {radius:.5f} at a vertex of the box, must be below 1")
        w = np.linalg.inv(np.linalg.cholesky(S))[2]
        gains: dict[str, Any] = {"sample_s": self.sample_s, "K": K.tolist(), "w": w.tolist(), **self.decision}
        sizes = [short(float(s / RAD_PER_DEG)) for s in np.sqrt(np.diag(S))]
        return Made(gains=gains, found={"innovation_std_deg": sizes, "largest_spectral_radius": short(radius)})

    def _kept(self, rho: Floats) -> Floats:
        """Transition of phi, p, r over one Euler step, as flown, with the gust taken out."""
        A = lateral_lpv().matrix("A", rho[:, np.newaxis])[..., 0]
        free = decoupled(
            A, np.zeros((4, 0)), np.eye(4), np.zeros((4, 0)), E_x=GUST, E_y=np.zeros((4, 1)), what="the gust"
        )
        rows: Floats = (free.T @ A)[np.ix_(_KEPT, _KEPT)]
        return np.eye(3) + self.sample_s * rows

    def _noise(self) -> Floats:
        """Covariance of one sample: walks of the accelerations, and what the noise of the sideslip makes of the moments."""
        walks = np.diag(np.square([0.0, self.roll_walk_deg_s2, self.yaw_walk_deg_s2])) * RAD_PER_DEG**2
        moments = lateral_lpv().matrix("A", np.zeros((4, 1)))[_KEPT, 1, 0] * self.beta_deg * RAD_PER_DEG * _V_M_S
        found: Floats = self.sample_s * walks + self.sample_s**2 * np.outer(moments, moments)
        return found
