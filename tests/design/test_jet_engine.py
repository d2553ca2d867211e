"""Literature: section 5 of the paper, and the optimum that the paper misses."""

import numpy as np
import pytest

from fddbench.design.linearised import Freedom
from fddbench.design.norms import hinf_norm, hminus_index
from fddbench.design.reference_search import normalised, optimize_fixed_poles, optimize_reference
from fddbench.design.robust_hinf import synthesize
from fddbench.design.uncertainty import (
    FullBlock,
    NormBounded,
    Polytope,
    RepeatedReal,
    Structured,
    blocks_of,
    sample_delta,
)
from fddbench.design.worst_case import worst_delta, worst_vertex_mix
from fddbench.systems import StateSpace

IDENTITY = StateSpace.gain(np.eye(3))
OPTIMUM = 0.33400


@pytest.mark.parametrize(("name", "gamma"), [("identity", OPTIMUM), ("final", 0.4636), ("init", 0.6345)])
def test_smallest_gamma_of_the_printed_references(engine, printed, name, gamma):
    design = synthesize(engine, printed(name), relax=None)
    assert design.gamma == pytest.approx(gamma, abs=1e-4)
    assert design.certificate.holds
    assert design.gamma - 1e-3 < design.lower_bound < design.gamma
    assert design.lambda_ > 0.0


def test_a_constant_reference_needs_no_states(for_identity):
    assert for_identity.gamma == pytest.approx(OPTIMUM, abs=5e-4)
    assert for_identity.filter.Ak.shape == (3, 3)
    assert for_identity.lower_bound == pytest.approx(OPTIMUM, abs=1e-3)


def test_the_moderate_filter_costs_two_percent(for_identity):
    moderate = for_identity.moderate
    assert moderate.certificate.holds
    assert moderate.gamma == pytest.approx(1.02 * for_identity.gamma, rel=1e-12)
    poles = np.linalg.eigvals(moderate.filter.Ak)
    assert np.abs(poles).max() < 1.0
    assert poles.real.max() < -0.1


def test_sampled_worst_case_comes_close_to_gamma_from_below(for_identity):
    found = worst_delta(for_identity.loops[0], for_identity.blocks, n_samples=1000)
    assert found.n_sampled >= 1000
    assert 0.999 * for_identity.gamma <= found.norm <= for_identity.gamma
    assert np.linalg.norm(found.member, 2) <= 1.0 + 1e-12
    assert hinf_norm(for_identity.loops[0].at(found.member)).value == pytest.approx(found.norm)


def test_algorithm_1_reaches_the_optimum_from_the_printed_start(engine, printed):
    search = optimize_reference(engine, printed("init"), relax=None)
    gammas = [step.gamma for step in search.iterations]
    assert gammas[0] == pytest.approx(0.6345, abs=1e-4)
    assert len(gammas) <= 11
    assert gammas[-1] == pytest.approx(OPTIMUM, abs=1e-4)
    assert np.all(np.diff(gammas) <= 0.0)
    assert search.lower_bound == pytest.approx(OPTIMUM, abs=1e-3)
    assert search.lower_bound < search.design.gamma == pytest.approx(gammas[-1], abs=1e-5)
    assert hminus_index(search.design.reference).value >= 1.0 - 1e-9


def test_one_inequality_finds_the_optimum_for_fixed_poles(engine):
    design = optimize_fixed_poles(engine, [-1.6, -1.44, -0.57], relax=None)
    assert design.gamma == pytest.approx(OPTIMUM, abs=1e-4)
    assert hminus_index(design.reference).value >= 1.0 - 1e-9


def test_the_printed_result_is_the_optimum_but_for_its_scale(engine, printed):
    final = printed("final")
    assert hminus_index(final).value == pytest.approx(1.2438, abs=1e-3)
    design = synthesize(engine, normalised(final, Freedom.diagonal(final)), relax=None)
    assert design.gamma == pytest.approx(OPTIMUM, abs=1e-4)


@pytest.mark.parametrize(
    "blocks",
    [
        (RepeatedReal(1),) * 3,
        (FullBlock(2, 2), RepeatedReal(1)),
        (RepeatedReal(2), FullBlock(1, 1)),
    ],
)
def test_a_structured_delta_costs_less(engine, for_identity, blocks):
    design = synthesize(engine, IDENTITY, Structured(blocks), relax=None)
    assert design.certificate.holds
    assert design.lower_bound <= design.gamma < for_identity.gamma
    assert worst_delta(design.loops[0], design.blocks, n_samples=50).norm <= design.gamma


def test_one_full_block_is_the_unstructured_case(engine, for_identity):
    design = synthesize(engine, IDENTITY, Structured((FullBlock(3, 3),)), relax=None)
    assert design.gamma == pytest.approx(for_identity.gamma, abs=1e-5)


def test_a_hull_in_the_ball_costs_less(engine, for_identity):
    deltas = sample_delta(blocks_of(NormBounded(), engine), 8, seed=3)
    design = synthesize(engine, IDENTITY, Polytope(tuple(engine.at(delta) for delta in deltas)), relax=None)
    assert design.certificate.holds
    assert design.lower_bound <= design.gamma < for_identity.gamma
    assert 0.999 * design.gamma <= worst_vertex_mix(design.loops, n_samples=50).norm <= design.gamma


def test_scs_agrees(engine, for_identity):
    design = synthesize(engine, IDENTITY, solver="SCS", relax=None)
    assert design.certificate.holds
    assert design.gamma == pytest.approx(for_identity.gamma, abs=1e-5)
