"""Laws of the sets that Δ is drawn from."""

import numpy as np
import pytest

from fddbench.benchmarks.jet_engine.plant import CONSTANTS, MATRICES, closed, constants
from fddbench.benchmarks.jet_engine.uncertainty import N_NORMALS, SETS
from fddbench.systems import UncertainPlant

NORMALS = np.random.default_rng(1).standard_normal((N_NORMALS, 20_000))


def singular_values(name):
    return np.linalg.svd(SETS[name](NORMALS).transpose(2, 0, 1), compute_uv=False)


@pytest.mark.parametrize("name", SETS)
def test_no_delta_is_larger_than_one(name):
    assert singular_values(name)[:, 0].max() <= 1.0 + 1e-14


def test_the_boundary_has_every_singular_value_one_and_both_orientations():
    assert np.abs(singular_values("boundary") - 1.0).max() < 1e-14
    sign = np.linalg.det(SETS["boundary"](NORMALS).transpose(2, 0, 1))
    assert 0.48 < np.mean(sign > 0.0) < 0.52


def test_the_ball_is_filled_uniformly():
    """Uniform in a ball of nine dimensions: the norm has the distribution function s^9."""
    s = np.sort(singular_values("norm_bounded")[:, 0])
    empirical = (np.arange(len(s)) + 0.5) / len(s)
    assert np.abs(s**9 - empirical).max() < 1.63 / np.sqrt(len(s))  # Kolmogorov, 1 %
    assert abs(np.mean(SETS["norm_bounded"](NORMALS))) < 0.005


def test_the_structured_set_is_diagonal_and_uniform():
    delta = SETS["structured"](NORMALS)
    for i in range(3):
        sorted_ = np.sort(delta[i, i])
        assert np.abs((sorted_ + 1.0) / 2.0 - np.linspace(0, 1, len(sorted_))).max() < 1.63 / np.sqrt(len(sorted_))
        assert not delta[i, (i + 1) % 3].any()


def test_the_printed_delta_is_that_of_equation_79():
    delta = SETS["equation_79"](NORMALS[:, :2])
    assert delta[:, :, 0].tolist() == delta[:, :, 1].tolist()
    assert (delta[0, 0, 0], delta[2, 2, 0]) == (0.4058, -0.2743)


@pytest.mark.parametrize("name", SETS)
def test_bits_do_not_depend_on_the_company(name):
    def packed(normals):
        return CONSTANTS.pack(constants(SETS[name](normals), 0.05))

    whole = packed(NORMALS[:, :300])
    for first, last in ((0, 1), (17, 18), (3, 12), (100, 300)):
        np.testing.assert_array_equal(packed(NORMALS[:, first:last].copy()), whole[:, first:last])


def test_closed_matrices_are_those_of_the_design():
    delta = SETS["norm_bounded"](NORMALS[:, :20])
    A, B, C, D = closed(delta)
    for i in range(20):
        plant = UncertainPlant(**MATRICES).at(delta[:, :, i])
        np.testing.assert_allclose(A[:, :, i], plant.A, atol=1e-14)
        np.testing.assert_allclose(B[:, :, i], np.hstack([plant.Bf, plant.Bd, plant.B]), atol=1e-14)
        np.testing.assert_allclose(C[:, :, i], plant.C, atol=1e-14)
        np.testing.assert_allclose(D[:, :, i], np.hstack([plant.Df, plant.Dd, plant.D]), atol=1e-14)
