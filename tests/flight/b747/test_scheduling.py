"""The nine scheduling parameters over the envelope: a calibration on Table B1 of the paper."""

import numpy as np
import pytest

from fddbench.flight.b747.airframe import DATA
from fddbench.flight.b747.scheduling import BOX, PARAMETERS, parameters
from fddbench.units import RAD_PER_DEG

CORNERS = DATA["envelope"]


def over_the_envelope():
    """Parameters on a grid of the envelope, (9, n)."""
    speeds, heights, alphas = (np.linspace(*CORNERS[name], n) for name, n in CORNERS_AND_COUNTS)
    v, h, alpha = (grid.ravel() for grid in np.meshgrid(speeds, heights, RAD_PER_DEG * alphas, indexing="ij"))
    return parameters(alpha, v, h, np.zeros_like(v))


CORNERS_AND_COUNTS = (("v_tas_m_s", 27), ("altitude_m", 21), ("alpha_deg", 49))
FLOWN = over_the_envelope()


@pytest.mark.parametrize(
    "j", [j for j, name in enumerate(PARAMETERS) if name != "gamma_rad"], ids=lambda j: PARAMETERS[j]
)
def test_the_corners_give_the_ranges_of_table_b1(j):
    """Calibration: the model was fitted to these 16 numbers."""
    np.testing.assert_allclose([FLOWN[j].min(), FLOWN[j].max()], BOX[j], rtol=0.005)


def test_the_flight_path_angle_is_itself():
    """Table B1 has 20 deg to either side; it is an input here."""
    np.testing.assert_allclose(BOX[PARAMETERS.index("gamma_rad")], np.deg2rad([-20.0, 20.0]), rtol=0.005)
    rho = parameters(*(np.array([value]) for value in (0.02, 241.0, 9000.0, 0.0349)))
    assert rho[PARAMETERS.index("gamma_rad"), 0] == 0.0349


def test_drag_is_scheduled_within_the_limits_of_its_lift():
    """C_L* is limited, so pushing over further changes no drag."""
    rho = parameters(np.array([-0.03, -0.06]), *(np.array([value] * 2) for value in (200.0, 5000.0, 0.0)))
    drag = rho[PARAMETERS.index("drag_pa")]
    assert drag[0] == drag[1]
