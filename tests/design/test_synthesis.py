"""Law: whatever plant the user brings, the filter is stable, the certificate holds and nothing sampled exceeds γ."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fddbench.design.certificate import certify
from fddbench.design.norms import hinf_norm
from fddbench.design.reference_search import optimize_reference
from fddbench.design.robust_hinf import synthesize
from fddbench.design.uncertainty import RepeatedReal, Structured, sample_delta
from fddbench.design.weights import Weights
from fddbench.errors import DesignError
from fddbench.systems import StateSpace


def first_order(n_f: int) -> StateSpace:
    one = np.ones(n_f)
    return StateSpace.diagonal(-one, one, 0.5 * one, one)


@given(st.integers(0, 10**6), st.integers(2, 8), st.integers(1, 3), st.integers(0, 2), st.booleans())
@settings(max_examples=8, deadline=None, derandomize=True)
@pytest.mark.slow
def test_random_plants_get_a_certified_filter(random_plant, seed, n_x, n_f, n_delta, constant):
    plant = random_plant(seed, n_x, n_f, n_delta)
    try:
        design = synthesize(plant, StateSpace.gain(np.eye(n_f)) if constant else first_order(n_f))
    except DesignError as refusal:
        assume("a residual that is always zero" not in str(refusal))
        raise
    assert design.lower_bound <= design.gamma < design.moderate.gamma < design.idle_gamma
    for proven in (design, design.moderate):
        assert proven.certificate.holds
        assert proven.filter.as_system().stable()
        deltas = sample_delta(proven.blocks, 10, seed=1) if proven.blocks else [np.zeros(plant.H.T.shape)]
        assert max(hinf_norm(proven.loops[0].at(delta)).value for delta in deltas) < proven.gamma


@pytest.mark.parametrize(("seed", "sizes", "constant"), [(258352, (5, 1, 2), True), (781775, (4, 3, 0), False)])
def test_a_filter_near_the_optimum_is_proved_by_a_lyapunov_matrix_of_its_own(random_plant, seed, sizes, constant):
    """That of the synthesis is as good as singular for these plants and proves nothing beyond rounding."""
    plant, n_f = random_plant(seed, *sizes), sizes[1]
    design = synthesize(plant, StateSpace.gain(np.eye(n_f)) if constant else first_order(n_f), relax=None)
    assert design.certificate.holds
    assert design.lower_bound <= design.gamma < 0.3 * design.idle_gamma
    deltas = sample_delta(design.blocks, 20, seed=1) if design.blocks else [np.zeros(plant.H.T.shape)]
    assert max(hinf_norm(design.loops[0].at(delta)).value for delta in deltas) < design.gamma


def test_the_closed_loop_is_that_of_the_problem_statement(random_plant):
    plant = random_plant(1, 4, 2, 2)
    W_f, W_d = StateSpace.diagonal([-1.0, -3.0], [1.0, 1.0], [0.5, 0.2], [1.0, 2.0]), 0.3 * np.eye(plant.inputs[1])
    reference, random = first_order(2), np.random.default_rng(0)
    design = synthesize(plant, reference, weights=Weights(W_f=W_f, W_d=W_d), relax=None)
    delta = sample_delta(design.blocks, 5, seed=2)[-1]
    certain, K = plant.at(delta), design.filter.as_system()
    loop = design.loops[0].at(delta)
    for w in random.uniform(0.0, 5.0, 5):
        y = [StateSpace(certain.A, B, certain.C, D).at(w) for B, D in _channels(certain)]
        r = [K.at(w)[:, : plant.n_y] @ response for response in y]
        r[2] = r[2] + K.at(w)[:, plant.n_y :]
        wanted = np.hstack([(r[0] - reference.at(w)) @ W_f.at(w), r[1] @ W_d, r[2]])
        np.testing.assert_allclose(loop.at(w), wanted, atol=1e-8 * np.abs(K.A).max())


def _channels(plant):
    return (plant.Bf, plant.Df), (plant.Bd, plant.Dd), (plant.B, plant.D)


def test_constant_weights_scale_the_plant(engine, for_identity):
    scaled = replace(engine, Bd=0.5 * engine.Bd, Dd=0.5 * engine.Dd)
    weighted = synthesize(engine, StateSpace.gain(np.eye(3)), weights=Weights(W_d=0.5 * np.eye(3)), relax=None)
    assert weighted.gamma == pytest.approx(synthesize(scaled, StateSpace.gain(np.eye(3)), relax=None).gamma, abs=1e-5)
    assert weighted.gamma < for_identity.gamma


def test_dynamic_weights_are_states_of_the_filter(engine, for_identity):
    W_u = StateSpace.diagonal(-np.ones(3), np.ones(3), np.ones(3), np.zeros(3))
    design = synthesize(engine, StateSpace.gain(np.eye(3)), weights=Weights(W_u=W_u), relax=None)
    assert design.filter.Ak.shape == (6, 6)
    assert design.certificate.holds
    assert design.gamma < for_identity.gamma


def test_a_strictly_proper_reference_suits_a_blind_feedthrough(random_plant):
    plant = random_plant(3, 3, 1)
    plant = replace(plant, Df=np.zeros_like(plant.Df), Dd=0.1 * plant.Dd, Bd=0.1 * plant.Bd, Bf=np.ones((3, 1)))
    with pytest.raises(DesignError, match="Df of the plant has rank 0 for 1 faults"):
        synthesize(plant, StateSpace.gain(np.eye(1)))


def test_a_certificate_refuses_what_is_not_proved(for_identity):
    proof = for_identity.certificate
    lower = certify(for_identity.loops, proof.Pc, 0.99 * proof.gamma, proof.multiplier, [])
    assert not lower.holds
    with pytest.raises(DesignError, match="gamma = 0.330661 has no certificate"):
        lower.require()
    wild = replace(for_identity.loops[0], D=1.1 * for_identity.loops[0].D)
    assert not certify((wild,), proof.Pc, proof.gamma, proof.multiplier, []).holds


def test_a_certificate_covers_every_delta_that_is_drawn(for_identity):
    proof = for_identity.certificate
    members = [for_identity.loops[0].at(delta) for delta in sample_delta(for_identity.blocks, 200, seed=9)]
    again = certify(for_identity.loops, proof.Pc, proof.gamma, proof.multiplier, members)
    assert again.holds
    assert again.n_sampled == 200


def test_algorithm_1_never_grows_on_other_plants(random_plant):
    for seed in (1, 16):
        plant = random_plant(seed, 3, 2, 2)
        search = optimize_reference(plant, first_order(2), Structured((RepeatedReal(1),) * 2), iterations=3, relax=None)
        gammas = [step.gamma for step in search.iterations]
        assert np.all(np.diff(gammas) <= 0.0)
        assert gammas[-1] < gammas[0]
        assert search.lower_bound <= search.design.gamma <= gammas[-1] * (1.0 + 1e-3)
