"""The bias filter: a closed form, constant faults told apart, and what has no steady filter."""

import numpy as np
import pytest

from fddbench import kinds
from fddbench.design.bias_filter import bias_filter
from fddbench.design.weights import Weights
from fddbench.errors import DesignError
from fddbench.systems import UncertainPlant


def plant(**change):
    one, none = np.eye(1), np.zeros((1, 1))
    parts = {"A": -one, "Bf": none, "Bd": none, "B": none, "C": none, "Df": one, "Dd": one, "D": one}
    return UncertainPlant(**(parts | change))


@pytest.mark.parametrize(("walk", "noise"), [(0.3, 0.1), (1.0, 1.0)])
def test_a_bias_behind_noise_is_followed_with_the_ratio_of_walk_and_noise(walk, noise):
    """f' = q w, y = f + s d + u: Kalman and Bucy give f^' = (q / s) (y - f^ - u)."""
    found = bias_filter(plant(), Weights(W_f=[[walk]], W_d=[[noise]]))
    at = walk / noise
    assert [found.Ak[1, 1], found.Bky[1, 0], found.Bku[1, 0]] == pytest.approx([-at, at, -at])
    assert found.Ck.tolist() == [[0.0, 1.0]]


def test_constant_faults_and_inputs_of_the_jet_engine_are_told_apart_in_the_long_run():
    engine = UncertainPlant(**kinds.load("benchmark", "jet_engine").matrices)
    k = bias_filter(engine, Weights(W_f=0.4 * np.eye(3), W_d=0.6 * np.eye(3)))
    y_of_f = engine.Df - engine.C @ np.linalg.solve(engine.A, engine.Bf)
    y_of_u = engine.D - engine.C @ np.linalg.solve(engine.A, engine.B)
    r_of_y, r_of_u = (-k.Ck @ np.linalg.solve(k.Ak, B) for B in (k.Bky, k.Bku))
    np.testing.assert_allclose(r_of_y @ y_of_f, np.eye(3), atol=1e-9)
    np.testing.assert_allclose(r_of_y @ y_of_u + r_of_u, np.zeros((3, 3)), atol=1e-9)


def test_what_has_no_steady_filter_is_refused():
    with pytest.raises(DesignError, match="no steady Kalman filter of states and faults"):
        bias_filter(plant(Dd=np.zeros((1, 1))), Weights())
    with pytest.raises(DesignError, match="no steady Kalman filter of states and faults"):
        bias_filter(plant(Df=np.zeros((1, 1))), Weights())
