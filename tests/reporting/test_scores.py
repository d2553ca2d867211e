"""Scores for version control: outcomes and false alarms, plain numbers."""

import yaml

from fddbench.metrics.alarms import summarize_alarms
from fddbench.metrics.summary import summarize
from fddbench.reporting.scores import scores_text


def test_scores_are_yaml_of_counts_and_times(make_rows):
    rows = make_rows(("jam_b", "healthy"), ("sliding_mode", "voting_monitor"), 6)
    found = yaml.safe_load(
        scores_text(
            summarize(rows, in_sample=["voting_monitor"]),
            summarize_alarms(rows, in_sample=["voting_monitor"]),
            {"campaign": "demo"},
        )
    )
    assert found["provenance"]["campaign"] == "demo"
    lines = {(line["scenario"], line["detector"]): line for line in found["scores"]}
    assert lines["jam_b", "voting_monitor"] == {
        "scenario": "jam_b", "detector": "voting_monitor", "in_sample": True, "flights": 6, "flown": 6, "infeasible": 0,
        "failed": 0, "departed": 0, "wrong_site": 6, "right": 0, "late": 0, "missed": 0, "undecided": 0, "false_alarm": 0,
        "isolated": 0, "over_declared": 0, "detections": 0, "changes_max": 1, "margin_healthy_max": 0.4,
    }  # fmt: skip
    assert "in_sample" not in lines["jam_b", "sliding_mode"]
    assert lines["healthy", "sliding_mode"]["quiet"] == 6
    first = found["false_alarms"][0]
    assert (first["detector"], first["distinct_flights"], first["alarms"], first["exposure_h"]) == (
        "sliding_mode",
        6,
        0,
        0.1,
    )
