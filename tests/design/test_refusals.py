"""Golden: what a synthesis refuses, and the advice it gives."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from fddbench.design import solver as solvers
from fddbench.design import stability
from fddbench.design.linearised import Freedom
from fddbench.design.reference_search import normalised, optimize_fixed_poles
from fddbench.design.robust_hinf import synthesize
from fddbench.design.uncertainty import Polytope, RepeatedReal, Structured
from fddbench.errors import DesignError
from fddbench.systems import StateSpace, UncertainPlant

IDENTITY = StateSpace.gain(np.eye(3))


def refused(match: str, *args, **options):
    with pytest.raises(DesignError, match=match):
        synthesize(*args, **options)


def test_a_blind_feedthrough(engine):
    blind = replace(engine, Df=engine.Df * [[1.0, 1.0, 0.0]])
    refused("Df of the plant has rank 2 for 3 faults", blind, IDENTITY)
    refused("Use a strictly proper fixed reference", blind, IDENTITY)


def test_an_unstable_plant(engine):
    refused("the plant is unstable: A has poles", replace(engine, A=-engine.A), IDENTITY)


def test_a_plant_that_delta_destabilises(engine):
    refused(
        "not quadratically stable: the gain of its Δ channel .* Divide FA or EA",
        replace(engine, FA=100.0 * engine.FA),
        IDENTITY,
    )


def test_an_ill_posed_delta(engine):
    refused("ill-posed: H \\(3, 3\\) has norm 1", replace(engine, H=3.0 * engine.H), IDENTITY)
    refused("ill-posed", replace(engine, H=np.eye(3)), IDENTITY, Structured((RepeatedReal(1),) * 3))


def test_structure_can_save_what_the_ball_cannot(engine):
    skew = np.array([[0.0, 1.2, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    refused("ill-posed", replace(engine, H=skew), IDENTITY)
    design = synthesize(replace(engine, H=skew), IDENTITY, Structured((RepeatedReal(1),) * 3), relax=None)
    assert design.certificate.holds


def test_a_blind_feedthrough_to_one_of_several_faults_is_no_reason(engine):
    """The reference asks little of the fault that is not seen at once: a filter for the others is worth having."""
    blind = replace(engine, Df=engine.Df * [[1.0, 1.0, 0.0]])
    reference = StateSpace.gain(np.diag([3.0, 3.0, 0.1]))
    design = synthesize(blind, reference, relax=None)
    assert design.certificate.holds
    assert design.lower_bound <= design.gamma < 0.5 * design.idle_gamma


def test_a_structured_delta_that_destabilises_is_shown(engine):
    strong = replace(engine, FA=20.0 * np.eye(3), EA=np.eye(3), H=np.zeros((3, 3)))
    blocks = Structured((RepeatedReal(1),) * 3)
    refused("unstable for a Δ of this structure: Δ = .* gives it a pole with real part", strong, IDENTITY, blocks)


def test_multipliers_that_are_not_found_are_no_proof(engine, monkeypatch):
    monkeypatch.setattr(stability, "_multipliers", lambda *args: False)
    weak = replace(engine, H=np.array([[0.0, 1.2, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]))
    blocks = Structured((RepeatedReal(1),) * 3)
    refused("CLARABEL did not find multipliers .* Lemma 5 is only sufficient", weak, IDENTITY, blocks)


def test_a_common_lyapunov_matrix_that_is_not_found_is_no_proof(engine, monkeypatch):
    vertices = Polytope((engine.at(np.zeros((3, 3))), engine.at(0.5 * np.eye(3))))
    monkeypatch.setattr(stability, "SOLVED", ())
    refused("CLARABEL did not find a P ≻ 0 .* and no proof that there is none", engine, IDENTITY, vertices)


def test_the_proof_that_there_is_no_common_lyapunov_matrix():
    """The middle of the first two is unstable, so there is none; equal matrices have one, so there is no such proof."""
    far, back = np.array([[-1.0, 9.0], [0.0, -1.0]]), np.array([[-1.0, 0.0], [9.0, -1.0]])
    assert np.linalg.eigvals(0.5 * (far + back)).real.max() > 0.0
    level = stability._farkas([far, back], "CLARABEL")
    assert level is not None
    assert level > 0.0
    assert stability._farkas([far, far], "CLARABEL") is None


def test_polytopes(engine):
    vertex = engine.at(np.zeros((3, 3)))
    far = replace(vertex, A=vertex.A + np.array([[0.0, 50.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]))
    back = replace(vertex, A=vertex.A + np.array([[0.0, 0.0, 0.0], [50.0, 0.0, 0.0], [0.0, 0.0, 0.0]]))
    refused(
        "vertices is not quadratically stable: no P ≻ 0 .* Proof: there are X_i",
        engine,
        IDENTITY,
        Polytope((far, back)),
    )
    refused("vertex 1 is unstable", engine, IDENTITY, Polytope((vertex, replace(vertex, A=-vertex.A))))
    refused("rank 0", engine, IDENTITY, Polytope((vertex, replace(vertex, Df=0.0 * vertex.Df))))
    single = UncertainPlant(**{name: -np.ones((1, 1)) for name in ("A", "Bf", "Bd", "B", "C", "Df", "Dd", "D")})
    with pytest.raises(DesignError, match="A of vertex 1 has shape \\(1, 1\\) but A of vertex 0 has shape \\(3, 3\\)"):
        Polytope((vertex, single))
    refused(
        "A of the plant has shape .* but A of the vertices has shape \\(1, 1\\)", engine, IDENTITY, Polytope((single,))
    )
    with pytest.raises(DesignError, match="vertex 0 has an uncertainty channel"):
        Polytope((engine,))
    with pytest.raises(DesignError, match="at least one vertex"):
        Polytope(())


def test_shapes(engine):
    refused("the reference has D of shape \\(2, 2\\) but the plant has 3 faults", engine, StateSpace.gain(np.eye(2)))
    refused("make Δ of shape \\(2, 2\\), but FA", engine, IDENTITY, Structured((RepeatedReal(2),)))


def test_references(engine):
    refused("the reference is unstable", engine, StateSpace.diagonal(np.ones(3), np.ones(3), np.ones(3), np.ones(3)))
    blind = StateSpace.diagonal(-np.ones(3), np.ones(3), np.ones(3), np.zeros(3))
    with pytest.raises(DesignError, match="the reference is blind"):
        normalised(blind, Freedom.diagonal(blind))
    with pytest.raises(DesignError, match="one negative pole for each of the 3 faults"):
        optimize_fixed_poles(engine, [-1.0, -2.0])


def test_faults_that_drown(engine):
    drowned = replace(engine, Dd=100.0 * engine.Dd)
    refused("always zero has gamma 1, and no filter .* has less than 0.99.* at 0 rad/s proves it", drowned, IDENTITY)


def test_solvers(engine, monkeypatch):
    refused("no solver is called 'CLARABELL'. Did you mean 'CLARABEL'", engine, IDENTITY, solver="CLARABELL")
    if "MOSEK" not in __import__("cvxpy").installed_solvers():
        refused("MOSEK is not installed", engine, IDENTITY, solver="MOSEK")
    monkeypatch.setitem(solvers.SOLVERS, "SCS", {"eps": 1e-9, "max_iters": 20})
    refused(
        "SCS .status 'optimal_inaccurate'.* did not find .* is no proof .* what a solver doubts",
        engine,
        IDENTITY,
        solver="SCS",
    )


def test_importing_the_package_does_not_import_cvxpy():
    code = "import sys, fddbench.design.reference_search; assert 'cvxpy' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)
