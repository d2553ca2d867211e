"""One fault on sites of several signals and units: one size in percent, one delay, one sign, numbers by position."""

import numpy as np
import pytest

from fddbench.faults.injection import SignalFaults
from fddbench.faults.jam import Jam
from fddbench.faults.noise import Noise
from fddbench.faults.oscillatory import Oscillatory
from fddbench.faults.runaway import Runaway
from fddbench.interfaces import FlightFaults, Site

N, T = 60, 0.01
# a benchmark with sites of two signals in mixed order: positions are addresses, rows are places
MIXED = (
    Site(name="elevator", signal="surface_deg", row=4, unit_name="deg", admissible=20.0, stops=(-15.0, 15.0)),
    Site(name="r2", signal="r_deg_s", row=1, unit_name="deg/s", admissible=40.0, stops=(-128.0, 128.0)),
    Site(name="r1", signal="r_deg_s", row=0, unit_name="deg/s", admissible=40.0, stops=(-128.0, 128.0)),
    Site(name="q1", signal="q_deg_s", row=0, unit_name="deg/s", admissible=10.0),
    Site(name="rudder", signal="surface_deg", row=2, unit_name="deg", admissible=30.0, stops=(-30.0, 30.0)),
)


def fly_mixed(faults, normals_at, n_cases=3):
    """Faulty signals by name, healthy ones zero; `normals_at` gives the four numbers of a consumer, (n_time, 4, n_cases)."""
    found = {}
    for signal in ("surface_deg", "r_deg_s", "q_deg_s"):
        step = SignalFaults(MIXED, signal, [faults], T)
        uniform = np.linspace(0.1, 0.9, len(MIXED))[np.newaxis, :, np.newaxis] * np.ones((len(faults), 1, n_cases))
        which = np.zeros(n_cases, dtype=int)
        constants = step.prepare(FlightFaults(lists=[faults], which=which, uniform=uniform))
        state, healthy = step.states.spread(step.start(constants), n_cases), np.zeros((len(step.sites), n_cases))
        for k in range(N):
            drawn = [normals_at(consumer)[k] for consumer, _ in step.draws.streams]
            numbers = step.draws.unpack(np.concatenate([*drawn, np.zeros((0, n_cases))]))
            state, shown = step.step(state, constants, numbers, healthy, float(k))
            for site, row in zip(step.sites, shown, strict=True):
                found.setdefault(site.name, []).append(row)
    return {name: np.array(rows) for name, rows in found.items()}


def consumer_normals(consumer, n_cases=3):
    return np.random.default_rng(consumer).normal(size=(N, 4, n_cases))


def test_sites_of_a_signal_stand_in_the_order_of_its_rows():
    step = SignalFaults(MIXED, "surface_deg", [[]], T)
    assert ([site.name for site in step.sites], step.rows) == (["rudder", "elevator"], [2, 4])
    assert [site.name for site in SignalFaults(MIXED, "r_deg_s", [[]], T).sites] == ["r1", "r2"]


def test_one_fault_on_sites_of_two_signals_has_one_size_in_percent_one_delay_and_one_sign():
    every = ("r2", "elevator", "r1")
    jam = Jam(kind="jam", sites=every, onset_s=0.1, delay_s=0.1, amplitude_percent=10.0, correlation="opposite")
    found = fly_mixed([jam], consumer_normals)
    for name, first, size in (("r2", 10, 4.0), ("elevator", 20, -2.0), ("r1", 30, 4.0)):
        expected = np.where(np.arange(N) >= first, size, 0.0)
        np.testing.assert_allclose(found[name], np.repeat(expected[:, None], 3, axis=1), rtol=1e-15)
    assert not found["q1"].any()
    assert not found["rudder"].any()


def test_a_runaway_ends_at_the_stops_of_each_site():
    fast = Runaway(kind="runaway", sites=("elevator", "r1", "q1", "rudder"), onset_s=0.0, rate_percent_s=1e4)
    found = fly_mixed([fast], consumer_normals)
    assert [found[name][-1, 0] for name in ("elevator", "r1", "rudder")] == [15.0, 128.0, 30.0]
    assert found["q1"][-1, 0] == pytest.approx(0.59 * 1000.0)  # no stops


def test_noise_on_sites_of_two_signals_is_the_same_or_each_site_s_own_number():
    """Identical: number 0 of the slot everywhere. Independent: that of the site's position; the fifth has one of its own."""
    names = tuple(site.name for site in MIXED)
    sigma = np.sqrt(np.array([20.0, 40.0, 40.0, 10.0, 30.0]) / 100.0)
    own = [consumer_normals(64)[:, place] for place in range(4)] + [consumer_normals(1024)[:, 0]]
    for correlation in ("identical", "independent"):
        noise = Noise(kind="noise", sites=names, onset_s=0.0, variance_percent=1.0, correlation=correlation)
        found = fly_mixed([noise], consumer_normals)
        for position, name in enumerate(names):
            expected = sigma[position] * own[position if correlation == "independent" else 0]
            np.testing.assert_allclose(found[name], expected, rtol=1e-15)


def test_a_drawn_phase_is_that_of_the_position_in_the_benchmark():
    names = tuple(site.name for site in MIXED)
    sine = Oscillatory(
        kind="oscillatory", sites=names, onset_s=0.0, amplitude_percent=1.0, frequency_hz=1.0, phase="uniform",
        correlation="independent",
    )  # fmt: skip
    found = fly_mixed([sine], consumer_normals)
    for position, site in enumerate(MIXED):
        turn = 2 * np.pi * (0.1 + 0.2 * position)
        np.testing.assert_allclose(found[site.name][0], 0.01 * site.admissible * np.sin(turn), atol=1e-12)
