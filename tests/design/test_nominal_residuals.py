"""Observers of the nominal plant that decouple the other faults, and the reference that the two-step method makes of them."""

from dataclasses import replace

import numpy as np
import pytest
import yaml

from fddbench import gallery
from fddbench.benchmarks.jet_engine.plant import MATRICES
from fddbench.design.nominal_residuals import nominal_reference, observer_bank
from fddbench.design.norms import hminus_index
from fddbench.errors import DesignError
from fddbench.systems import StateSpace, UncertainPlant, series

JET = UncertainPlant(**MATRICES)


def from_faults(plant):
    """From the faults to the residuals of the bank, inputs at rest."""
    none = np.zeros((plant.B.shape[1], plant.n_x)), np.zeros((plant.B.shape[1], plant.Bf.shape[1]))
    seen = StateSpace(plant.A, plant.Bf, np.vstack([plant.C, none[0]]), np.vstack([plant.Df, none[1]]))
    return series(seen, observer_bank(plant).as_system())


def test_each_residual_sees_its_own_fault_alone_and_as_it_is_in_the_long_run():
    response = from_faults(JET)
    assert response.stable
    np.testing.assert_allclose(response.at(0.0).real, np.eye(3), atol=1e-9)
    for frequency in (0.3, 1.0, 10.0):
        found = np.abs(response.at(frequency))
        assert (found - np.diag(np.diag(found))).max() < 1e-9
        assert np.diag(found).min() > 0.8


def test_a_sensor_fault_beside_an_actuator_fault_is_decoupled_by_the_change_of_the_outputs():
    """The actuator fault has no feedthrough: it is taken out of the rates, ``H = E (C E)⁺``."""
    plant = UncertainPlant(
        A=np.array([[-1.0, 1.0], [0.0, -2.0]]), Bf=np.array([[0.0, 0.0], [1.0, 0.0]]), Bd=np.zeros((2, 2)),
        B=np.array([[0.0], [1.0]]), C=np.eye(2), Df=np.array([[0.0, 1.0], [0.0, 0.0]]), Dd=0.1 * np.eye(2),
        D=np.zeros((2, 1)),
    )  # fmt: skip
    np.testing.assert_allclose(from_faults(plant).at(0.0).real, np.eye(2), atol=1e-9)
    found = np.abs(from_faults(plant).at(2.0))
    assert max(found[0, 1], found[1, 0]) < 1e-9


def test_more_faults_than_outputs_are_refused():
    plant = replace(
        JET, Bf=np.hstack([JET.Bf, JET.Bf[:, :1]]), Df=np.hstack([JET.Df, np.eye(3)[:, :1]]), Ef=np.zeros((3, 4))
    )
    with pytest.raises(
        DesignError, match=r"for the faults beside fault 1: 3 independent ones leave none of the 3 outputs"
    ):
        observer_bank(plant)


def test_the_reference_of_the_two_step_design_is_that_of_the_nominal_engine():
    found = yaml.safe_load((gallery.folder("detectors") / "hinf_two_step.yaml").read_text())["recipe"]["found"]
    reference = nominal_reference(JET)
    assert hminus_index(reference).value == pytest.approx(1.0)
    for name in "ACD":
        np.testing.assert_allclose(found["reference"][name], getattr(reference, name), rtol=1e-4, atol=1e-9)
    exact = from_faults(JET)
    for frequency in (0.0, 1.0, 5.0):  # first order is nearly all of it
        given, made = np.diag(exact.at(frequency)), np.diag(reference.at(frequency))
        np.testing.assert_allclose(made / made[1] * given[1], given, rtol=0.01)
    assert (
        0.334 < found["gamma_lower_bound"] <= found["gamma_optimum"]
    )  # the reference chosen with the filter gives 0.334
