"""Parameters and models of the Boeing 747 as the filters see them."""

from types import SimpleNamespace

import numpy as np
import pytest

from fddbench.design.geometric import residual_generator
from fddbench.design.geometric.affine import Box, at
from fddbench.flight.b747.affine_model import affine_model
from fddbench.flight.b747.scheduling import parameters
from fddbench.scheduling.b747 import B747, B747Unclipped


def measured(alpha_deg, v_tas_m_s, altitude_m, theta_deg):
    values = {"alpha_deg": alpha_deg, "v_tas_m_s": v_tas_m_s, "altitude_m": altitude_m, "theta_deg": theta_deg}
    return SimpleNamespace(**{name: np.array([value]) for name, value in values.items()})


def test_parameters_are_those_of_the_physics_with_gamma_from_pitch_and_incidence():
    found = B747().rho(measured(2.0, 220.0, 8000.0, 3.5))
    expected = parameters(*(np.array([x]) for x in (np.deg2rad(2.0), 220.0, 8000.0, np.deg2rad(1.5))))
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_unclipped_differs_in_the_drag_outside_the_limits_of_table_b1_alone():
    inside, slow = measured(1.0, 230.0, 8000.0, 1.0), measured(6.0, 160.0, 9000.0, 7.0)
    np.testing.assert_allclose(B747Unclipped().rho(inside), B747().rho(inside), rtol=1e-14)
    more = B747Unclipped().rho(slow) / B747().rho(slow)
    assert more[6, 0] == pytest.approx(1.408, abs=1e-3)
    np.testing.assert_allclose(np.delete(more, 6, axis=0), 1.0, rtol=1e-14)


@pytest.mark.parametrize("variant", ["fold", "approx"])
def test_models_are_the_affine_model_in_the_units_of_its_parameters(variant):
    model, lpv = B747.models[variant](), affine_model(variant)
    rho = model.box[:, 0] + np.linspace(0.1, 0.9, 9) * (model.box[:, 1] - model.box[:, 0])
    normal = (rho[:, np.newaxis] - lpv.trim) / lpv.scale
    for table, name in ((model.A, "A"), (model.B, "B")):
        np.testing.assert_allclose(at(table, rho), lpv.matrix(name, normal)[:, :, 0], rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("variant", ["fold", "approx"])
def test_pointwise_both_faults_can_be_told_apart_although_the_sum_condition_fails(variant):
    """Thrust enters alpha' through 1/V, equation (B3), and equation (30) is silent about it."""
    model = B747.models[variant]()
    box = Box.of(model.box.tolist(), 9)
    assert [j + 1 for j in box.active(model.A)] == [2, 4]
    faults = {"elevator": model.B[:, :, [0]], "thrust": model.B[:, :, [2]]}
    bank = residual_generator(model.A, model.B, model.C, faults, box=model.box.tolist(), decay=2.0, one_state=True)
    for found in bank.values():
        assert found.order == 1
        assert found.identity_error < 1e-12
        assert found.solvability.solvable
        assert not found.solvability.sum_condition
        assert found.solvability.condition_number < 1.02
    constant = model.B[:, :, [2]] * np.array([1.0, *[0.0] * 9])[:, np.newaxis, np.newaxis]  # as equation (30) has it
    alone = residual_generator(
        model.A, model.B, model.C, faults | {"thrust": constant}, box=model.box.tolist(), watch=["elevator"]
    )
    assert alone["elevator"].solvability.sum_condition
