"""The lateral gust with its rotations: the same velocity, Dryden's gradient and roll, stationary from sample 0 on."""

import numpy as np
import pytest
from scipy.linalg import solve_continuous_lyapunov

from fddbench.flight.dryden import LateralDryden
from fddbench.flight.rotating_gust import LATERAL_WINDS, RotatingGust
from fddbench.flight.turbulence import SCALE_LENGTH_M, LateralGust
from fddbench.flight.wind import CalmAir, Encounter, rotating

N, V, SPAN = 20000, 200.0, 60.0
MEETS = Encounter(v_tas_m_s=np.full(N, V), span_m=SPAN)


def flown(wind, samples, seed=1):
    """Air of each sample, rows v, p, r, (n_time, 3, n_cases)."""
    rng = np.random.default_rng(seed)
    c = wind.prepare(wind.before.unpack(rng.normal(size=(wind.before.size, N))), MEETS, 0.01)
    x, found = wind.states.spread(wind.start(c), N), []
    for k in range(samples):
        x, air = wind.step(x, c, wind.draws.unpack(rng.normal(size=(wind.draws.size, N))), float(k), like=np.zeros(N))
        found.append([air.v_m_s, air.p_rad_s, air.r_rad_s])
    return np.array(found)


def test_the_velocity_keeps_its_bits():
    plain, turned = flown(LateralGust(1.5), 5), flown(RotatingGust(LateralGust(1.5)), 5)
    assert plain[:, 0].tobytes() == turned[:, 0].tobytes()
    assert not plain[:, 1:].any()


def test_literature_rotations_have_the_sizes_of_dryden_at_every_sample():
    """The same variances as the exact filters of all six components, which have other numbers."""
    mine, exact = flown(RotatingGust(LateralGust(3.0)), 31), flown(LateralDryden(3.0), 2)
    for k in (0, 1, 30):
        np.testing.assert_allclose(mine[k].std(axis=1), exact[0].std(axis=1), rtol=0.03)


def test_the_gradient_starts_with_the_covariance_of_the_gust_behind_its_lag():
    tau, lag = SCALE_LENGTH_M / V, 3.0 / np.pi * SPAN / V
    A = np.array([[-1.0, 0.0, 0.0], [1.0, -1.0, 0.0], np.array([np.sqrt(3.0), 1.0 - np.sqrt(3.0), -1.0]) * tau / lag])
    P = solve_continuous_lyapunov(A, -np.diag([1.0, 0.0, 0.0]))
    wind = RotatingGust(LateralGust(1.0))
    normals = np.sqrt(8.0) * np.kron(np.eye(8), [1.0, -1.0])  # unit covariance, nothing by chance
    few = Encounter(v_tas_m_s=np.full(16, V), span_m=SPAN)
    x = wind.start(wind.prepare(wind.before.unpack(normals[: wind.before.size]), few, 0.01))
    assert np.cov([x.gust.first, x.gust.second, x.smooth_m_s], bias=True) == pytest.approx(P, rel=1e-9)


def test_a_share_of_the_rotation_and_literature_intensities():
    sigmas = {name: wind.gust.sigma_m_s for name, wind in LATERAL_WINDS.items() if name != "none"}
    assert sigmas == {"light": 1.5, "moderate": 3.0, "severe": 6.0}
    assert isinstance(LATERAL_WINDS["none"], CalmAir)
    assert next(iter(LATERAL_WINDS)) == "none"  # what flies when nobody says
    assert pytest.approx(1750 * 0.3048) == SCALE_LENGTH_M
    air = CalmAir().step(None, None, None, 0.0, np.zeros(1))[1]
    turning = rotating(type(air)(**{name: np.ones(1) for name in air.__slots__}), 0.25)
    assert (turning.p_rad_s[0], turning.q_rad_s[0], turning.r_rad_s[0], turning.v_m_s[0]) == (0.25, 0.25, 0.25, 1.0)
