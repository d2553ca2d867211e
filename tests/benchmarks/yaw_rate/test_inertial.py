"""Laws of the inertial units: every error by itself, against its formula; the same flight in every scenario and engine."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.benchmarks.yaw_rate.inertial import Attitude, InertialErrors, InertialUnits
from fddbench.benchmarks.yaw_rate.plants.lateral_lpv import LateralLpvPlant
from fddbench.benchmarks.yaw_rate.sensors import PRESETS, SensorErrors
from fddbench.benchmarks.yaw_rate.unit_sensors import UnitSensors
from fddbench.faults.jam import Jam

NONE = InertialErrors(
    rate_bias_deg_s=0.0, rate_scale_percent=0.0, misalignment_deg=0.0, bank_bias_deg=0.0, rate_quantum_deg_s=0.0,
    bank_quantum_deg=0.0, rate_most_deg_s=np.inf, bank_most_deg=np.inf, latency_s=(0.0, 0.0),
)  # fmt: skip
"""Units that read the truth."""
UNITS, CASES, SAMPLES = 3, 4, 30


def read(normals=None, *, seed=3, sample_s=0.01, true=None, **errors):
    """True signals, (n_time, n_cases), and readings, (n_time, n_units, n_cases), of units without noise."""
    block = InertialUnits(
        replace(NONE, **errors), rate_noise_deg_s=(0.0, 0.0), bank_noise_deg=0.0, n_units=UNITS, sample_s=sample_s
    )
    rng = np.random.default_rng(seed)
    true = true or Attitude(
        **dict(
            zip(
                ("phi_deg", "p_deg_s", "r_deg_s"), rng.normal(0.0, 5.0, (3, SAMPLES, CASES)).cumsum(axis=1), strict=True
            )
        )
    )
    normals = np.zeros((block.before.size, CASES)) if normals is None else np.full((block.before.size, CASES), normals)
    c = block.constants.spread(block.prepare(block.before.unpack(normals)), CASES)
    x = block.states.spread(block.start(c), CASES)
    n = block.draws.unpack(np.zeros((block.draws.size, CASES)))
    found = {"phi_deg": [], "p_deg_s": [], "r_deg_s": []}
    for k in range(SAMPLES):
        now = Attitude(phi_deg=true.phi_deg[k], p_deg_s=true.p_deg_s[k], r_deg_s=true.r_deg_s[k])
        x, readings = block.step(x, c, n, now, tuple(np.zeros((UNITS, CASES))))
        for name, rows in found.items():
            rows.append(getattr(readings, name))
    return true, SimpleNamespace(**{name: np.array(rows) for name, rows in found.items()})


def test_without_errors_the_truth_is_read():
    true, seen = read()
    for name in ("phi_deg", "p_deg_s", "r_deg_s"):
        assert np.array_equal(getattr(seen, name), np.repeat(getattr(true, name)[:, np.newaxis], UNITS, axis=1))


@settings(max_examples=20)
@given(st.floats(-5.0, 5.0))
def test_a_bias_is_its_sigma_times_a_normal_that_is_cut_at_three(normal):
    true, seen = read(normal, rate_bias_deg_s=0.02, bank_bias_deg=0.1)
    cut = np.clip(normal, -3.0, 3.0)
    for name, sigma in (("r_deg_s", 0.02), ("p_deg_s", 0.02), ("phi_deg", 0.1)):
        off = getattr(seen, name) - getattr(true, name)[:, np.newaxis]
        np.testing.assert_allclose(off, sigma * cut, atol=1e-12)


def test_a_scale_factor_multiplies_rates_alone():
    true, seen = read(2.0, rate_scale_percent=0.1)
    np.testing.assert_allclose(seen.r_deg_s[:, 1], 1.002 * true.r_deg_s, rtol=1e-14)
    np.testing.assert_allclose(seen.p_deg_s[:, 2], 1.002 * true.p_deg_s, rtol=1e-14)
    assert np.array_equal(seen.phi_deg[:, 0], true.phi_deg)


def test_a_tilted_unit_sees_roll_in_its_yaw_rate_and_keeps_the_length():
    true, seen = read(1.0, misalignment_deg=0.1)
    tilt = np.deg2rad(0.1)
    np.testing.assert_allclose(seen.r_deg_s[:, 0], true.r_deg_s + tilt * true.p_deg_s, atol=1e-12)
    np.testing.assert_allclose(seen.p_deg_s[:, 0], true.p_deg_s - tilt * true.r_deg_s, atol=1e-12)
    before, after = (
        np.hypot(v.p_deg_s.reshape(SAMPLES, -1, CASES), v.r_deg_s.reshape(SAMPLES, -1, CASES)) for v in (true, seen)
    )
    np.testing.assert_allclose(before, after[:, :1], rtol=2e-6)


def test_readings_are_the_nearest_multiples_of_the_quantum_and_are_clipped():
    quantum = 128.0 / 2**13
    true, seen = read(rate_quantum_deg_s=quantum, bank_quantum_deg=0.5, rate_most_deg_s=12.0)
    assert np.array_equal(seen.r_deg_s / quantum, np.rint(seen.r_deg_s / quantum))
    assert np.abs(seen.r_deg_s[:, 0] - np.clip(true.r_deg_s, -12.0, 12.0)).max() <= 0.5 * quantum
    assert np.abs(seen.phi_deg[:, 0] - true.phi_deg).max() <= 0.25
    assert np.abs(true.r_deg_s).max() > 12.0
    assert np.abs(seen.r_deg_s).max() == 12.0


@settings(max_examples=30)
@given(st.floats(0.0, 0.03), st.sampled_from([0.01, 0.02, 0.004]))
def test_a_reading_is_as_old_as_the_latency_on_a_straight_line_between_samples(latency_s, sample_s):
    true, seen = read(sample_s=sample_s, latency_s=(latency_s, latency_s))
    time_s = sample_s * np.arange(-9, SAMPLES)
    late = np.vstack([np.zeros((9, CASES)), true.r_deg_s])  # level before sample 0
    for case in range(CASES):
        expected = np.interp(time_s[9:] - latency_s, time_s, late[:, case])
        np.testing.assert_allclose(seen.r_deg_s[:, 2, case], expected, atol=1e-9)


def test_latencies_are_uniform_and_belong_to_a_unit():
    block = InertialUnits(
        replace(NONE, latency_s=(0.005, 0.020)),
        rate_noise_deg_s=(0.0, 0.0),
        bank_noise_deg=0.0,
        n_units=3,
        sample_s=0.01,
    )
    normals = np.random.default_rng(1).normal(size=(block.before.size, 4000))
    weights = block.prepare(block.before.unpack(normals)).weights
    late_s = 0.01 * (weights[1] + 2.0 * weights[2])
    np.testing.assert_allclose(weights[0] + weights[1] + weights[2], 1.0, atol=1e-12)
    assert late_s.min() >= 0.005
    assert late_s.max() <= 0.020
    np.testing.assert_allclose(
        np.quantile(late_s, [0.25, 0.5, 0.75], axis=1).T, [[0.00875, 0.0125, 0.01625]] * 3, atol=5e-4
    )
    assert np.abs(np.corrcoef(late_s)[np.triu_indices(3, 1)]).max() < 0.06


def test_sideslip_lags_from_its_first_value_and_airspeed_is_off():
    iru = PRESETS["iru"]
    block = UnitSensors(iru, replace(iru.errors, units=NONE), UNITS, 0.01)
    normals = np.full((block.before.size, 1), 1.0)
    c = block.constants.spread(block.prepare(block.before.unpack(normals)), 1)
    x, n = block.states.spread(block.start(c), 1), block.draws.unpack(np.zeros((block.draws.size, 1)))
    beta = []
    for k in range(41):
        true = np.full(1, 2.0 if k else 1.0)
        x, seen = block.step(x, c, n, float(k), r_deg_s=true, beta_deg=true, p_deg_s=true, phi_deg=true)
        beta.append(seen.beta_deg[0] - 0.3)
    np.testing.assert_allclose(beta, 2.0 - np.exp(-np.arange(41) / 10.0), atol=1e-12)
    assert seen.v_tas_error_m_s[0] == pytest.approx(2.0 * 0.514444, rel=1e-5)


def test_the_preset_is_that_of_the_facts():
    errors = PRESETS["iru"].errors
    assert isinstance(errors, SensorErrors)
    units = errors.units
    assert (units.rate_bias_deg_s, units.rate_scale_percent, units.misalignment_deg) == (0.02, 0.1, 0.1)
    assert (units.rate_quantum_deg_s, units.rate_most_deg_s, units.latency_s) == (0.015625, 128.0, (0.005, 0.020))
    assert (errors.beta_bias_deg, errors.beta_lag_s, errors.v_tas_bias_kt, units.bank_bias_deg) == (0.3, 0.1, 2.0, 0.1)
    assert (PRESETS["iru"].r_deg_s, PRESETS["iru"].beta_deg) == (0.01, 0.1)


def test_units_are_sites_and_signals_only_where_they_are_chosen(bench):
    units, plain = bench.loop(sensors="iru"), bench.loop(sensors="white")
    assert plain.bus.names == ("r1", "r2", "r3")
    assert units.bus.names == ("r1", "r2", "r3", "phi1", "phi2", "phi3", "p1", "p2", "p3")
    assert units.bus.signals == {**plain.bus.signals, "p_units_deg_s": 3, "phi_units_deg": 3}
    assert units.bus.redundant("p_units_deg_s") == ("p1", "p2", "p3")
    chosen = {"plant": LateralLpvPlant, "sensors": PRESETS["iru"]}
    assert bench.benchmark.plant(chosen).sites == units.bus.sites
    assert bench.benchmark.plant(chosen) is bench.benchmark.plant(chosen)
    # numbers of its own beside those that the sensors have without units, all for good
    assert [number for number, _ in units.draws.streams] == [0, 576, 577]
    assert sorted(number for number, _ in units.before.streams) == [18, *range(3104, 3110)]


def test_law_and_detectors_get_voted_bank_angle_and_roll_rate_and_a_unit_may_be_lost_whole(bench):
    lost = [
        Jam.in_unit(unit)(kind="jam", sites=(f"{name}1",), onset_s=1.0, amplitude_percent=50.0)
        for name, unit in (("phi", "deg"), ("p", "deg/s"), ("r", "deg/s"))
    ]
    loop = bench.loop(sensors="iru", faults=[lost])
    now = bench.fly(loop, 2, 2.0, faults=[lost, []])
    for units, voted in (("phi_units_deg", "phi_deg"), ("p_units_deg_s", "p_deg_s"), ("r_deg_s", "r_voted_deg_s")):
        assert np.array_equal(now[voted], np.median(now[units], axis=1)), units
        assert (now[units][101:, 0, 0] == now[units][150, 0, 0]).all()
        assert abs(now[units][150, 0, 0]) > 15.0
    # the median shuts the lost unit out, and what it saw does not move the aircraft
    assert np.abs(now["phi_true_deg"][:, 0] - now["phi_true_deg"][:, 1]).max() < 0.05
