"""Bands of how manoeuvres are flown."""

import numpy as np

from fddbench.interfaces import Recording
from fddbench.reporting.motion import bands, motion_picture


def recording(signals, onset_s=None):
    n_time, n_cases = next(iter(signals.values())).shape
    cases = tuple(f"a/0/0/{i}" for i in range(n_cases))
    return Recording(
        scenario="a", cases=cases, time_s=0.01 * np.arange(n_time), onset_s=onset_s, signals=signals, detectors={}
    )


def test_bands_are_quantiles_of_the_flights_that_still_fly():
    values = np.arange(101.0) * np.ones((3, 1))
    values[1, 51:] = np.nan
    values[2] = np.nan
    found = bands(values)
    assert found[:, 0].tolist() == [0.0, 5.0, 50.0, 95.0, 100.0]
    assert found[:, 1].tolist() == [0.0, 2.5, 25.0, 47.5, 50.0]
    assert np.isnan(found[:, 2]).all()


def test_a_panel_for_each_signal_that_there_is():
    signals = {name: np.random.default_rng(0).normal(size=(50, 4)) for name in ("phi_true_deg", "mach")}
    assert motion_picture(recording(signals), ("phi_true_deg", "mach", "no_such")) is not None
    assert motion_picture(recording(signals), ("phi_true_deg",)) != motion_picture(recording(signals), ("mach",))
    assert motion_picture(recording(signals), ("no_such",)) is None
    assert motion_picture(recording({"mach": np.zeros((5, 0))}), ("mach",)) is None
