"""The whole scheme on made-up signals: what it declares, when, and what each block contributes."""

from types import SimpleNamespace

import numpy as np
import pytest
from pydantic import ValidationError

from fddbench.blocks.layout import Nothing
from fddbench.detection.sliding_mode import SlidingMode
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Site
from fddbench.voting.median import Median

SIGNALS = {
    **dict.fromkeys(("phi_deg", "beta_deg", "p_deg_s", "r_voted_deg_s", "v_tas_m_s"), 0),
    "r_deg_s": 3,
    "surface_deg": 13,
    **dict.fromkeys(("mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt"), 0),
}


SITES = tuple(Site(name=f"r{i + 1}", signal="r_deg_s", row=i, unit_name="deg/s", admissible=40.0) for i in range(3))


def detector(gains, sample_s=0.01):
    return SlidingMode.from_design(gains, Bus(sample_s=sample_s, sites=SITES, signals=SIGNALS))


def fly(scheme, r, **more):
    """Declared sites (n_time, 3, n_cases) and residual (n_time, n_cases) of an aircraft at rest with sensors r."""
    n_cases = r.shape[2]
    still = {name: np.zeros((rows, n_cases) if rows else n_cases) for name, rows in SIGNALS.items()}
    centre = {"v_tas_m_s": 199.28, "mass_kg": 200e3, "x_cg_ratio": 0.3, "altitude_ft": 20e3, "v_cas_kt": 290.0}
    still |= {name: np.full(n_cases, value) for name, value in centre.items()}
    nothing = Nothing()
    state, declared, residual = scheme.states.spread(scheme.start(nothing), n_cases), [], []
    for k, sample in enumerate(r):
        measured = still | {"r_deg_s": sample, "r_voted_deg_s": Median().vote(sample)}
        measured |= {name: values[k] for name, values in more.items()}
        state, verdict = scheme.step(state, nothing, nothing, SimpleNamespace(**measured))
        declared.append(verdict.declared)
        residual.append(verdict.residual)
    return np.array(declared), np.array(residual)


def step_fault(sites, size=2.0, first=200, n=420):
    r = np.zeros((n, 3, 1))
    r[first:, list(sites)] = size
    return r


def declarations(declared):
    """{number of sites: first sample with that number}."""
    n = declared.sum(axis=1)[:, 0]
    return {int(value): int(np.flatnonzero(n == value)[0]) for value in np.unique(n) if value > 0}


@pytest.mark.parametrize("sites", [(0, 1), (0, 2), (1, 2)])
@pytest.mark.parametrize("name", ["published", "equation_19"])
def test_a_common_mode_pair_is_declared_after_a_tenth_of_a_second(design, name, sites):
    declared, _ = fly(detector(design(name)), step_fault(sites))
    assert declarations(declared) == {2: 210}
    assert np.flatnonzero(declared[-1, :, 0]).tolist() == list(sites)


@pytest.mark.parametrize("site", [0, 1, 2])
def test_one_sensor_is_declared_after_a_second(design, site):
    declared, residual = fly(detector(design()), step_fault((site,)))
    assert declarations(declared) == {1: 300}
    assert np.flatnonzero(declared[-1, :, 0]).tolist() == [site]
    assert residual.max() < 1e-6  # the vote hides it from the observer


def test_without_its_observer_the_scheme_never_declares_two(design):
    rng = np.random.default_rng(0)
    pair = np.repeat(step_fault((0, 1)), 6, axis=2)
    pair[:, :2] += 50.0 * rng.normal(size=(420, 1, 6)) * (np.arange(420)[:, None, None] >= 200)
    declared, residual = fly(detector(design("off")), pair)
    assert declared.sum(axis=1).max() == 1.0
    assert not residual.any()
    declared, _ = fly(detector(design("off")), step_fault((0, 1)))
    assert declared[-1, :, 0].tolist() == [0.0, 0.0, 1.0]  # the healthy one


@pytest.mark.parametrize("sample_s", [0.005, 0.01, 0.02])
def test_confirmation_times_are_times(design, sample_s):
    scheme = detector(design(), sample_s)
    assert declarations(fly(scheme, step_fault((0, 1)))[0]) == {2: 200 + round(0.1 / sample_s)}
    assert declarations(fly(scheme, step_fault((2,)))[0]) == {1: 200 + round(1.0 / sample_s)}


def test_reconstruction_is_filtered_twice_and_settles_at_the_dc_gain(design):
    """Inputs and output each pass 0.05 s: the step response of two equal lags, times 0.9825, in deg/s."""
    _, residual = fly(detector(design()), step_fault((0, 1), first=0, n=300))
    time = np.arange(1, 301) * 0.01
    two_lags = 1 - (1 + time / 0.05) * np.exp(-time / 0.05)
    expected, found = 2.0 * 0.98253 * two_lags, residual[:, 0] * 0.25
    assert (found < expected + 1e-3).all()
    assert (found[2:] > expected[:-2] - 0.01).all()  # filter and injection cost one to two samples more
    assert residual[-1, 0] * 0.25 == pytest.approx(2.0 * 0.98253, abs=1e-3)


