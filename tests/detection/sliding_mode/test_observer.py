"""The sliding-mode observer: the printed gains, the injection it solves for, its DC gain and its stability."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from fddbench.blocks.layout import Nothing
from fddbench.detection.sliding_mode.observer import Observer
from fddbench.flight.lateral_lpv import lateral_lpv

DEG = 180.0 / np.pi
A_F, ERROR_POLES, KAPPA = 0.01, (-3.1, -3.2, -3.3, -3.4), 13.0 * 0.5 / 3.4 / 0.01
sample_times = st.sampled_from((0.001, 0.005, 0.01, 0.02, 0.04))
units = st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4)
# canonical order r | phi Vy p z_f, as positions in the published order phi Vy p r z_f
R, REST = 3, [0, 1, 2, 4]


def with_filter(table, first):
    """5 x 5 matrix of a 4 x 4 one with the filter state beneath; only the constant table has the filter's entries."""
    A = np.zeros((5, 5))
    A[:4, :4] = table
    if first:
        A[4, 3], A[4, 4] = A_F, -A_F
    return A


@pytest.mark.parametrize("j", range(5))
def test_literature_printed_linear_gain_follows_from_l(design, j):
    """``Gl_top = A12 - A11 L + L A22s`` and ``Gl_low = A22 - A21 L - A22s``, table by table, to 8e-5."""
    gains = design()
    A = with_filter(lateral_lpv().tables["A"][j, :, :, 0], j == 0)
    A11, A12, A21, A22 = A[R, R], A[R, REST], A[REST, R], A[np.ix_(REST, REST)]
    L, A22s = np.array(gains.l_row), np.diag(ERROR_POLES) * (j == 0)
    expected = np.zeros((5, 4))
    expected[R] = A12 - A11 * L + L @ A22s
    expected[REST] = A22 - np.outer(A21, L) - A22s
    np.testing.assert_allclose(np.array(gains.linear_gain[j]), expected, atol=8e-5)


def test_literature_numbers_of_the_published_design(design):
    gains = design()
    assert gains.error_pole_1_s == ERROR_POLES
    assert gains.k == (10.0, 10.0, 10.0, 13.0)
    assert gains.w == (-0.0413, 0.0005, 0.0, 100.0)
    assert (gains.delta, gains.filter_pole_1_s, gains.output_lag_s) == (0.01, A_F, 0.05)
    assert np.round(gains.l_row, 4).tolist() == pytest.approx([0.0355, 0.0277, 0.0, 0.0])
    assert design("off").w == (0.0, 0.0, 0.0, 0.0)
    shared = {"gn_convention", "w"}
    for name in ("off", "equation_19"):
        other = design(name)
        assert all(getattr(other, key) == getattr(gains, key) for key in type(gains).model_fields if key not in shared)


def test_literature_lyapunov_matrix_and_row_of_the_nonlinear_gain(design):
    published = Observer(design(), 0.01)
    np.testing.assert_allclose(published.p_o[:, 0], [0.1613, 0.1563, 0.1515, 0.1471], atol=5e-5)
    np.testing.assert_allclose(published.gn_r, [-0.071, -0.0554, 0.0001, 0.0], atol=5e-5)
    np.testing.assert_allclose(Observer(design("equation_19"), 0.01).gn_r, -np.array(design().l_row), rtol=1e-15)


def begun(observer, n_cases=1):
    return observer.states.spread(observer.start(Nothing()), n_cases)


def stepped(observer, state, *inputs):
    return observer.step(state, Nothing(), Nothing(), *inputs)[:2]


def injected(observer, predicted):
    return observer.injection.step(Nothing(), predicted)[1]


def residual(observer, predicted):
    """How far the injection is from solving its own equation, in units of its largest possible size."""
    nu = injected(observer, predicted)
    error = predicted + observer.sample_s * nu
    norm = np.sqrt(((observer.p_o * error) ** 2).sum(axis=0))
    return np.abs(nu + observer.k * observer.p_o * error / (norm + observer.gains.delta)).max()


