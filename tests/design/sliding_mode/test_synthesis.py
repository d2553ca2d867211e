"""Sliding-mode synthesis: the paper's problem by its published numbers, laws on small plants, and what is refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from fddbench.design.geometric.affine import Box
from fddbench.design.norms import hinf_norm
from fddbench.design.sliding_mode import (
    ErrorSystem,
    FaultyPlant,
    Pair,
    Weights,
    analyse,
    largest_fault,
    observer_gains,
    synthesise,
    with_sensor_faults,
)
from fddbench.design.sliding_mode.canonical import canonical
from fddbench.design.sliding_mode.certificate import bounded_real, certify
from fddbench.errors import DesignError

PRINTED = Pair(L=np.array([[0.035521, 0.027718, -4.95e-5, 0.0]]), W=np.array([[-0.0413, 0.0005, 0.0, 100.0]]))


def test_the_published_pair_has_the_gain_that_an_independent_study_found(paper):
    found = analyse(paper.plant, paper.weights, PRINTED)
    assert found.certificate.frozen == pytest.approx(1.5055, abs=1e-4)
    assert found.optimum == pytest.approx(1.563, abs=1e-3)


def test_the_designed_pair_is_certified_below_0_60_and_nobody_beats_the_bound(paper, best):
    proof = best.certificate
    assert proof.gamma <= 0.60
    assert best.optimum == pytest.approx(0.5723, abs=2e-4)
    assert proof.margin > 1e-4
    assert best.bound == pytest.approx(0.4372, abs=1e-3)
    assert best.bound < proof.frozen_inside <= proof.frozen * (1.0 + 1e-9) < proof.gamma
    np.testing.assert_allclose(best.pair.L @ best.form.F2, 0.0, atol=1e-12)  # eq (20)
    np.testing.assert_allclose(best.pair.W @ best.form.F2, 1.0, atol=1e-12)


def test_the_certificate_refuses_a_gamma_that_the_pair_does_not_have(paper, best):
    system = ErrorSystem(form=best.form, weights=paper.weights)
    loop = system.at(np.zeros(4), best.pair)
    P = np.eye(loop.order)
    with pytest.raises(DesignError, match="is not proved: the inequalities hold with a relative margin of -"):
        certify(system, best.pair, P, best.certificate.gamma, paper.plant)
    assert np.linalg.eigvalsh(bounded_real(P, loop, 1.0, np.block)).max() > 0.0


def test_neighbours_of_the_optimum_are_worse(paper, best):
    """Directions that L and W may move in, each by a tenth: the frozen gain cannot fall below the certified optimum."""
    system = ErrorSystem(form=best.form, weights=paper.weights)
    corners = paper.plant.box.corners()
    for j in range(3):
        for factor in (0.9, 1.1):
            L = best.pair.L.copy()
            L[0, j] *= factor
            moved = max(hinf_norm(system.at(rho, Pair(L=L, W=best.pair.W))).value for rho in corners)
            assert moved > 0.99 * best.certificate.frozen


def test_the_printed_gains_follow_from_the_printed_pair(paper):
    form = canonical(paper.plant)
    gains = observer_gains(form, PRINTED.L, np.diag([-3.1, -3.2, -3.3, -3.4]))
    np.testing.assert_allclose(np.diag(gains.P_o), [0.1613, 0.1563, 0.1515, 0.1471], atol=6e-5)
    np.testing.assert_allclose(
        gains.G_n[3], [-0.0355, -0.0277, 0.0, 0.0], atol=6e-5
    )  # as eq (19), half of what is printed
    np.testing.assert_allclose(gains.G_l[0, 1], [16.8272, 8.5679, 8.3669, 0.0], atol=8e-5)
    np.testing.assert_allclose(gains.G_l[4, 1], [0.6937, 0.5271, -2.1466, 0.0], atol=8e-5)


def test_the_observer_of_these_gains_slides_and_its_injection_is_the_fault(paper, best):
    """Law of eqs (11) to (17) with a stiff sigmoid: e_y to zero, W nu to the fault, for a rho that stands still."""
    gains, A = observer_gains(best.form, best.pair.L, -3.0 * np.eye(4)), paper.plant.A[0]
    C, F, fault = paper.plant.C, paper.plant.F, 0.05

    def injection(e_y):
        pushed = gains.P_o @ e_y
        return -10.0 * pushed / (np.linalg.norm(pushed) + 1e-4)

    def rate(t, e):
        return A @ e - gains.G_l[0] @ (C @ e) + gains.G_n @ injection(C @ e) - F[:, 0] * fault

    e = solve_ivp(rate, (0.0, 8.0), np.array([0.0, 0.01, 0.0, 0.02, 0.0]), method="LSODA", rtol=1e-8, atol=1e-11).y[
        :, -1
    ]
    assert np.linalg.norm(C @ e) < 1e-5
    assert (best.pair.W @ injection(C @ e))[0] == pytest.approx(fault, rel=0.02)


def test_condition_15_names_the_largest_fault(paper):
    form = canonical(paper.plant)
    assert largest_fault(form.F2, np.array([10.0, 10.0, 10.0, 13.0]), 1.0) == pytest.approx(9.0 / 0.01)
    with pytest.raises(DesignError, match="condition \\(15\\): min K = 1 does not exceed eta_0 = 1"):
        largest_fault(form.F2, np.array([1.0, 10.0]), 1.0)


def test_units_of_the_model_change_nothing(paper):
    """Yaw rate in deg/s: L, W and what proves them in other units, γ the same."""
    plant, weights = paper.at_one_condition(), paper.weights
    D = np.diag([1.0, 1.0, 1.0, 57.3, 57.3])
    own = FaultyPlant(
        A=D @ plant.A @ np.linalg.inv(D), C=np.diag([1.0, 1.0, 1.0, 57.3]) @ plant.C @ np.linalg.inv(D), F=D @ plant.F,
        M=D @ plant.M, corrupted=plant.corrupted, box=plant.box,
    )  # fmt: skip
    assert synthesise(own, weights).optimum == pytest.approx(synthesise(plant, weights).optimum, rel=1e-3)


def test_two_suspect_outputs():
    """A pair with the structure of eqs (20) and (21) for two faults; γ in sizes of them."""
    A = np.array([[[-1.0, 1.0, 0.0], [0.0, -2.0, 1.0], [0.5, 0.0, -1.5]]])
    plant = with_sensor_faults(
        A, np.eye(3), suspects=[1, 2], filter_poles=[0.5, 1.0], M=np.array([[0.0], [0.0], [1.0]]), box=Box.of(None, 0)
    )
    weights = Weights(
        uncertainty=np.ones(1),
        corruption=np.array([0.1, 0.0, 0.0]),
        corruption_pole_1_s=5.0,
        fault=np.array([1.0, 0.5]),
    )
    found = synthesise(plant, weights)
    np.testing.assert_allclose(found.pair.W @ found.form.F2, np.eye(2), atol=1e-9)
    np.testing.assert_allclose(found.pair.L @ found.form.F2, 0.0, atol=1e-9)
    assert found.bound <= found.optimum <= found.certificate.gamma


@settings(max_examples=2, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_on_random_plants_the_bound_lies_below_and_the_proof_above_the_frozen_gain(seed):
    random = np.random.default_rng(seed)
    A = random.normal(size=(1, 3, 3)) - 0.5 * np.eye(3)
    plant = with_sensor_faults(
        A, np.eye(3), suspects=[2], filter_poles=[0.5], M=random.normal(size=(3, 1)), box=Box.of(None, 0)
    )
    weights = Weights(
        uncertainty=np.ones(1), corruption=np.array([1.0, 1.0, 0.0]), corruption_pole_1_s=5.0, fault=np.ones(1)
    )
    found = synthesise(plant, weights)
    assert found.bound <= found.certificate.frozen <= found.certificate.gamma


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"suspects": [0, 1, 2, 3]}, "4 of 4 outputs are suspect"),
        ({"suspects": [3, 3]}, "2 of 4 outputs are suspect"),
        ({"C": np.ones((4, 4))}, "C has rank 1, needs 4"),
    ],
)
def test_what_has_no_trusted_output_is_refused(paper, changes, message):
    given = {"C": np.eye(4), "suspects": [3], **changes}
    poles = [0.01] * len(given["suspects"])
    A, C = paper.plant.A[:1, :4, :4], given["C"]
    with pytest.raises(DesignError, match=message):
        with_sensor_faults(A, C, suspects=given["suspects"], filter_poles=poles, M=np.ones((4, 1)), box=Box.of(None, 0))


def test_an_unstable_mode_that_trusted_outputs_do_not_see_is_refused(paper):
    A = np.diag([-1.0, -1.0, -1.0, 0.3])[np.newaxis]
    plant = with_sensor_faults(A, np.eye(4), suspects=[3], filter_poles=[0.01], M=np.ones((4, 1)), box=Box.of(None, 0))
    with pytest.raises(DesignError, match="not minimum phase at rho = \\[\\]: the faults have an unstable zero at 0.3"):
        canonical(plant)


def test_faults_that_no_output_feels_at_once_are_refused():
    plant = FaultyPlant(
        A=np.array([[[0.0, 1.0], [0.0, -1.0]]]), C=np.array([[1.0, 0.0]]), F=np.array([[0.0], [1.0]]), M=np.eye(2),
        corrupted=(True,), box=Box.of(None, 0),
    )  # fmt: skip
    with pytest.raises(DesignError, match="C F has rank 0 for 1 faults"):
        canonical(plant)


def test_a_box_that_no_constant_gain_serves_is_refused():
    """The sign with which the trusted output sees an unstable state changes inside the box."""
    A = np.array([[[-1.0, 0.0], [0.0, 0.5]], [[0.0, 1.0], [0.0, 0.0]]])
    plant = with_sensor_faults(
        A, np.eye(2), suspects=[1], filter_poles=[0.1], M=np.ones((2, 1)), box=Box.of([(-1.0, 1.0)], 1)
    )
    weights = Weights(
        uncertainty=np.ones(1), corruption=np.array([1.0, 0.0]), corruption_pole_1_s=5.0, fault=np.ones(1)
    )
    with pytest.raises(DesignError, match="no constant L with one Lyapunov matrix"):
        synthesise(plant, weights)


def test_pairs_without_the_structure_of_eqs_20_and_21_are_refused(paper):
    with pytest.raises(DesignError, match="pair: W F2 = I fails by 0.9"):
        analyse(paper.plant, paper.weights, Pair(L=PRINTED.L, W=0.1 * PRINTED.W))
    with pytest.raises(DesignError, match="pair: L F2 = 0 fails"):
        analyse(paper.plant, paper.weights, Pair(L=np.ones((1, 4)), W=PRINTED.W))
