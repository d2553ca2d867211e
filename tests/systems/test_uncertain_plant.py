"""Law: matrices that do not fit are named with both shapes, all at once; what is left out is zero."""

import numpy as np
import pytest

from fddbench.design.weights import Weights
from fddbench.errors import DesignError
from fddbench.systems import StateSpace, UncertainPlant


def parts(**changed):
    whole = {"A": -np.eye(2), "Bf": np.ones((2, 1)), "Bd": np.ones((2, 3)), "B": np.ones((2, 1)), "C": np.ones((1, 2))}
    whole |= {"Df": np.ones((1, 1)), "Dd": np.ones((1, 3)), "D": np.zeros((1, 1))}
    return whole | changed


def test_every_misfit_is_named_with_both_shapes():
    with pytest.raises(DesignError) as caught:
        UncertainPlant(**parts(Bf=np.ones((3, 1)), Dd=np.ones((1, 4))))
    assert "Bf (3, 1) has 3 rows but A (2, 2) has 2 states" in str(caught.value)
    assert "Dd (1, 4) has 4 columns but Bd (2, 3) has 3 disturbances" in str(caught.value)


def test_a_state_matrix_must_be_square():
    with pytest.raises(DesignError, match="A \\(2, 3\\) has 3 columns but A \\(2, 3\\) has 2 states"):
        StateSpace(np.ones((2, 3)), np.ones((2, 1)), np.ones((1, 2)), np.ones((1, 1)))


@pytest.mark.parametrize("wrong", [np.ones(2), np.full((2, 1), np.nan)])
def test_what_is_not_a_finite_matrix_is_refused(wrong):
    with pytest.raises(DesignError, match="Bf must be a finite matrix with two axes"):
        UncertainPlant(**parts(Bf=wrong))


def test_what_is_left_out_is_zero():
    plant = UncertainPlant(**parts(FA=np.ones((2, 2)), EA=np.ones((4, 2))))
    assert plant.FC.shape == (1, 2)
    assert plant.Ed.shape == (4, 3)
    assert plant.H.shape == (4, 2)
    assert not plant.H.any()
    assert UncertainPlant(**parts()).H.shape == (0, 0)


def test_a_plant_at_delta_is_equation_5():
    random = np.random.default_rng(0)
    draw = random.standard_normal
    plant = UncertainPlant(
        **parts(FA=draw((2, 2)), FC=draw((1, 2)), EA=draw((2, 2)), Ed=draw((2, 3)), H=0.1 * draw((2, 2)))
    )
    delta = 0.5 * draw((2, 2))
    delta_h = delta @ np.linalg.inv(np.eye(2) - plant.H @ delta)
    np.testing.assert_allclose(plant.at(delta).A, plant.A + plant.FA @ delta_h @ plant.EA)
    np.testing.assert_allclose(plant.at(delta).Dd, plant.Dd + plant.FC @ delta_h @ plant.Ed)
    np.testing.assert_allclose(plant.at(delta).Df, plant.Df)


def test_weights_are_checked():
    with pytest.raises(DesignError, match="W_d has D of shape \\(2, 2\\), need 3 rows: the plant has 3 disturbances"):
        Weights(W_d=np.eye(2)).systems((1, 3, 1))
    with pytest.raises(DesignError, match="W_u is unstable"):
        Weights(W_u=StateSpace.diagonal([1.0], [1.0], [1.0], [1.0])).systems((1, 3, 1))
