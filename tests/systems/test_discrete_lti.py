"""Law: Tustin as SciPy has it, one order of sums, the same bits in any company, compiled or not."""

import numpy as np
import pytest
from scipy.signal import cont2discrete

from fddbench.benchmarks.jet_engine import plant
from fddbench.benchmarks.jet_engine.uncertainty import SETS
from fddbench.blocks.interpreter import Interpreter
from fddbench.blocks.linear import column, product
from fddbench.blocks.program import trace
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


def test_constants_of_a_flight_are_read_back_bit_for_bit():
    delta = SETS["norm_bounded"](np.random.default_rng(1).standard_normal((24, 7)))
    made = DiscreteLti.tustin(*plant.closed(delta), sample_s=0.05)
    again = plant.engine(plant.constants(delta, 0.05), 0.05)
    for name in "ABCD":
        np.testing.assert_array_equal(getattr(again, name), getattr(made, name))


def test_sums_run_left_to_right_over_states_then_inputs():
    random = np.random.default_rng(1)
    delta, x, v = (random.standard_normal(shape) for shape in ((24, 7), (3, 7), (9, 7)))
    found = DiscreteLti.tustin(*plant.closed(SETS["norm_bounded"](delta)), sample_s=0.05)
    after, y = found.step(x, v)
    for matrix, inputs, shown in ((found.A, found.B, after), (found.C, found.D, y)):
        np.testing.assert_array_equal(product(matrix, x) + product(inputs, v), shown)


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
