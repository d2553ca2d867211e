"""Law: Tustin as SciPy has it, one order of sums; the engine and the filter that fly are this system, bit for bit."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.signal import cont2discrete

from fddbench import gallery
from fddbench.benchmarks.jet_engine import plant
from fddbench.benchmarks.jet_engine.uncertainty import SETS
from fddbench.blocks.interpreter import Interpreter
from fddbench.blocks.linear import column, product
from fddbench.blocks.program import trace
from fddbench.campaign.designs import read_design
from fddbench.detection.hinf_filter import HinfFilter
from fddbench.interfaces import Bus
from fddbench.systems import DiscreteLti, MisfitError, StateSpace


def system(seed: int = 0, n_x: int = 3, n_u: int = 2, n_y: int = 2) -> StateSpace:
    draw = np.random.default_rng(seed).standard_normal
    return StateSpace(draw((n_x, n_x)) - 3.0 * np.eye(n_x), draw((n_x, n_u)), draw((n_y, n_x)), draw((n_y, n_u)))


def test_tustin_is_that_of_scipy_and_bends_the_frequency_axis():
    G, T = system(), 0.05
    found = DiscreteLti.of(G, T)
    for name, expected in zip("ABCD", cont2discrete((G.A, G.B, G.C, G.D), T, method="bilinear")[:4], strict=True):
        np.testing.assert_allclose(getattr(found, name)[:, :, 0], expected, rtol=1e-12, atol=1e-14)
    z, bent = np.exp(1j * 7.0 * T), 2.0 / T * np.tan(7.0 * T / 2.0)
    response = found.C[:, :, 0] @ np.linalg.solve(z * np.eye(3) - found.A[:, :, 0], found.B[:, :, 0]) + found.D[:, :, 0]
    np.testing.assert_allclose(response, G.at(bent), rtol=1e-10)


def test_the_jet_engine_is_one_bit_for_bit():
    random = np.random.default_rng(1)
    delta, x, v = (
        SETS["norm_bounded"](random.standard_normal((24, 7))),
        random.standard_normal((3, 7)),
        random.standard_normal((9, 7)),
    )
    rows = plant.constants(delta, 0.05)
    engine = DiscreteLti.tustin(*plant.closed(delta), sample_s=0.05)
    np.testing.assert_array_equal(plant.CONSTANTS.pack(**engine.rows()), rows)
    c = plant.CONSTANTS.unpack(rows)
    again = DiscreteLti.from_rows(c.A, c.B, c.C, c.D, n_states=3, n_outputs=3, sample_s=0.05)
    for name in "ABCD":
        np.testing.assert_array_equal(getattr(again, name), getattr(engine, name))
    for found, expected in zip(again.step(x, v), plant.step(x, c, v), strict=True):
        np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("name", ["hinf_identity", "hinf_start"])
def test_the_filter_that_flies_is_one_bit_for_bit(name):
    gains = read_design(gallery.folder("detectors") / f"{name}.yaml").gains
    bus = Bus(sample_s=0.05, sites=("f1", "f2", "f3"), signals={"y": 3, "u": 3})
    flown = HinfFilter.from_design(gains, bus)
    g = {key: np.array(getattr(gains, key)) for key in ("A", "B_y", "B_u", "C", "D_y", "D_u")}
    filter_ = DiscreteLti.of(
        StateSpace(g["A"], np.hstack([g["B_y"], g["B_u"]]), g["C"], np.hstack([g["D_y"], g["D_u"]])), 0.05
    )
    random, state, x = np.random.default_rng(2), flown.start(5), filter_.start(5)
    n_window = flown.window * flown.n_residuals
    for _ in range(20):
        y, u = random.standard_normal((2, 3, 5))
        state, _ = flown.step(state, SimpleNamespace(y=y, u=u))
        x, r = filter_.step(x, np.concatenate([y, u]))
        np.testing.assert_array_equal(state[: filter_.order], x)
        np.testing.assert_array_equal(state[filter_.order : filter_.order + n_window][: flown.n_residuals], r)


def test_the_bits_do_not_depend_on_the_company_and_survive_tracing():
    random = np.random.default_rng(3)
    per_case = [np.concatenate([column(getattr(system(seed), name)) for seed in range(4)], axis=2) for name in "ABCD"]
    found = DiscreteLti.tustin(*per_case, sample_s=0.1)
    x, u = random.standard_normal((3, 4)), random.standard_normal((2, 4))
    after, y = found.step(x, u)
    for case in range(4):
        alone = DiscreteLti.of(system(case), 0.1)
        np.testing.assert_array_equal(alone.step(x[:, [case]], u[:, [case]])[0], after[:, [case]])
        np.testing.assert_array_equal(alone.step(x[:, [case]], u[:, [case]])[1], y[:, [case]])

    def step(x, u, A, B, C, D):
        own = DiscreteLti.from_rows(A, B, C, D, n_states=3, n_outputs=2, sample_s=0.1)
        after, y = own.step(x, u)
        return {"after": after, "y": y}

    rows = found.rows()
    program = trace(step, x=3, u=2, **{name: len(rows[name]) for name in "ABCD"})
    flown = Interpreter(program).run(x=x, u=u, **rows)
    np.testing.assert_array_equal(flown["after"], after)
    np.testing.assert_array_equal(flown["y"], y)


def test_a_gain_has_no_state():
    gain = DiscreteLti.of(StateSpace.gain([[2.0, 1.0]]), 0.1)
    after, y = gain.step(gain.start(3), np.ones((2, 3)))
    assert after.shape == (0, 3)
    np.testing.assert_array_equal(y, np.full((1, 3), 3.0))
    np.testing.assert_array_equal(y, product(gain.D, np.ones((2, 3))))


def test_what_does_not_fit_is_named():
    A = np.zeros((2, 2, 1))
    with pytest.raises(MisfitError, match=r"B \(3, 1, 1\) has 3 rows but A \(2, 2, 1\) has 2 states"):
        DiscreteLti(A=A, B=np.zeros((3, 1, 1)), C=np.zeros((1, 2, 1)), D=np.zeros((1, 1, 1)), sample_s=0.1)
    with pytest.raises(MisfitError, match=r"A needs three axes, \(rows, columns, cases\), got shape \(2, 2\)"):
        DiscreteLti(A=A[:, :, 0], B=A, C=A, D=A, sample_s=0.1)