@given(units, st.floats(-12.0, 6.0), sample_times, st.integers(3, 6))
def test_injection_solves_its_equation(design, direction, exponent, sample_s, steps):
    """To rounding error from four Newton steps on; the shipped three are as good up to 10 ms."""
    observer = Observer(design(newton_steps=steps), sample_s)
    predicted = np.array(direction)[:, np.newaxis] * 10.0**exponent
    limit = 1e-12 if steps > 3 or sample_s <= 0.01 else {0.02: 1e-11, 0.04: 1e-9}[sample_s]
    assert residual(observer, predicted) < limit


def test_injection_is_bounded_by_k_odd_and_zero_at_zero(design):
    observer = Observer(design(), 0.01)
    errors = np.random.default_rng(0).normal(size=(4, 500)) * 10.0 ** np.linspace(-9, 9, 500)
    nu = injected(observer, errors)
    assert (np.abs(nu) <= observer.k).all()
    assert (nu * errors <= 0.0).all()
    assert np.array_equal(injected(observer, -errors), -nu)
    assert not injected(observer, np.zeros((4, 1))).any()


def test_equal_gains_need_no_newton_step(design):
    """For K P_o all alike the start is the exact solution; so one step and twenty agree."""
    errors = np.random.default_rng(0).normal(size=(4, 200)) * 10.0 ** np.linspace(-6, 3, 200)
    alike = {"k": (6.2, 6.4, 6.6, 6.8)}
    one, many = (injected(Observer(design(newton_steps=n, **alike), 0.02), errors) for n in (1, 20))
    np.testing.assert_allclose(one, many, rtol=1e-12)


class ByHand:
    """The observer written again with matrices and a root finder, one flight at a time."""

    def __init__(self, gains, sample_s):
        self.g, self.T = gains, sample_s
        self.x, self.rate, self.z = np.zeros(5), np.zeros(5), 0.0
        self.P = np.diag([1 / (2 * abs(a)) for a in gains.error_pole_1_s])
        self.K = np.diag(gains.k)
        self.C = np.eye(5)[REST]
        factor = 2 if gains.gn_convention == "published" else 1
        self.Gn = np.zeros((5, 4))
        self.Gn[REST] = np.eye(4)
        self.Gn[R] = -factor * np.array(gains.l_row)

    def step(self, y, r, u, rho):
        model, g, T = lateral_lpv(), self.g, self.T
        weights = np.array([1.0, *rho])
        A = with_filter(np.tensordot(weights, model.tables["A"][..., 0], 1), True)
        A[4, 3], A[4, 4] = g.filter_pole_1_s, -g.filter_pole_1_s
        B = np.vstack([np.tensordot(weights, model.tables["B"][..., 0], 1), np.zeros(13)])
        Gl = np.tensordot(weights, np.array(g.linear_gain), 1)
        y_m = np.array([*y, self.z])
        x = self.x + T * self.rate
        e = self.C @ x - y_m

        def after(s):
            return np.linalg.solve(np.eye(4) + T * self.K @ self.P / (s + g.delta), e)

        q = np.linalg.norm(self.P @ e)
        s = brentq(lambda s: np.linalg.norm(self.P @ after(s)) - s, 0.0, q, xtol=1e-18, rtol=1e-15) if q else 0.0
        nu = -self.K @ self.P @ after(s) / (s + g.delta)
        self.x = x + T * self.Gn @ nu
        self.rate = A @ self.x + B @ u - Gl @ (self.C @ self.x - y_m)
        self.z += T * g.filter_pole_1_s * (r - self.z)
        return np.array(g.w) @ nu


