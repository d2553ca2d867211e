"""Kalman filter of a linear plant whose faults are biases that walk: its innovations, turned into estimates of the faults."""

import numpy as np
from scipy.linalg import solve_continuous_are

from fddbench.design.problem import Filter
from fddbench.design.weights import Weights
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace, UncertainPlant

__all__ = ["bias_filter"]


def bias_filter(plant: UncertainPlant, weights: Weights) -> Filter:
    """``x̂' = A x̂ + Bf f̂ + B u + K e``, ``f̂' = L e``, ``e = y - C x̂ - Df f̂ - D u``; the residuals are f̂.

    K and L are those of Kalman and Bucy for faults that walk, ``f' = W_f w``, and white disturbances that enter states and
    outputs alike, ``Bd W_d`` and ``Dd W_d``. A disturbance of standard deviation s that is held for h is as white noise of
    ``W_d = s √h``. Only the sizes relative to one another matter: a larger W_f is faster and noisier. A bias filter is a
    filter without biases and an integrator of its innovations, each in the direction of one fault, so what is tested is the
    innovation, isolated as far as the directions differ. The uncertainty of the plant is not looked at.

    Parameters
    ----------
    plant : UncertainPlant
        With a disturbance on each output, and faults that stay apart when they are constant.
    weights : Weights
        W_f and W_d, constant.

    Raises
    ------
    DesignError
        There is no steady filter.

    References
    ----------
    Friedland (1969), Treatment of bias in recursive filtering, IEEE Transactions on Automatic Control 14(4), 359-367.
    Mehra, Peschon (1971), An innovations approach to fault detection and diagnosis in dynamic systems, Automatica 7(5),
    637-640.
    """
    W_f, W_d, _ = weights.systems(plant.inputs)
    to_fault, to_state, to_output = _constant("W_f", W_f), plant.Bd @ _constant("W_d", W_d), plant.Dd @ W_d.D
    n, n_f = plant.n_x, plant.inputs[0]
    A = np.block([[plant.A, plant.Bf], [np.zeros((n_f, n + n_f))]])
    C = np.hstack([plant.C, plant.Df])
    none = np.zeros((n, to_fault.shape[1]))
    noise = np.block([[to_state, none], [np.zeros((n_f, to_state.shape[1])), to_fault]])
    K = _gain(A, C, noise, np.hstack([to_output, np.zeros((len(C), to_fault.shape[1]))]))
    back = K @ plant.D
    B = np.vstack([plant.B, np.zeros((n_f, plant.inputs[2]))])
    none_y, none_u = np.zeros((n_f, len(C))), np.zeros((n_f, plant.inputs[2]))
    return Filter(
        Ak=A - K @ C, Bky=K, Bku=B - back, Ck=np.hstack([np.zeros((n_f, n)), np.eye(n_f)]), Dky=none_y, Dku=none_u
    )


def _constant(name: str, weight: StateSpace) -> Floats:
    if weight.order:
        raise DesignError(
            f"recipe.weights.{name}: white noise has constant weights here; give a number or a list of them"
        )
    return weight.D


def _gain(A: Floats, C: Floats, to_state: Floats, to_output: Floats) -> Floats:
    """Gain of Kalman and Bucy for noise that enters states and outputs; refuses plants without a steady filter."""
    R, N = to_output @ to_output.T, to_state @ to_output.T
    try:
        P = solve_continuous_are(A.T, C.T, to_state @ to_state.T, R, s=N)
        K = np.asarray(np.linalg.solve(R, (P @ C.T + N).T).T, dtype=np.float64)
        stable = bool(np.all(np.linalg.eigvals(A - K @ C).real < -1e-9))
    except (np.linalg.LinAlgError, ValueError):
        stable = False
    if not stable:
        raise DesignError(
            "there is no steady Kalman filter of states and faults: every output needs a disturbance of its own (Dd W_d of "
            "full row rank), every fault a walk (W_f), and constant faults must show in the outputs each in its own direction"
        )
    return K
