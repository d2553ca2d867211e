"""The gust of certification: its shape, its printed sizes, and where the air goes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.flight.atmosphere import FT_M, density_kg_m3
from fddbench.flight.one_minus_cosine import OneMinusCosine, design_gust_m_s
from fddbench.flight.wind import Encounter


def flown(wind, n=400, sample_s=0.01, **meets):
    """Motion of the air, sample by sample."""
    c = wind.prepare(None, Encounter(v_tas_m_s=np.array([200.0]), **meets), sample_s)
    return [wind.step(wind.start(c), c, None, np.float64(k), like=np.zeros(1))[1] for k in range(n)]


@pytest.mark.parametrize(
    ("altitude_ft", "reference_m_s"), [(0.0, 17.07), (15000.0, 13.41), (60000.0, 6.36), (37500.0, 9.885)]
)
def test_literature_reference_gusts_are_equivalent_airspeeds(altitude_ft, reference_m_s):
    peak = design_gust_m_s(np.array([altitude_ft * FT_M]), np.array([107.0]))
    assert peak[0] * np.sqrt(density_kg_m3(np.array([altitude_ft])) / 1.225)[0] == pytest.approx(
        reference_m_s, rel=1e-9
    )


def test_literature_short_gusts_are_weaker():
    peaks = design_gust_m_s(np.zeros(2), np.array([9.0, 107.0]))
    assert peaks[0] / peaks[1] == pytest.approx((9.0 / 107.0) ** (1.0 / 6.0), rel=1e-12)


@settings(max_examples=15)
@given(st.floats(9.0, 107.0), st.floats(0.0, 12000.0), st.floats(0.1, 2.0), st.integers(0, 100))
def test_the_hump_is_its_closed_form_by_the_distance_flown(gradient_m, altitude_m, share, begins):
    found = flown(
        OneMinusCosine("right", begins * 0.01), gradient_m=gradient_m, altitude_m=altitude_m, scale_ratio=share
    )
    v = np.array([air.v_m_s[0] for air in found])
    s = 200.0 * 0.01 * (np.arange(400) - begins)
    peak = share * design_gust_m_s(np.array([altitude_m]), np.array([gradient_m]))[0]
    expected = np.where((s >= 0) & (s <= 2 * gradient_m), peak / 2 * (1 - np.cos(np.pi * s / gradient_m)), 0.0)
    np.testing.assert_allclose(v, expected, atol=1e-9)
    assert not v[: begins + 1].any()
    assert not v[s > 2 * gradient_m].any()


@pytest.mark.parametrize(
    ("direction", "component", "sign"),
    [("up", "w_m_s", -1), ("down", "w_m_s", 1), ("right", "v_m_s", 1), ("left", "v_m_s", -1)],
)
def test_the_air_goes_where_it_is_said_to(direction, component, sign):
    air = flown(OneMinusCosine(direction, 0.1))[63]  # 106 m into it
    moving = {name: getattr(air, name)[0] for name in ("u_m_s", "v_m_s", "w_m_s", "p_rad_s", "q_rad_s", "r_rad_s")}
    assert moving.pop(component) == pytest.approx(sign * 17.07, rel=1e-3)
    assert not any(moving.values())