@pytest.mark.parametrize("convention", ["published", "equation_19"])
@pytest.mark.parametrize("sample_s", [0.01, 0.02])
def test_agrees_with_the_observer_written_by_hand(design, convention, sample_s):
    gains = design(gn_convention=convention, newton_steps=5)
    observer, hand = Observer(gains, sample_s), ByHand(gains, sample_s)
    rng = np.random.default_rng(5)
    rho, state = rng.uniform(-1, 1, 4), begun(observer)
    y, r, u = np.zeros(3), 0.0, np.zeros(13)
    for _ in range(150):
        y, r, u = y + rng.normal(size=3) * [0.003, 0.3, 0.01], r + 0.005 * rng.normal(), u + 0.2 * rng.normal(size=13)
        state, found = stepped(observer, state, y[:, None], np.array([r]), u[:, None], rho[:, None])
        assert found[0] == pytest.approx(hand.step(y, r, u, rho), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("convention", ["published", "equation_19"])
def test_dc_gain_is_the_same_at_10_20_and_40_ms(design, convention):
    """A constant 1 deg/s on the voted rate of an aircraft at rest: ``kappa / (kappa + 3.4)``."""
    for sample_s in (0.01, 0.02, 0.04):
        observer = Observer(design(gn_convention=convention), sample_s)
        state, rest = begun(observer), (np.zeros((3, 1)), np.array([1 / DEG]), np.zeros((13, 1)), np.zeros((4, 1)))
        for _ in range(round(3.0 / sample_s)):
            state, raw = stepped(observer, state, *rest)
        assert raw[0] * DEG == pytest.approx(KAPPA / (KAPPA + 3.4), abs=2e-5)
        assert raw[0] * DEG == pytest.approx(0.9825, abs=1e-4)


@pytest.mark.parametrize("convention", ["published", "equation_19"])
@pytest.mark.parametrize("sample_s", [0.01, 0.02, 0.04])
def test_error_dynamics_are_stable_over_the_published_box(design, convention, sample_s):
    """Spectral radius of the step around rest; beside it the voted-rate filter's own ``1 - A_f T``."""
    observer = Observer(design(gn_convention=convention), sample_s)
    n, tiny = observer.states.size, 1e-9
    corners = np.array(np.meshgrid(*[(-1.0, 1.0)] * 4)).reshape(4, 16)
    for rho in corners.T:
        rest = (np.zeros((3, n)), np.zeros(n), np.zeros((13, n)), np.repeat(rho[:, None], n, axis=1))
        after, _ = stepped(observer, observer.states.unpack(tiny * np.eye(n)), *rest)
        poles = np.sort(np.abs(np.linalg.eigvals(observer.states.pack(after) / tiny)))
        assert poles[-1] == pytest.approx(1.0 - A_F * sample_s, abs=1e-8)
        assert poles[-2] < np.exp(-2.0 * sample_s)


@pytest.mark.parametrize("sample_s", [0.01, 0.02, 0.04])
def test_forgets_any_initial_error(design, sample_s):
    """Far from the origin too, where the injection is saturated."""
    observer = Observer(design(), sample_s)
    x = np.random.default_rng(2).normal(size=(5, 60)) * 10.0 ** np.linspace(-6, 3, 60)
    state = replace(begun(observer, 60), x=x)
    rest = (np.zeros((3, 60)), np.zeros(60), np.zeros((13, 60)), np.zeros((4, 60)))
    for _ in range(round(15.0 / sample_s)):
        state, _ = stepped(observer, state, *rest)
    assert np.abs(state.x).max() < 1e-6


def test_bits_do_not_depend_on_the_company(design):
    observer, rng = Observer(design(), 0.01), np.random.default_rng(1)
    state, inputs = rng.normal(size=(11, 7)), [rng.normal(size=s) for s in ((3, 7), (7,), (13, 7), (4, 7))]

    def packed(state, *inputs):
        after, found = stepped(observer, observer.states.unpack(state), *inputs)
        return observer.states.pack(after), found

    together, found = packed(state, *inputs)
    for i in range(7):
        alone, one = packed(state[:, [i]], *[x[..., [i]] for x in inputs])
        assert alone.tobytes() == np.ascontiguousarray(together[:, [i]]).tobytes()
        assert one[0] == found[i]
