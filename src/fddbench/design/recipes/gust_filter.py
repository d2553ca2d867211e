"""The keys of recipes that need a lateral Kalman filter with a gust state, and the steady gains that they give."""

from typing import Annotated, Any

import numpy as np
from pydantic import Field
from scipy.linalg import solve_discrete_are

from fddbench.campaign.rules.model import Strict
from fddbench.design.recipes.recipe import Made, Recipe, short
from fddbench.errors import DesignError
from fddbench.flight.lateral_lpv import lateral_lpv
from fddbench.flight.turbulence import SCALE_LENGTH_M
from fddbench.interfaces import Floats
from fddbench.units import RAD_PER_DEG

__all__ = ["GustFilterEntry", "KalmanGustRecipe"]

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
C = np.eye(4, 6)
"""Outputs phi, V_y, p, r of the states phi, V_y, p, r, gust, yaw acceleration off the model."""
_V_M_S = 199.28
"""True airspeed at the centre of the box [m/s]."""


class GustFilterEntry(Strict):
    """What the filter believes of sensors and air.

    Attributes
    ----------
    sample_s : float
        Clock [s].
    phi_deg, beta_deg, p_deg_s, r_deg_s : float
        Standard deviation of each sample of these.
    gust_m_s : float
        Standard deviation of the gust [m/s]; its time constant is the scale length of MIL-F-8785C over the airspeed.
    roll_walk_deg_s2, yaw_walk_deg_s2 : float
        White noise in the accelerations [deg/s^2 per root hertz]: what the moments are off the model at short notice.
    yaw_drift_deg_s3 : float
        White noise in the change of the yaw acceleration that is off the model [deg/s^3 per root hertz].
    """

    sample_s: Positive
    phi_deg: Positive
    beta_deg: Positive
    p_deg_s: Positive
    r_deg_s: Positive
    gust_m_s: Positive
    roll_walk_deg_s2: Positive
    yaw_walk_deg_s2: Positive
    yaw_drift_deg_s3: Positive

    def gains(self) -> tuple[dict[str, Any], dict[str, Any]]:
        """Gains of a `GustFilter` at the centre of the box, and what is known of them over its vertices."""
        gust_time_s = SCALE_LENGTH_M / _V_M_S
        A, Q = _sampled(_model(np.zeros(4), gust_time_s), self._noise(gust_time_s), self.sample_s)
        R = np.diag(np.square([self.phi_deg * RAD_PER_DEG, self.beta_deg * RAD_PER_DEG * _V_M_S, self.p_deg_s * RAD_PER_DEG,
                               self.r_deg_s * RAD_PER_DEG]))  # fmt: skip
        P = np.asarray(solve_discrete_are(A.T, C.T, Q, R))
        K = P @ C[:3].T @ np.linalg.inv(C[:3] @ P @ C[:3].T + R[:3, :3])
        left = P - K @ C[:3] @ P
        k_r = left[:, 3] / (left[3, 3] + R[3, 3])
        S = C @ P @ C.T + R
        gains = {
            "sample_s": self.sample_s,
            "gust_time_s": short(gust_time_s),
            "K": K.tolist(),
            "k_r": k_r.tolist(),
            "W": np.linalg.inv(np.linalg.cholesky(S)).tolist(),
        }
        return gains, self._found(K, k_r, S, gust_time_s)

    def _noise(self, gust_time_s: float) -> Floats:
        """Spectral densities of the six rates; a change of the gust moves V_y the other way."""
        Q = np.diag([0.0, 0.0, self.roll_walk_deg_s2, self.yaw_walk_deg_s2, 0.0, self.yaw_drift_deg_s3]) * RAD_PER_DEG
        gust = self.gust_m_s * np.sqrt(2.0 / gust_time_s) * np.array([0.0, -1.0, 0.0, 0.0, 1.0, 0.0])
        found: Floats = Q @ Q + np.outer(gust, gust)
        return found

    def _found(self, K: Floats, k_r: Floats, S: Floats, gust_time_s: float) -> dict[str, Any]:
        """Slowest poles with the yaw rate and coasting, at the worst vertex; size of the innovations."""
        coasting = np.eye(6) - K @ C[:3]
        after = {"filter": (np.eye(6) - np.outer(k_r, C[3])) @ coasting, "coasting": coasting}
        radius = dict.fromkeys(after, 0.0)
        for rho in lateral_lpv().vertices().T:
            A = np.eye(6) + self.sample_s * _model(rho, gust_time_s)
            for name, M in after.items():
                radius[name] = max(radius[name], float(np.abs(np.linalg.eigvals(A @ M)).max()))
        if radius["filter"] >= 1.0:
            raise DesignError(
                f"recipe.filter: spectral radius {radius['filter']:.5f} at a vertex of the box, must be below 1: "
                "steady gains of the centre do not reach that far. Take less noise off the sensors"
            )
        sizes = np.sqrt(np.diag(S)) / np.array([RAD_PER_DEG, RAD_PER_DEG * _V_M_S, RAD_PER_DEG, RAD_PER_DEG])
        return {
            "innovation_std_deg": [short(float(s)) for s in sizes],
            "largest_spectral_radius": short(radius["filter"]),
            "largest_spectral_radius_coasting": short(radius["coasting"]),
        }


def _model(rho: Floats, gust_time_s: float) -> Floats:
    """Rates of the six states, continuous time."""
    A = np.zeros((6, 6))
    A[:4, :4] = lateral_lpv().matrix("A", rho[:, np.newaxis])[..., 0]
    A[1, 4], A[4, 4], A[3, 5] = 1.0 / gust_time_s, -1.0 / gust_time_s, 1.0
    return A


def _sampled(A: Floats, Q: Floats, sample_s: float) -> tuple[Floats, Floats]:
    """Transition of one Euler step, as flown, and the covariance of the noise of one sample."""
    return np.eye(len(A)) + sample_s * A, sample_s * Q


class KalmanGustRecipe(Recipe):
    """How the numbers of a `kalman_gust` design come about.

    Attributes
    ----------
    filter : GustFilterEntry
        What the filter believes.
    decision : mapping
        Copied into the gains.
    """

    filter: GustFilterEntry
    decision: dict[str, float]

    def make(self) -> Made:
        """Steady gains."""
        gains, found = self.filter.gains()
        return Made(gains={"filter": gains, **self.decision}, found=found)


class ObserverBankRecipe(KalmanGustRecipe):
    """How the numbers of an `observer_bank` design come about."""


class MultipleModelRecipe(KalmanGustRecipe):
    """How the numbers of a `multiple_model` design come about."""
