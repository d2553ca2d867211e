from dataclasses import replace

import numpy as np
import pandas as pd

from fddbench.reporting.signals import rank_of_cases, signal_panels, window


def test_window_runs_from_a_second_before_the_onset_to_shortly_after_the_last_declaration(make_report):
    (recording,) = make_report(scenarios=("jam_a",), flights=5).recordings
    first, last = (recording.time_s[i] for i in window(recording))
    assert first == 1.0
    assert 3.2 < last < 4.0
    assert window(replace(recording, onset_s=None)) == (0, len(recording.time_s))


def test_the_worst_flight_fails_with_most_detectors_then_is_slowest(make_report):
    report = make_report(scenarios=("jam_a",), detectors=("d", "e"), flights=4, lost={0: ("error", "ValueError")})
    rows, (recording,) = report.rows, report.recordings
    ratio = [None, None, 0.1, 0.1, 0.3, 0.1, 0.2, 0.1]
    rows["normalized_detection_time"] = pd.array(ratio, dtype=rows["normalized_detection_time"].dtype)
    assert rank_of_cases(recording, rows)[0] == 2
    outcome = [None, None, "right", "right", "right", "right", "missed", "right"]
    rows["outcome"] = pd.array(outcome, dtype=rows["outcome"].dtype)
    assert rank_of_cases(recording, rows).tolist() == [3, 2, 1, 0]


def test_a_threshold_lies_with_the_signal_recorded_before_it():
    names = ("n_declared", "residual", "reconstruction_deg_s", "threshold_deg_s", "deviation_deg_s")
    expected = [["reconstruction_deg_s", "threshold_deg_s"], ["deviation_deg_s"], ["n_declared"]]
    assert signal_panels(dict.fromkeys(names, np.zeros((1, 1)))) == expected
    plain = dict.fromkeys(("n_declared", "residual", "energy"), np.zeros((1, 1)))
    assert signal_panels(plain) == [["residual"], ["energy"], ["n_declared"]]
