"""The detectability is that of the generalised matched filter, and no test does better than its power says."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import norm

from fddbench.errors import FddbenchError
from fddbench.interfaces import IdealModel
from fddbench.metrics.bound import MOST_D, Faults, detectability, power

N_TIME = 6


def model(seed, n=3, n_y=4, **more):
    """A random stable model of one flight, with a fault on output 1 and one that enters the state."""
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(n, n))
    A *= 0.9 / np.abs(np.linalg.eigvals(A)).max()
    half = rng.normal(size=(n, n))
    numbers = {
        "A": A,
        "C": rng.normal(size=(n_y, n)),
        "Q": 0.1 * half @ half.T,
        "R": np.diag(rng.uniform(0.1, 1.0, n_y)),
    }
    given = {name: value[np.newaxis] for name, value in numbers.items()}
    enters = rng.normal(size=(1, n))
    return IdealModel(
        about="", **given, start=np.eye(n)[np.newaxis], outputs={"a": 1, "b": 2}, states={"c": enters}, **more
    )


def stacked(m, added, before):
    """Δ and S of all samples at once, measurements before the fault included, without any filter."""
    A, C, Q, R, P = (M[0] for M in (m.A, m.C, m.Q, m.R, m.start))
    n, n_y, steps = len(A), len(C), before + N_TIME
    powers = [np.linalg.matrix_power(A, k) for k in range(steps)]
    state = np.zeros((steps * n, steps * n))  # covariance of all states
    for i in range(steps):
        for j in range(steps):
            here = powers[i] @ P @ powers[j].T
            here = here + sum((powers[i - s] @ Q @ powers[j - s].T for s in range(1, min(i, j) + 1)), np.zeros((n, n)))
            state[i * n : (i + 1) * n, j * n : (j + 1) * n] = here
    seen = np.kron(np.eye(steps), C)
    S = seen @ state @ seen.T + np.kron(np.eye(steps), R)
    x, delta = np.zeros(n), np.zeros((steps, n_y))
    for k in range(N_TIME):
        delta[before + k] = C @ x
        x = A @ x
        for site, values in added.items():
            if site in m.outputs:
                delta[before + k, m.outputs[site]] += values[k, 0]
            else:
                x = x + m.states[site][0] * values[k, 0]
    return delta.ravel(), S


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 1000), st.integers(0, 3), st.sampled_from(["a", "b", "c", "ac"]))
def test_it_is_the_generalised_matched_filter(seed, before, sites):
    m, rng = model(seed), np.random.default_rng(seed + 1)
    added = {site: rng.normal(size=(N_TIME, 1)) for site in sites}
    d, nearest = detectability(m, Faults(added=added, before=np.array([float(before)])))
    delta, S = stacked(m, added, before)
    assert d[0] == pytest.approx(np.sqrt(delta @ np.linalg.solve(S, delta)), rel=1e-9)
    assert nearest[0] == d[0]  # nothing else measures the same


def test_the_mirrored_fault_is_what_is_told_apart_by_the_model_alone():
    """Of three sensors that measure one state two are off by f; that the third is off by -f looks the same but for 3 f."""
    grouped = model(3, together=(("a", "b"),))
    added = {"a": np.ones((N_TIME, 1))}
    d, nearest = detectability(grouped, Faults(added=added, before=np.zeros(1)))
    both, _ = detectability(
        grouped, Faults(added={"a": np.ones((N_TIME, 1)), "b": np.ones((N_TIME, 1))}, before=np.zeros(1))
    )
    assert nearest[0] == min(d[0], both[0])


def test_flights_do_not_see_each_other_and_large_faults_end_the_sum():
    one, two = model(1), model(2)
    both = IdealModel(
        about="", outputs=one.outputs, states={"c": np.concatenate([one.states["c"], two.states["c"]])},
        **{name: np.concatenate([getattr(m, name) for m in (one, two)]) for name in ("A", "C", "Q", "R", "start")},
    )  # fmt: skip
    added, before = np.array([[1.0, 3.0]] * N_TIME), np.array([0.0, 2.0])
    together = detectability(both, Faults(added={"a": added}, before=before))[0]
    alone = [
        detectability(m, Faults(added={"a": added[:, i : i + 1]}, before=before[i : i + 1]))[0][0]
        for i, m in enumerate((one, two))
    ]
    np.testing.assert_allclose(together, alone, rtol=1e-9)
    assert detectability(one, Faults(added={"a": np.full((N_TIME, 1), 1e6)}, before=np.zeros(1)))[0] == MOST_D


@settings(max_examples=10, deadline=None)
@given(st.floats(0.0, 8.0), st.floats(1e-9, 0.5))
def test_power_is_that_of_a_threshold_on_the_matched_filter(d, p_fa):
    threshold = norm.isf(p_fa)  # of a normal number with mean 0 or d
    assert power(d, p_fa) == pytest.approx(norm.sf(threshold - d), abs=1e-12)


@pytest.mark.parametrize("p_fa", [0.0, 1.0, -1.0])
def test_a_probability_is_between_0_and_1(p_fa):
    with pytest.raises(FddbenchError, match="above 0 and below 1"):
        power(1.0, p_fa)
