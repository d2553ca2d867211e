"""The monitor: no sensor and no side is special, wrong clocks are refused, and what is wrong is found."""

from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from fddbench import gallery
from fddbench.blocks.layout import Nothing
from fddbench.campaign.load import read_campaign
from fddbench.detection.yaw_rate_best import YawRateBest
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Site
from fddbench.results.table import load
from fddbench.runner.run import run_campaign
from fddbench.voting.median import Median

SINGLE = (
    "phi_deg",
    "beta_deg",
    "p_deg_s",
    "r_voted_deg_s",
    "v_tas_m_s",
    "mass_kg",
    "x_cg_ratio",
    "altitude_ft",
    "v_cas_kt",
)


def bus(n=3, sample_s=0.01):
    sites = tuple(Site(name=f"r{i + 1}", signal="r_deg_s", row=i, unit_name="deg/s", admissible=40.0) for i in range(n))
    return Bus(sample_s=sample_s, sites=sites, signals=dict.fromkeys(SINGLE, 0) | {"r_deg_s": n, "surface_deg": 13})


def gains(**changed):
    text = (gallery.folder("detectors") / "yaw_rate_best.yaml").read_text(encoding="utf-8")
    return YawRateBest.Gains(**yaml.safe_load(text)["gains"] | changed)


def declared_of(r_deg_s, sign=1.0):
    """Declared sites, (n_time, 3), and the largest ratio, of sensors, (n_time, 3), in straight and level flight."""
    detector = YawRateBest.from_design(gains(), bus())
    condition = {"v_tas_m_s": 199.28, "mass_kg": 200e3, "x_cg_ratio": 0.3, "altitude_ft": 20e3, "v_cas_kt": 290.0}
    still = {name: np.array([value]) for name, value in condition.items()}
    state, declared, ratios = detector.states.spread(detector.start(Nothing()), 1), [], []
    air = np.random.default_rng(7).standard_normal((len(r_deg_s), 15))
    for reading, noise in zip(r_deg_s, air, strict=True):
        r = sign * reading[:, np.newaxis]
        surfaces = sign * 0.01 * noise[2:, np.newaxis]
        measured = SimpleNamespace(
            **still, r_deg_s=r, r_voted_deg_s=Median().vote(r), surface_deg=surfaces,
            phi_deg=sign * 0.02 * noise[:1], beta_deg=sign * 0.05 * noise[1:2], p_deg_s=np.zeros(1),
        )  # fmt: skip
        state, verdict = detector.step(state, Nothing(), Nothing(), measured)
        declared.append(verdict.declared[:, 0])
        ratios.append(float(verdict.residual[0]))
    return np.array(declared), np.array(ratios)


def sensors(fault, seconds=8.0, onset_s=4.0):
    """Three sensors with noise and a small bias; `fault` gives what is added to each, (3,), of the time since the onset [s]."""
    n = round(100 * seconds)
    r = 0.01 * np.random.default_rng(3).standard_normal((n, 3)) + np.array([0.02, -0.01, 0.03])
    time_s = 0.01 * np.arange(n) - onset_s
    return r + np.array([fault(t) if t >= 0.0 else np.zeros(3) for t in time_s])


JAM, PAIR = np.array([0.5, 0.0, 0.0]), np.array([1.0, 1.0, 0.0])


@pytest.mark.parametrize(
    ("fault", "expected", "within_s"),
    [
        (lambda t: JAM, [1, 0, 0], 0.2),
        (lambda t: PAIR, [1, 1, 0], 0.2),
        (lambda t: np.array([1.0, -1.0, 0.0]), [1, 1, 0], 0.2),
        (lambda t: 0.3 * t * PAIR, [1, 1, 0], 3.0),
        (lambda t: 1.5 * np.sin(0.5385 * t) * PAIR[::-1], [0, 1, 1], 0.5),
        (lambda t: 128.0 * np.sign(np.sin(60.0 * t)) * JAM, [1, 0, 0], 0.2),
        (lambda t: JAM + (0.0 if t < 2.0 else 1.0) * np.array([0.0, 0.0, 1.0]), [1, 0, 1], None),
        (lambda t: np.zeros(3), [0, 0, 0], None),
    ],
    ids=["jam", "pair", "opposite", "ramp", "oscillation", "wild", "one after the other", "healthy"],
)
def test_finds_what_is_wrong(fault, expected, within_s):
    declared, _ = declared_of(sensors(fault))
    assert declared[-1].tolist() == expected
    assert not declared[:400].any()
    if within_s is not None:
        assert declared[400 + round(100 * within_s)].tolist() == expected


@pytest.mark.parametrize("order", [(1, 2, 0), (2, 1, 0)])
def test_no_sensor_is_special(order):
    r = sensors(lambda t: 0.4 * t * PAIR)
    declared, ratios = declared_of(r)
    of_others, ratios_of_others = declared_of(r[:, order])
    np.testing.assert_array_equal(of_others, declared[:, order])
    np.testing.assert_allclose(ratios_of_others, ratios, rtol=1e-6, atol=1e-9)


def test_the_mirrored_flight_has_the_mirrored_verdict():
    r = sensors(lambda t: 0.4 * t * PAIR)
    (declared, ratios), (mirrored, of_mirrored) = declared_of(r), declared_of(r, sign=-1.0)
    np.testing.assert_array_equal(mirrored, declared)
    np.testing.assert_array_equal(of_mirrored, ratios)


def test_one_sensor_always_stays():
    wild = 20.0 * np.random.default_rng(5).standard_normal((600, 3))
    declared, _ = declared_of(wild)
    assert declared.sum(axis=1).max() <= 2


def test_another_clock_is_refused():
    with pytest.raises(DesignError, match=r"the gains are for 0\.01 s, this campaign samples every 0\.02 s"):
        YawRateBest.from_design(gains(), bus(sample_s=0.02))


def test_other_sensors_are_refused():
    with pytest.raises(
        DesignError, match="needs 3 sensors on r_deg_s and 13 rows of surface_deg, this benchmark has 4 and 13"
    ):
        YawRateBest.from_design(gains(), bus(n=4))


def test_every_published_fault_is_right(tmp_path):
    campaign = read_campaign(gallery.folder("campaigns") / "smoke.yaml", ["detectors=[yaw_rate_best]"])
    run_campaign(campaign, tmp_path / "smoke", jobs=1)
    rows = load(tmp_path / "smoke")
    assert rows["outcome"].value_counts().to_dict() == {"right": 50, "quiet": 5}
    assert rows["detection_time_s"].max() < 1.4
