"""Law: connected systems answer every frequency as the formulas of their responses say; what does not fit is named."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.systems import MisfitError, StateSpace, append, feedback, lower_lft, series, star, upper_lft

FREQUENCIES = (0.0, 0.3, 2.0, 40.0, np.inf)
orders, signals, seeds = st.integers(0, 3), st.integers(0, 3), st.integers(0, 10**6)


def draw(seed: int, order: int, inputs: int, outputs: int, gain: float = 1.0) -> StateSpace:
    random = np.random.default_rng(seed)
    A = random.standard_normal((order, order)) - 3.0 * np.eye(order)
    B, C, D = (random.standard_normal(shape) for shape in ((order, inputs), (outputs, order), (outputs, inputs)))
    return StateSpace(A, B, gain * C, gain * D)


def equal(system: StateSpace, response) -> None:
    for w in FREQUENCIES:
        np.testing.assert_allclose(system.at(w), response(w), rtol=1e-9, atol=1e-9)


@given(seeds, orders, orders, signals, signals, signals)
@settings(max_examples=40, deadline=None)
def test_series_multiplies_in_the_order_of_the_flow(seed, n1, n2, u, m, y):
    first, second = draw(seed, n1, u, m), draw(seed + 1, n2, m, y)
    whole = series(first, second)
    equal(whole, lambda w: second.at(w) @ first.at(w))
    assert whole.order == n1 + n2
    np.testing.assert_array_equal(whole.A[:n1, :n1], first.A)


def test_series_takes_any_number():
    lag = StateSpace.diagonal([-1.0], [1.0], [1.0], [0.0])
    equal(series(lag, lag, lag), lambda w: lag.at(w) ** 3)
    assert series(lag) is lag


@given(seeds, orders, orders, signals, signals, signals, signals)
@settings(max_examples=40, deadline=None)
def test_append_keeps_apart(seed, n1, n2, u1, y1, u2, y2):
    a, b = draw(seed, n1, u1, y1), draw(seed + 1, n2, u2, y2)
    whole = append(a, b)
    for w in FREQUENCIES:
        response = whole.at(w)
        np.testing.assert_allclose(response[:y1, :u1], a.at(w), atol=1e-12)
        np.testing.assert_allclose(response[y1:, u1:], b.at(w), atol=1e-12)
        assert not response[:y1, u1:].any()
        assert not response[y1:, :u1].any()


def test_append_of_nothing_has_no_signals():
    assert append().D.shape == (0, 0)
    assert append().order == 0


@given(seeds, orders, orders, st.integers(1, 3), st.integers(1, 3), st.sampled_from([-1.0, 1.0]))
@settings(max_examples=40, deadline=None)
def test_feedback_divides(seed, n1, n2, u, y, sign):
    G, K = draw(seed, n1, u, y, 0.2), draw(seed + 1, n2, y, u, 0.2)
    equal(feedback(G, K, sign=sign), lambda w: np.linalg.solve(np.eye(y) - sign * G.at(w) @ K.at(w), G.at(w)))


def test_feedback_is_negative():
    integrator = StateSpace(np.zeros((1, 1)), np.ones((1, 1)), np.ones((1, 1)), np.zeros((1, 1)))
    np.testing.assert_allclose(feedback(integrator, StateSpace.gain(2.0)).poles(), [-2.0])


def split(M: np.ndarray, rows: int, columns: int):
    return M[:rows, :columns], M[:rows, columns:], M[rows:, :columns], M[rows:, columns:]


@given(seeds, orders, orders, st.tuples(signals, signals, signals, signals))
@settings(max_examples=40, deadline=None)
def test_a_lower_lft_closes_the_last_signals_and_an_upper_one_the_first(seed, n1, n2, sizes):
    w_, u, z, y = sizes
    P, K = draw(seed, n1, w_ + u, z + y), draw(seed + 1, n2, y, u, 0.05)

    def lower(w):
        zw, zu, yw, yu = split(P.at(w), z, w_)
        return zw + zu @ K.at(w) @ np.linalg.solve(np.eye(y) - yu @ K.at(w), yw)

    equal(lower_lft(P, K), lower)
    turned = StateSpace(P.A, np.roll(P.B, u, axis=1), np.roll(P.C, y, axis=0), np.roll(P.D, (y, u), axis=(0, 1)))
    equal(upper_lft(turned, K), lower)


@given(seeds, st.tuples(signals, signals, signals, signals, signals, signals))
@settings(max_examples=40, deadline=None)
def test_a_star_product_of_three_is_the_same_from_both_ends(seed, sizes):
    w_, z, v, y, d, e = sizes
    P, Q = draw(seed, 2, w_ + v, z + y, 0.3), draw(seed + 1, 2, y + d, v + e, 0.3)
    R = draw(seed + 2, 2, e, d, 0.1)
    equal(lower_lft(star(P, Q, y, v), R), lower_lft(P, lower_lft(Q, R)).at)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: series(draw(0, 1, 2, 3), draw(0, 1, 2, 1)),
            "series: system 2 has 2 inputs but the one before has 3 outp",
        ),
        (lambda: feedback(draw(0, 1, 2, 3), draw(0, 1, 2, 2)), "in the return has 2 inputs but forward has 3 outputs"),
        (lambda: feedback(draw(0, 1, 2, 3), draw(0, 1, 3, 3)), "in the return has 3 outputs but forward has 2 inputs"),
        (lambda: lower_lft(draw(0, 1, 2, 1), draw(0, 0, 2, 1)), "2 signals .* the upper system has 1 outputs"),
        (lambda: upper_lft(draw(0, 1, 1, 2), draw(0, 0, 2, 2)), "2 signals .* the upper system has 1 inputs"),
        (lambda: star(draw(0, 1, 3, 3), draw(0, 1, 1, 3), 2, 1), "2 signals .* the lower system has 1 inputs"),
        (lambda: feedback(StateSpace.gain(1.0), StateSpace.gain(1.0), sign=1.0), "the loop is ill-posed"),
    ],
)
def test_what_does_not_fit_is_refused_with_the_numbers(call, message):
    with pytest.raises(MisfitError, match=message):
        call()
