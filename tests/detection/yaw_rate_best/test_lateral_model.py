"""The table of a design is the aircraft: its yaw and sideward acceleration are those of the model that it was made of."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.design.lateral_table import accelerations, lpv_table, transport_table
from fddbench.detection.yaw_rate_best.gains import SIDE_ROWS, YAW_ROWS, LateralTable
from fddbench.detection.yaw_rate_best.lateral_model import LateralModel
from fddbench.errors import DesignError
from fddbench.flight.lateral_lpv import derivatives, lateral_lpv
from fddbench.flight.transport.reading import twin_jet

RAD = np.pi / 180.0
TWIN_JET = {
    "mass_kg": (120e3, 233e3),
    "x_cg_ratio": (0.17, 0.41),
    "altitude_ft": (8e3, 38e3),
    "v_cas_kt": (160.0, 300.0),
}
rho = st.lists(st.floats(-1.5, 1.5), min_size=4, max_size=4)
motion = st.lists(st.floats(-5.0, 5.0), min_size=17, max_size=17)


class Measured:
    """A bus of one case."""

    def __init__(self, condition, v_tas_m_s, values):
        names = ("mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt")
        self.__dict__.update({name: np.array([value]) for name, value in zip(names, condition, strict=True)})
        self.v_tas_m_s = np.array([v_tas_m_s])
        self.phi_deg, self.beta_deg, self.p_deg_s = (np.array([value]) for value in values[:3])
        self.surface_deg = np.array(values[4:])[:, np.newaxis]


@settings(max_examples=30, deadline=None)
@given(rho, motion)
def test_the_published_model_turns_and_slips_as_the_table_says(at, values):
    published, V = lateral_lpv(), 200.0
    condition = published.values(np.array(at)[:, np.newaxis])[:, 0]
    measured = Measured(condition, V, values)
    phi, beta, p, r = values[:4]
    x = np.array([RAD * phi, V * RAD * beta, RAD * p, RAD * r])
    A, B = published.matrices(np.array(at)[:, np.newaxis])
    zero = np.zeros(1)
    M, f = derivatives(A, B, measured.surface_deg, u0_m_s=zero, w0_m_s=zero, gust_m_s=zero, delta=(zero, zero, zero))
    rates = M[..., 0] @ x + f[:, 0]
    # the table knows surfaces of a pair by their difference
    d = LateralModel(LateralTable(**lpv_table(published).table)).drives(measured)
    yaw = d.yaw_deg_s2 + d.yaw_per_r * r
    slip = d.slip_deg_s + d.slip_per_r * r
    np.testing.assert_allclose(yaw, rates[3] / RAD, atol=1e-5)
    np.testing.assert_allclose(slip, rates[1] / V / RAD, atol=1e-5)


def test_the_twin_jet_is_met_to_a_few_percent_where_it_was_not_fitted():
    aircraft = twin_jet()
    fitted = transport_table(aircraft, TWIN_JET, degree=2, points=300)
    condition = np.array([[150e3, 0.2, 12e3, 240.0], [190e3, 0.33, 25e3, 280.0], [225e3, 0.25, 20e3, 285.0]]).T
    found = LateralModel(LateralTable(**fitted.table)).coefficients(*condition)
    for rows, true, errors in zip(
        found, accelerations(aircraft, condition), (fitted.yaw_error, fitted.side_error), strict=True
    ):
        assert max(errors) < 0.12
        np.testing.assert_allclose(rows, true, rtol=0.05, atol=2e-4)


def test_an_envelope_that_cannot_be_flown_is_refused():
    high = TWIN_JET | {"altitude_ft": (40e3, 44e3), "mass_kg": (225e3, 233e3)}
    with pytest.raises(
        DesignError, match=r"recipe\.envelope: only \d+ of 100 trims can be flown, a fit of degree 2 needs 60"
    ):
        transport_table(twin_jet(), high, degree=2, points=100)


def test_rows_are_told_by_name():
    with pytest.raises(ValueError, match="yaw row 1 has 2 numbers; each needs 1"):
        LateralTable(
            centre=(0.0,) * 4, half_width=(1.0,) * 4, powers=((0,) * 4,), yaw=((1.0, 2.0), *((1.0,),) * (len(YAW_ROWS) - 1)),
            side=((1.0,),) * len(SIDE_ROWS),
        )  # fmt: skip
