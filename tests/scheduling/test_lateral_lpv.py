"""Parameters and model of the lateral LPV aircraft as filters see it."""

from types import SimpleNamespace

import numpy as np
import pytest

from fddbench.design.geometric.affine import at
from fddbench.flight.lateral_lpv import lateral_lpv
from fddbench.scheduling.lateral_lpv import LateralLpvParameters


@pytest.mark.parametrize("point", [(200e3, 0.3, 20e3, 290.0), (185e3, 0.32, 24e3, 310.0), (230e3, 0.25, 8e3, 200.0)])
def test_the_model_is_the_published_one_in_the_units_of_its_parameters(point):
    own, model = LateralLpvParameters(), LateralLpvParameters.models["published"]()
    measured = SimpleNamespace(**{name: np.array([value]) for name, value in zip(own.signals, point, strict=True)})
    rho = own.rho(measured)[:, 0]
    np.testing.assert_array_equal(rho, point)  # not clipped to the box
    lpv = lateral_lpv()
    normal = lpv.rho(*(np.array([value]) for value in point))
    for table, name in ((model.A, "A"), (model.B, "B")):
        np.testing.assert_allclose(at(table, rho), lpv.matrix(name, normal)[:, :, 0], rtol=1e-9, atol=1e-12)


def test_the_box_is_the_published_one():
    lpv = lateral_lpv()
    normal = lpv.rho(*np.array(LateralLpvParameters.box))
    np.testing.assert_allclose(normal, [[-1.0, 1.0]] * 4, atol=1e-12)
