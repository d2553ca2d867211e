"""Straight flight of the yaw-rate bus without an aircraft: sensors read what a test says, everything else stands at trim."""

from types import SimpleNamespace

import numpy as np
import yaml

from fddbench import gallery, kinds
from fddbench.blocks.layout import Nothing
from fddbench.interfaces import Bus, Site
from fddbench.voting.median import Median

NO = Nothing()
T = 0.01
AT_TRIM = {"mass_kg": 200e3, "x_cg_ratio": 0.3, "altitude_ft": 20e3, "v_cas_kt": 290.0, "v_tas_m_s": 199.3}
SINGLE = ("phi_deg", "beta_deg", "p_deg_s", "r_voted_deg_s", *AT_TRIM)


def bus(n_sensors=3, without=()):
    sites = tuple(
        Site(name=f"r{i + 1}", signal="r_deg_s", row=i, unit_name="deg/s", admissible=40.0) for i in range(n_sensors)
    )
    signals = dict.fromkeys(SINGLE, 0) | {"r_deg_s": n_sensors, "surface_deg": 13}
    return Bus(sample_s=T, sites=sites, signals={name: rows for name, rows in signals.items() if name not in without})


def shipped(design, on=None, **change):
    """Detector of a shipped design, with some of its gains changed."""
    data = yaml.safe_load((gallery.folder("detectors") / f"{design}.yaml").read_text(encoding="utf-8"))
    kind = kinds.load("detector", data["kind"])
    return kind.from_design(kind.Gains.model_validate(data["gains"] | change), on or bus())


def measured(r_deg_s, **other):
    """A sample of the bus, everything at trim but the sensors, (n_sensors, n_cases), and what is given."""
    n = r_deg_s.shape[1]
    values = {name: np.zeros(n) for name in SINGLE} | {name: np.full(n, value) for name, value in AT_TRIM.items()}
    values |= {"r_deg_s": r_deg_s, "r_voted_deg_s": Median().vote(r_deg_s), "surface_deg": np.zeros((13, n))}
    return SimpleNamespace(**(values | other))


def flown(detector, r_deg_s):
    """Verdicts on sensors (n_time, n_sensors, n_cases)."""
    x, verdicts = detector.states.spread(detector.start(NO), r_deg_s.shape[2]), []
    for sample in r_deg_s:
        x, verdict = detector.step(x, NO, NO, measured(sample))
        verdicts.append(verdict)
    return verdicts


def noisy(faults, *, n=120, first=60, seed=0, moving=0.0, n_sensors=3):
    """Sensors with white noise, moving by so many deg/s in a sample, and faults: row of a sensor → values from `first` on."""
    r = 0.01 * np.random.default_rng(seed).normal(size=(n, n_sensors, 1)) + moving * np.arange(n)[:, None, None]
    for i, values in faults.items():
        r[first:, i, 0] += values
    return r


def declared(detector, r_deg_s):
    """Sites declared in the end."""
    last = flown(detector, r_deg_s)[-1].declared[:, 0]
    return {i for i in range(len(last)) if last[i] > 0.0}
