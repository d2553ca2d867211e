"""The energy monitor against one that keeps its window in a deque."""

from collections import deque

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.blocks.layout import Nothing
from fddbench.detection.sliding_mode.energy_monitor import EnergyMonitor

signals = st.lists(
    st.tuples(*[st.sampled_from((-5.0, -0.4, -0.2, 0.0, 0.1, 0.25, 0.31, 3.0))] * 3), min_size=1, max_size=120
)


def monitor(window=30, count=8, sample_s=0.01):
    return EnergyMonitor(window=window, count=count, limit_deg_s2=30.0, sample_s=sample_s, n_sites=3)


def run(detector, r):
    nothing = Nothing()
    state, tripped, energies = detector.states.spread(detector.start(nothing), r.shape[2]), [], []
    for sample in r:
        state, now = detector.step(state, nothing, nothing, sample)
        tripped.append(now.tripped)
        energies.append(now.energy)
    return np.array(tripped), np.array(energies)


@settings(max_examples=60)
@given(signals, st.integers(2, 52), st.integers(1, 12), st.sampled_from((0.01, 0.02)))
def test_trips_like_a_window_kept_in_a_deque(values, window, count, sample_s):
    r = np.array(values)[:, :, np.newaxis]
    tripped, _ = run(monitor(window, count, sample_s), r)
    windows = [deque(maxlen=window) for _ in range(3)]
    for k, sample in enumerate(r[:, :, 0]):
        for site in range(3):
            slope = (sample[site] - r[k - 1, site, 0]) / sample_s if k else 0.0
            windows[site].append(abs(slope) / 30.0 > 1.0)
            assert tripped[k, site, 0] == (sum(windows[site]) >= count), (k, site)


@settings(max_examples=20)
@given(signals)
def test_energy_is_a_running_mean_of_the_squared_derivative(values):
    r = np.array(values)[:, :, np.newaxis]
    _, energies = run(monitor(), r)
    expected = np.zeros((3, 1))
    for k in range(1, len(r)):
        slope = (r[k] - r[k - 1]) / 0.01 / 30.0
        expected = (1 - 1 / 30) * expected + slope**2 / 30
        np.testing.assert_allclose(energies[k], expected, rtol=1e-9, atol=1e-12)
    assert (energies >= 0.0).all()


def test_an_offset_at_the_start_is_no_derivative():
    tripped, energies = run(monitor(count=1), np.full((5, 3, 1), 1e3))
    assert not tripped.any()
    assert not energies.any()


def test_a_long_flight_of_exceedances_stays_exact():
    """The register of the widest window is full of ones all the time and loses no bit."""
    r = np.zeros((3000, 3, 1))
    r[::2, 0] = 1.0
    tripped, _ = run(monitor(52, 52), r)
    assert np.flatnonzero(tripped[:, 0, 0])[0] == 52
    assert tripped[52:, 0].all()
    assert not tripped[:, 1:].any()
    r[1500] = r[1499]
    tripped, _ = run(monitor(52, 52), r)
    assert not tripped[1500:1552, 0].any()
    assert tripped[1600:, 0].all()


@pytest.mark.parametrize(("bits", "trips"), [(7, False), (8, True)])
def test_seven_spikes_in_thirty_samples_are_too_few_and_eight_are_enough(bits, trips):
    r = np.zeros((100, 3, 1))
    for spike in range(bits):
        r[40 + 3 * spike :, 1] = float(spike % 2 == 0)
    tripped, _ = run(monitor(), r)
    assert tripped[:, 1].any() == trips
    assert not tripped[:, [0, 2]].any()
