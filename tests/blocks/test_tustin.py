"""Law: Tustin as scipy does it; the inverse is one; bits do not depend on the company."""

import numpy as np
import pytest
from scipy.signal import cont2discrete

from fddbench.blocks.tustin import identity, inverse, times, tustin


@pytest.mark.parametrize("n", [1, 2, 3, 6, 9])
@pytest.mark.parametrize("sample_s", [0.1, 0.05, 0.01])
def test_is_the_bilinear_rule_of_scipy(n, sample_s):
    random = np.random.default_rng(n)
    A = random.standard_normal((n, n)) - 3.0 * np.eye(n)
    B, C, D = (random.standard_normal(shape) for shape in ((n, 4), (2, n), (2, 4)))
    ours = tustin(*(m[:, :, np.newaxis] for m in (A, B, C, D)), sample_s=sample_s)
    theirs = cont2discrete((A, B, C, D), sample_s, method="bilinear")
    for mine, other in zip(ours, theirs, strict=False):
        np.testing.assert_allclose(mine[:, :, 0], other, atol=1e-13)


def test_inverse_many_at_once():
    a = np.eye(4)[:, :, np.newaxis] + 0.2 * np.random.default_rng(0).standard_normal((4, 4, 50))
    whole = inverse(a)
    np.testing.assert_allclose(times(a, whole), np.broadcast_to(identity(4), a.shape), atol=1e-13)
    np.testing.assert_array_equal(inverse(a[:, :, 7:8].copy())[:, :, 0], whole[:, :, 7])


def test_systems_without_states():
    A, B, C, D = tustin(np.zeros((0, 0, 1)), np.zeros((0, 2, 1)), np.zeros((3, 0, 1)), np.ones((3, 2, 1)), sample_s=0.1)
    assert (A.size, B.size, C.size) == (0, 0, 0)
    np.testing.assert_array_equal(D, np.ones((3, 2, 1)))
