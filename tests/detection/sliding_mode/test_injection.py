"""The injections: each solves its own equation, keeps its bound, holds the error at zero and gives the fault back."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from fddbench.blocks.layout import Nothing
from fddbench.detection.sliding_mode.injection import Integral
from fddbench.detection.sliding_mode.observer import Observer

TWISTING = {"k1": (1.5, 1.5, 1.5, 0.3), "k2": (5.0, 5.0, 5.0, 0.2)}
KINDS = {"unit_vector": {}, "super_twisting": {"twisting": TWISTING}}
units = st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4)
sample_times = st.sampled_from((0.001, 0.01, 0.04))


def observer_of(design, kind, sample_s=0.01, **more):
    return Observer(design(injection=kind, **KINDS.get(kind, {}), **more), sample_s)


@given(units, st.floats(-9.0, 3.0), sample_times)
@settings(max_examples=40, deadline=None)
def test_the_unit_vector_solves_its_inclusion(design, direction, exponent, sample_s):
    """Either the error is zero after the sample and K^-1 nu lies in the ball, or nu is K times the unit vector."""
    observer = observer_of(design, "unit_vector", sample_s, newton_steps=6)
    predicted = np.array(direction)[:, np.newaxis] * 10.0**exponent
    nu = observer.injection.step(Nothing(), predicted)[1]
    weighted = observer.p_o * (predicted + sample_s * nu)
    length = np.linalg.norm(weighted)
    if length <= 1e-12 * np.linalg.norm(predicted):
        assert np.linalg.norm(nu / observer.k) <= 1.0 + 1e-12
    else:
        np.testing.assert_allclose(nu / observer.k, -weighted / length, atol=1e-9)


@given(units, units, st.floats(-9.0, 3.0), sample_times)
@settings(max_examples=40, deadline=None)
def test_the_super_twisting_solves_its_inclusion(design, direction, integral, exponent, sample_s):
    """``e = e* + T nu, nu = -k1 |e|^1/2 sgn(e) + z, z = z- - T k2 sgn(e)`` with sgn(0) any number of [-1, 1]."""
    observer = observer_of(design, "super_twisting", sample_s)
    k1, k2 = (np.array(TWISTING[name])[:, np.newaxis] for name in ("k1", "k2"))
    predicted = np.array(direction)[:, np.newaxis] * 10.0**exponent
    before = np.array(integral)[:, np.newaxis]
    after, nu = observer.injection.step(Integral(z=before), predicted)
    sign = (before - after.z) / (sample_s * k2)
    error = predicted + sample_s * nu
    scale = np.abs(predicted).max() + sample_s
    assert (np.abs(sign) <= 1.0 + 1e-9).all()
    clear = np.abs(error) > 1e-9 * scale
    np.testing.assert_allclose(sign[clear], np.sign(error[clear]), atol=1e-6)
    np.testing.assert_allclose(
        nu, -k1 * np.sqrt(np.abs(error)) * np.sign(error) + after.z, atol=1e-6 * scale / sample_s
    )


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("sample_s", [0.01, 0.04])
def test_a_steady_fault_comes_back_whole(design, kind, sample_s):
    """DC gain one, where the sigmoid has 0.9825; and the output error is held at zero."""
    observer = observer_of(design, kind, sample_s, gn_convention="equation_19")
    state = observer.states.spread(observer.start(Nothing()), 1)
    rest = (np.zeros((3, 1)), np.array([0.02]), np.zeros((13, 1)), np.zeros((4, 1)))
    for _ in range(round(6.0 / sample_s)):
        state, raw, inside = observer.step(state, Nothing(), Nothing(), *rest)
    assert raw[0] == pytest.approx(0.02, rel=2e-3)
    assert np.abs(inside.e_y).max() < 1e-9


def test_gains_of_the_twisting_come_with_it_and_only_with_it(design):
    with pytest.raises(ValidationError, match="super_twisting needs `twisting"):
        design(injection="super_twisting")
    with pytest.raises(ValidationError, match="super_twisting needs `twisting"):
        design(twisting=TWISTING)


def test_without_a_word_it_is_the_sigmoid(design):
    assert design().injection == "sigmoid"
    assert design().record_observer is False
