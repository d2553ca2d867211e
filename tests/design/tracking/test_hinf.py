"""H∞ synthesis, where SLICOT is; what does not need it, everywhere."""

import builtins

import numpy as np
import pytest

from fddbench.design.tracking import hinf
from fddbench.errors import DesignError
from fddbench.systems import StateSpace


def test_without_slycot_the_error_says_how_to_get_it(monkeypatch):
    real = builtins.__import__

    def without(name, *args, **kwargs):
        if name in {"control", "slycot"}:
            raise ImportError(name=name)
        return real(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(
        DesignError, match=r"control is not installed. Install both with `pip install 'fddbench\[synthesis\]'`"
    ):
        hinf.synthesize(StateSpace.gain(np.eye(2)))


def test_the_slow_part_keeps_the_response_below_the_fast_modes():
    random = np.random.default_rng(1)
    slow = np.diag([-0.1, -1.0, -3.0]) + np.triu(random.standard_normal((3, 3)), 1)
    A = np.block([[slow, random.standard_normal((3, 2))], [random.standard_normal((2, 3)), np.diag([-1e6, -3e7])]])
    whole = StateSpace(
        A, random.standard_normal((5, 2)) * [[1], [1], [1], [1e6], [1e7]], random.standard_normal((2, 5)), np.eye(2)
    )
    kept = hinf.slow_part(whole, 100.0)
    assert kept.order == 3
    for w in (0.0, 0.5, 5.0):
        np.testing.assert_allclose(kept.at(w), whole.at(w), rtol=1e-3)


def test_a_law_is_its_controller_with_integrals_and_sums():
    random = np.random.default_rng(2)
    K = StateSpace(*(random.standard_normal(shape) for shape in ((3, 3), (3, 9), (2, 3), (2, 9))))
    law = hinf.as_law(K)
    again = hinf.controller_of(law)
    for name in "ABCD":
        np.testing.assert_allclose(getattr(again, name), getattr(K, name), atol=1e-12)
    # errors and measurements of one moment give the orders that commands, integrals and measurements give
    s, command, path, speed = 0.7j, np.array([2.0, 5.0]), 0.3, -1.2
    measured = np.array([path, 0.1, 0.2, 0.4, speed])
    errors = command - [path, speed]
    by_law = law.at(0.7) @ np.concatenate([errors, measured])
    np.testing.assert_allclose(by_law, K.at(0.7) @ np.concatenate([command, errors / s, measured]))
