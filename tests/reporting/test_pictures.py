from dataclasses import replace

import numpy as np
import pandas as pd
from fddbench.reporting.figures import detection_curve, envelope, label
from hypothesis import given
from hypothesis import strategies as st

from fddbench.reporting.pictures import thinned
from fddbench.reporting.signals import signal_panels, window, worst_case


@given(st.lists(st.none() | st.floats(0, 10), min_size=1, max_size=30))
def test_curve_rises_and_ends_at_the_detected_share(times):
    time_s = np.array([np.nan if t is None else t for t in times])
    corners, share = detection_curve(time_s, np.full(len(times), 12.0), 20.0)
    assert np.all(np.diff(corners) >= 0)
    assert np.all(np.diff(share) >= 0)
    assert share[0] == 0.0
    assert np.isclose(share[-1], 100.0 * np.mean(~np.isnan(time_s)))
    assert corners[-1] == (12.0 if np.isnan(time_s).any() else 20.0)


@given(st.integers(1, 4000), st.integers(1, 3))
def test_thinned_signals_keep_every_extreme(n_time, n_cases):
    values = np.random.default_rng(n_time).standard_normal((n_time, n_cases))
    time_s, kept = thinned(np.arange(n_time) * 0.01, values, blocks=100)
    assert len(time_s) == len(kept) <= max(400, n_time if n_time < 300 else 0)
    np.testing.assert_array_equal(kept.max(axis=0), values.max(axis=0))
    np.testing.assert_array_equal(kept.min(axis=0), values.min(axis=0))
    assert np.all(np.diff(time_s) >= 0)


def test_labels_take_the_unit_from_the_name():
    assert label("reconstruction_deg_s") == "reconstruction [deg/s]"
    assert label("p_x_cg_ratio") == "x cg [-]"
    assert label("n_declared") == "n declared"


def test_window_runs_from_a_second_before_the_onset_to_shortly_after_the_last_declaration(make_report):
    (recording,) = make_report(scenarios=("jam_a",), flights=5).recordings
    first, last = (recording.time_s[i] for i in window(recording))
    assert first == 1.0
    assert 3.2 < last < 4.0
    assert window(replace(recording, onset_s=None)) == (0, len(recording.time_s))


def test_worst_case_has_a_wrong_site_then_is_not_found_then_slowest(make_report):
    report = make_report(scenarios=("jam_a",), detectors=("d",), flights=4, lost={0: ("error", "ValueError")})
    rows, (recording,) = report.rows, report.recordings
    rows["detection_time_s"] = pd.array([None, 1.0, 3.0, 2.0], dtype=rows["detection_time_s"].dtype)
    assert worst_case(recording, rows, "d") == 2
    rows["detection_time_s"] = pd.array([None, 1.0, 3.0, None], dtype=rows["detection_time_s"].dtype)
    assert worst_case(recording, rows, "d") == 3
    rows["wrong_site_time_s"] = pd.array([None, 0.5, None, None], dtype=rows["wrong_site_time_s"].dtype)
    assert worst_case(recording, rows, "d") == 1


def test_envelope_pairs_what_the_benchmark_says(make_rows):
    rows = make_rows(("jam_a",), ("d",), 5)
    assert envelope(rows, (("v_cas_kt", "altitude_ft"),)) != envelope(rows, (("v_cas_kt", "mass_kg"),))
    assert envelope(rows, (("no_such", "mass_kg"),)) == envelope(rows)


def test_envelope_shows_only_what_varies(make_rows):
    assert envelope(make_rows(("jam_a",), ("d",), 3)) is not None
    assert envelope(make_rows(("jam_a",), ("d",), 1)) is None
    rows = make_rows(("jam_a",), ("d",), 5)
    assert envelope(rows.drop(columns=["p_v_cas_kt", "p_x_cg_ratio"])) is not None
    assert envelope(rows[["case", "status", "p_mass_kg"]]) is None


def test_a_threshold_lies_with_the_signal_recorded_before_it():
    names = ("n_declared", "residual", "reconstruction_deg_s", "threshold_deg_s", "deviation_deg_s")
    expected = [["reconstruction_deg_s", "threshold_deg_s"], ["deviation_deg_s"], ["n_declared"]]
    assert signal_panels(dict.fromkeys(names, np.zeros((1, 1)))) == expected
    plain = dict.fromkeys(("n_declared", "residual", "energy"), np.zeros((1, 1)))
    assert signal_panels(plain) == [["residual"], ["energy"], ["n_declared"]]
