"""The yaw-moment filter: the published model's own row, the covariance of the textbook, and what it learns."""

from types import SimpleNamespace

import numpy as np
import pytest

from fddbench.blocks.layout import Nothing
from fddbench.blocks.linear import product
from fddbench.detection.yaw_moment import YawAcceleration, YawMoment, YawMomentFilter, YawMomentGains
from fddbench.flight.lateral_lpv import lateral_lpv

NO = Nothing()
T = 0.01
GAINS = YawMomentGains(
    sensor_noise_deg_s=0.01, sensor_bias_deg_s=0.02, rate_walk_deg_s_sqrt_s=0.01, acceleration_prior_deg_s2=0.1,
    acceleration_walk_deg_s2_sqrt_s=0.02, share_prior_ratio=(0.1, 0.05, 0.02), share_walk_ratio_sqrt_s=(0.01, 0.0, 0.02),
)  # fmt: skip


def accelerations(rng, n=1):
    a, b, c = rng.normal(size=(3, n))
    return YawAcceleration(sideslip_deg_s2=a, roll_deg_s2=b, surfaces_deg_s2=c, damping_1_s=np.full(n, -0.22))


def test_its_parts_are_the_fourth_row_of_the_published_model():
    rng, model = np.random.default_rng(1), lateral_lpv()
    values = dict(zip(model.names, model.values(rng.uniform(-1.0, 1.0, (4, 6))), strict=True))
    surface_deg, p_deg_s, beta_deg, r_deg_s = rng.normal(size=(13, 6)), *rng.normal(size=(3, 6))
    m = SimpleNamespace(
        **values, surface_deg=surface_deg, p_deg_s=p_deg_s, beta_deg=beta_deg, v_tas_m_s=np.full(6, 200.0)
    )
    parts = YawMoment().parts(m)
    A, B = model.matrices(model.rho(*values.values()))
    x = np.stack([0.0 * p_deg_s, 200.0 * np.sin(np.deg2rad(beta_deg)), np.deg2rad(p_deg_s), np.deg2rad(r_deg_s)])
    expected = np.rad2deg(product(A, x) + product(B, surface_deg))[3]
    found = parts.sideslip_deg_s2 + parts.roll_deg_s2 + parts.surfaces_deg_s2 + parts.damping_1_s * r_deg_s
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_its_covariance_is_that_of_the_textbook_filter_with_matrices():
    rng, block = np.random.default_rng(2), YawMomentFilter(GAINS, T)
    x = block.states.spread(block.start(NO), 1)
    m, P = np.zeros(5), np.diag(block.prior)
    at = np.triu_indices(5)
    for k in range(200):
        a, y, trusted = accelerations(rng), rng.normal(), k % 3 != 0
        S = P[0, 0] + 0.01**2 / 3.0 + 0.02**2
        K = P[:, 0] / S if trusted else np.zeros(5)
        m, P = m + K * (y - m[0]), P - np.outer(K, P[0])
        parts = [a.sideslip_deg_s2[0], a.roll_deg_s2[0], a.surfaces_deg_s2[0]]
        F = np.eye(5)
        F[0] += T * np.array([-0.22, 1.0, *parts])
        m, P = F @ m, F @ P @ F.T + np.diag(block.Q)
        m[0] += T * sum(parts)
        x, _ = block.step(x, NO, NO, np.array([y]), np.array([3.0]), np.array([trusted]), a)
    np.testing.assert_allclose(np.array(x.x)[:, 0], m, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(np.array(x.P)[:, 0], P[at], rtol=1e-8, atol=1e-14)


def test_it_learns_a_share_and_then_coasts_by_it():
    rng, block = np.random.default_rng(3), YawMomentFilter(GAINS, T)
    x, r, off = block.states.spread(block.start(NO), 1), 0.0, []
    for k in range(3000):
        a = np.array([np.sin(0.01 * k)])
        parts = YawAcceleration(
            sideslip_deg_s2=a, roll_deg_s2=0.0 * a, surfaces_deg_s2=0.0 * a, damping_1_s=0.0 * a - 0.2
        )
        y = r + 0.01 / np.sqrt(3.0) * rng.normal(size=1)
        x, _ = block.step(x, NO, NO, y, np.array([3.0]), np.array([k < 2000]), parts)
        r = r + T * (1.1 * a - 0.2 * r)  # ten percent more than the filter's model says
        off.append(float(abs(x.r_deg_s[0] - r[0])))
    assert x.x[2][0] == pytest.approx(0.1, abs=0.02)
    assert max(off[2000:]) < 0.05  # for ten seconds; a share of 0.1 that it had not learnt would make it 0.2 and more
    assert x.variance[0] > block.noise


def test_without_a_live_sensor_it_coasts():
    block = YawMomentFilter(GAINS, T)
    x = block.states.spread(block.start(NO), 1)
    _, now = block.step(x, NO, NO, np.ones(1), np.zeros(1), np.array([True]), accelerations(np.random.default_rng(4)))
    assert now[0] == 0.0
