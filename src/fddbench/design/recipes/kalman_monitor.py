"""The keys of a recipe that makes a `kalman_monitor`, and the filter that they give."""

from typing import Annotated, Any

import numpy as np
from pydantic import Field
from scipy.linalg import expm, solve_discrete_are

from fddbench.design.recipes.model_keys import ModelRecipe, channel_data
from fddbench.design.recipes.recipe import Made, short
from fddbench.errors import DesignError
from fddbench.interfaces import Floats

__all__ = ["KalmanMonitorRecipe"]

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]


class KalmanMonitorRecipe(ModelRecipe):
    """How the numbers of a `kalman_monitor` design come about: the steady Kalman filter of a model without parameters.

    Attributes
    ----------
    sample_s : float
        Clock [s]; inputs are held over a sample.
    output_noise : numbers, one per output
        Standard deviation of each sample, in the unit of the model.
    process_noise : numbers, one per state
        Spectral density of the white noise in each rate, in the unit of the state per root second.
    mean_s, confirm_s : float
        Copied into the gains [s].
    """

    sample_s: Positive
    output_noise: Annotated[tuple[Positive, ...], Field(min_length=1)]
    process_noise: Annotated[tuple[NonNegative, ...], Field(min_length=1)]
    mean_s: Positive
    confirm_s: NonNegative

    def make(self) -> Made:
        """Filter of the recipe, with the size of its innovations and its slowest pole."""
        model = self.affine()
        if len(model.A) > 1:
            raise DesignError(
                "recipe.model: a Kalman monitor is for one flight condition: give recipe.at, or a model of one matrix each"
            )
        n, n_u, n_y = model.A.shape[1], model.B.shape[2], len(model.C)
        if len(self.output_noise) != n_y or len(self.process_noise) != n:
            raise DesignError(
                f"recipe: needs {n_y} numbers output_noise and {n} process_noise, got {len(self.output_noise)} and "
                f"{len(self.process_noise)}"
            )
        A, B, Q = _sampled(model.A[0], model.B[0], np.diag(np.square(self.process_noise)), self.sample_s)
        R = np.diag(np.square(self.output_noise))
        K, S = _steady(A, model.C, Q, R)
        W = np.linalg.inv(np.linalg.cholesky(S))
        gains: dict[str, Any] = {
            "outputs": [channel_data(channel) for channel in model.outputs],
            "inputs": [channel_data(channel) for channel in model.inputs],
            "sample_s": self.sample_s,
            **{
                name: M.tolist() for name, M in (("A", A), ("B", B.reshape(n, n_u)), ("C", model.C), ("K", K), ("W", W))
            },
            "mean_s": self.mean_s,
            "thresholds": [1.0],
            "confirm_s": self.confirm_s,
        }
        slowest = float(np.abs(np.linalg.eigvals(A - K @ model.C)).max())
        found = {
            "innovation_std": [short(float(s)) for s in np.sqrt(np.diag(S))],
            "slowest_time_constant_s": short(-self.sample_s / float(np.log(slowest))),
        }
        return Made(gains=gains, found=found)


def _steady(A: Floats, C: Floats, Q: Floats, R: Floats) -> tuple[Floats, Floats]:
    """Gain of the predictor and covariance of its innovations."""
    try:
        P = solve_discrete_are(A.T, C.T, Q, R)
        S = C @ P @ C.T + R
        K = A @ P @ C.T @ np.linalg.inv(S)
        stable = float(np.abs(np.linalg.eigvals(A - K @ C)).max()) < 1.0 - 1e-9
    except (np.linalg.LinAlgError, ValueError):
        stable = False
    if not stable:
        raise DesignError(
            "there is no steady Kalman filter: unstable states must be seen by outputs and reached by process noise"
        )
    return K, S


def _sampled(A: Floats, B: Floats, Q: Floats, sample_s: float) -> tuple[Floats, Floats, Floats]:
    """Exact A, B of held inputs and covariance of the noise of one sample; Van Loan's way.

    Van Loan (1978), Computing integrals involving the matrix exponential, IEEE Transactions on Automatic Control 23(3).
    """
    n, n_u = B.shape
    held = expm(np.block([[A, B], [np.zeros((n_u, n + n_u))]]) * sample_s)
    noise = expm(np.block([[-A, Q], [np.zeros((n, n)), A.T]]) * sample_s)
    sampled: Floats = noise[n:, n:].T @ noise[:n, n:]
    return held[:n, :n], held[:n, n:], 0.5 * (sampled + sampled.T)
