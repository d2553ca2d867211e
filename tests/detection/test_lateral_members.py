"""The model-based detectors of the yaw rate: their recipes remake their numbers, and they say what they lack."""

from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from fddbench import gallery, kinds
from fddbench.benchmarks.jet_engine import JetEngine
from fddbench.blocks.layout import Nothing
from fddbench.design.recipe import cook
from fddbench.detection.gust_filter import LATERAL_SIGNALS
from fddbench.errors import DesignError
from fddbench.flight.lateral_lpv import lateral_lpv
from fddbench.interfaces import Bus, Site

DESIGNS = ("kalman_gust", "observer_bank", "multiple_model", "unknown_input_observer", "parity_space_yaw_rate")


def numbers(nest):
    """All numbers of a design, in the order of the file."""
    if isinstance(nest, dict):
        return [x for value in nest.values() for x in numbers(value)]
    return [x for value in nest for x in numbers(value)] if isinstance(nest, (list, tuple)) else [nest]


@pytest.mark.parametrize("name", DESIGNS)
def test_its_recipe_remakes_it(name):
    path = gallery.folder("detectors") / f"{name}.yaml"
    np.testing.assert_allclose(
        numbers(cook(path).gains), numbers(yaml.safe_load(path.read_text())["gains"]), rtol=1e-6, atol=1e-9
    )


@pytest.mark.parametrize("name", DESIGNS)
def test_it_says_what_a_benchmark_lacks(name):
    data = yaml.safe_load((gallery.folder("detectors") / f"{name}.yaml").read_text())
    kind = kinds.load("detector", data["kind"])
    bus = Bus(sample_s=0.05, sites=JetEngine.sites, signals={"y": 3, "u": 3})
    with pytest.raises(DesignError, match=r"needs the signals .*'beta_deg'.*this benchmark has"):
        kind.from_design(kind.Gains.model_validate(data["gains"]), bus)


def shown(name, signal, *, gust_m_s, offset_deg_s=0.0, n=250):
    """A signal of a detector over the linear model itself, without noise, in any gust; r1 is off from sample 200 on."""
    data = yaml.safe_load((gallery.folder("detectors") / f"{name}.yaml").read_text())
    kind, model = kinds.load("detector", data["kind"]), lateral_lpv()
    sites = tuple(Site(name=f"r{i + 1}", signal="r_deg_s", row=i, unit_name="deg/s", admissible=40.0) for i in range(3))
    rows = dict.fromkeys(LATERAL_SIGNALS, 0) | {"r_deg_s": 3, "surface_deg": 13}
    made = kind.from_design(kind.Gains.model_validate(data["gains"]), Bus(sample_s=0.01, sites=sites, signals=rows))
    A, B = (M[..., 0] for M in model.matrices(np.zeros((4, 1))))
    v_tas_m_s, known = 199.28, dict(zip(model.names, model.trim, strict=True))
    state, x, found = made.states.spread(made.start(Nothing()), 1), np.zeros(4), []
    for k in range(n):
        surface_deg = np.zeros(13)
        surface_deg[0] = np.sin(0.03 * k)
        phi, v_y, p, r = x
        rates = np.full((3, 1), np.rad2deg(r))
        rates[0] += offset_deg_s if k >= 200 else 0.0
        one = {"phi_deg": np.rad2deg(phi), "beta_deg": np.rad2deg(np.arcsin(v_y / v_tas_m_s)), "p_deg_s": np.rad2deg(p)}
        one |= {"r_voted_deg_s": np.rad2deg(r), "v_tas_m_s": v_tas_m_s}
        measured = SimpleNamespace(
            r_deg_s=rates,
            surface_deg=surface_deg[:, np.newaxis],
            **known,
            **{key: np.array([v]) for key, v in one.items()},
        )
        state, verdict = made.step(state, Nothing(), Nothing(), measured)
        found.append(float(verdict.signals[signal][0]))
        x = x + 0.01 * (A @ x + B @ surface_deg)
        x[1] += gust_m_s[k]
    return np.abs(found)


@pytest.mark.parametrize(
    ("name", "signal"), [("unknown_input_observer", "residual_1"), ("parity_space_yaw_rate", "parity_1")]
)
def test_no_gust_moves_the_residuals_of_what_is_blind_to_it_and_a_fault_does(name, signal):
    gust_m_s = np.random.default_rng(8).standard_normal(250)
    assert shown(name, signal, gust_m_s=gust_m_s).max() < 1e-6
    assert shown(name, signal, gust_m_s=gust_m_s, offset_deg_s=1.0)[200:].max() > 0.5
    assert shown("observer_bank", "residual_1", gust_m_s=gust_m_s).max() > 1e-3  # it knows gusts, but no such one