def test_one_may_become_two_but_never_less(design):
    r = step_fault((0,), n=900)
    r[350:, 1] = 2.0  # the second sensor follows
    r[600:] = 0.0  # and all recover
    declared, _ = fly(detector(design()), r)
    n = declared.sum(axis=1)[:, 0]
    assert (np.diff(n) >= 0.0).all()
    assert declared[340, :, 0].tolist() == [1.0, 0.0, 0.0]
    assert declared[-1, :, 0].tolist() == [1.0, 1.0, 0.0]


def test_surfaces_at_work_open_the_threshold(design):
    surface = np.zeros((420, 13, 1))
    surface[:, 1] = 24.0
    declared, _ = fly(detector(design()), step_fault((0, 1), size=0.8), surface_deg=surface)
    quiet, _ = fly(detector(design()), step_fault((0, 1), size=0.8))
    assert 2 in declarations(quiet)
    assert declarations(quiet)[2] < declarations(declared).get(2, 10**6)


def test_energy_monitor_raises_the_flag_and_chooses_the_noisy_sensor(design):
    """Noise too small for the held flag, on a sensor that is not the outlier when the time expires."""
    r = np.zeros((420, 3, 1))
    r[:, 2] = 0.29
    r[200:, 1] = (
        0.2 * np.where(np.arange(220) % 4 < 2, 1.0, -1.0)[:, None] * np.where(np.arange(220) % 2, 1, -1)[:, None]
    )
    limits = {"energy_limit_deg_s2": 15.0}
    declared, _ = fly(detector(design(**limits)), r)
    assert declared[-1, :, 0].tolist() == [0.0, 1.0, 0.0]
    off, _ = fly(detector(design(energy_limit_deg_s2=1e9)), r)
    assert not off.any()


def random_signals(seed, n_cases=6, n=260):
    rng = np.random.default_rng(seed)
    onset = rng.integers(20, 100, size=n_cases)
    r = 0.01 * rng.normal(size=(n, 3, n_cases))
    size = rng.choice([0.5, 2.0, 50.0], size=(3, n_cases)) * rng.choice([0, 1], size=(3, n_cases))
    wave = np.where(rng.random((n, 3, n_cases)) < 0.5, 1.0, rng.choice([1.0, -1.0]))
    r += size * wave * (np.arange(n)[:, None, None] >= onset)
    more = {
        "surface_deg": np.cumsum(0.05 * rng.normal(size=(n, 13, n_cases)), axis=0),
        "phi_deg": np.cumsum(0.05 * rng.normal(size=(n, n_cases)), axis=0),
    }
    return r, more


@pytest.mark.parametrize("seed", range(3))
def test_what_holds_for_any_signals(design, seed):
    """Sites latched, as many as declared, never fewer; causal; no case sees its company."""
    scheme = detector(design(confirm_one_s=0.3))
    r, more = random_signals(seed)
    declared, residual = fly(scheme, r, **more)
    n = declared.sum(axis=1)
    assert set(np.unique(declared)) <= {0.0, 1.0}
    assert n.max() == 2.0
    assert (np.diff(n, axis=0) >= 0.0).all()
    changed = (np.diff(declared, axis=0) != 0.0).any(axis=1)
    assert np.array_equal(changed, np.diff(n, axis=0) > 0.0)
    cut = 150
    early, early_residual = fly(scheme, r[:cut], **{name: x[:cut] for name, x in more.items()})
    assert np.array_equal(early, declared[:cut])
    assert early_residual.tobytes() == np.ascontiguousarray(residual[:cut]).tobytes()
    for i in (0, 3):
        alone, own = fly(scheme, r[:, :, [i]], **{name: x[..., [i]] for name, x in more.items()})
        assert np.array_equal(alone, declared[:, :, [i]])
        assert own.tobytes() == np.ascontiguousarray(residual[:, [i]]).tobytes()


def test_renaming_the_sensors_renames_the_declared_sites(design):
    r, more = random_signals(7)
    declared, _ = fly(detector(design(confirm_one_s=0.3)), r, **more)
    order = [2, 0, 1]
    again, _ = fly(detector(design(confirm_one_s=0.3)), r[:, order], **more)
    assert np.array_equal(again, declared[:, order])


def test_what_it_refuses(design):
    with pytest.raises(DesignError, match="needs the signals .'phi_deg'"):
        SlidingMode.from_design(design(), Bus(sample_s=0.01, sites=SITES[:1], signals={"r_deg_s": 3}))
    with pytest.raises(DesignError, match="energy_count = 40 can never be reached in a window of 30 samples"):
        detector(design(energy_count=40))
    for wrong in ({"delta": 0.0}, {"energy_window_samples": 53}, {"error_pole_1_s": (-1, -1, -1, 0.1)}, {"w": (1,)}):
        with pytest.raises(ValidationError, match="Input should be|at least 4"):
            design(**wrong)
