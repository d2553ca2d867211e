"""The lateral filter with a gust state: exact on its own model, holds the yaw rate while it coasts, belongs to its clock."""

import numpy as np
import pytest
import yaml

from fddbench import gallery
from fddbench.blocks.layout import Nothing
from fddbench.detection.gust_filter import GustFilter, GustFilterGains, Lateral
from fddbench.errors import DesignError
from fddbench.flight.lateral_lpv import lateral_lpv
from fddbench.interfaces import Bus

BUS = Bus(sample_s=0.01, sites=(), signals={})


def gains():
    text = (gallery.folder("detectors") / "kalman_gust.yaml").read_text()
    return GustFilterGains.model_validate(yaml.safe_load(text)["gains"]["filter"])


def fly(*, offset_rad_s=0.0, trust_until=500, n=1000, gust_m_s=0.0):
    """Estimates less the truth [rad/s] on the model itself, rudder working, the reading of r off from sample 500 on."""
    made, model, rho = GustFilter(gains(), BUS), lateral_lpv(), np.zeros((4, 1))
    A, B = model.matrices(rho)
    s, x, errors = made.states.spread(made.start(Nothing()), 1), np.zeros((4, 1)), []
    for k in range(n):
        rates = B[:, 0] * np.sin(0.02 * k)
        seen = x.copy()
        now = Lateral(y=seen[:3], A=A, rates=rates)
        e = made.innovation(s, now, x[3] + (offset_rad_s if k >= 500 else 0.0))
        s, r = made.step(s, Nothing(), Nothing(), now, e, np.full(1, float(k < trust_until)))
        errors.append((r - x[3])[0])
        x = x + 0.01 * (np.einsum("ijk,jk->ik", A, x) + rates)
        x[1] += gust_m_s * 0.01 * np.cos(0.01 * k)
    return np.array(errors)


def test_it_is_exact_on_its_own_model():
    assert np.abs(fly()).max() < 1e-12


def test_while_it_coasts_a_wrong_reading_does_not_move_it():
    followed, coasted = fly(offset_rad_s=0.02, trust_until=1000), fly(offset_rad_s=0.02)
    assert followed[700] == pytest.approx(0.02, abs=0.004)
    assert np.abs(coasted).max() < 1e-12


def test_a_gust_that_moves_the_sideslip_hardly_moves_its_yaw_rate():
    assert np.abs(np.rad2deg(fly(gust_m_s=3.0))).max() < 0.1


def test_gains_of_another_clock_are_refused():
    with pytest.raises(DesignError, match=r"filter.sample_s: these gains are for 0.01 s, this campaign has 0.02"):
        GustFilter(gains(), Bus(sample_s=0.02, sites=(), signals={}))
