"""The guaranteed gamma beside what is detected."""

import pandas as pd

from fddbench.reporting.guarantees import guarantee_lines

DESIGNS = [{"name": "small", "gamma": 0.3}, {"name": "large", "gamma": 0.6}, {"name": "none", "gamma": None}]


def rows():
    found = []
    for detector, right in (("small", 2), ("large", 4), ("none", 1)):
        base = {"detector": detector, "status": "ok"}
        for run in range(4):
            outcome = "right" if run < right else "wrong_site" if detector == "small" else "missed"
            found.append({**base, "run": run, "n_faulty": 1, "outcome": outcome})
        found.append({**base, "run": 4, "n_faulty": 1, "outcome": "undecided"})
        found.append({**base, "run": 5, "n_faulty": 0, "outcome": "false_alarm"})
    return pd.DataFrame(found)


def events():
    base = {"status": "ok"}
    return pd.DataFrame(
        [
            {**base, "detector": "large", "run": 0, "outcome": "right", "detection_time_s": 1.0},
            {**base, "detector": "large", "run": 1, "outcome": "declared_before", "detection_time_s": None},
            {**base, "detector": "large", "run": 2, "outcome": "undecided", "detection_time_s": None},
            {**base, "detector": "small", "run": 0, "outcome": "missed", "detection_time_s": None},
        ]
    )


def test_the_largest_share_of_right_flights_comes_first_whatever_its_gamma():
    lines = guarantee_lines(rows(), events(), DESIGNS)
    assert [(line[0].text, line[1].text) for line in lines] == [("large", "0.6000"), ("small", "0.3000"), ("none", "–")]
    assert [line[2].text for line in lines] == ["100 %", "50.0 %", "25.0 %"]
    assert [line[3].text for line in lines] == ["0 %", "50.0 %", "0 %"]
    assert lines[0][2].small.startswith("4 of 4: ")


def test_a_fault_declared_before_it_began_is_not_found_in_time_and_an_undecided_one_is_no_part():
    lines = {line[0].text: line for line in guarantee_lines(rows(), events(), DESIGNS)}
    assert (lines["large"][4].text, lines["large"][4].small.split(":")[0]) == ("50.0 %", "1 of 2")
    assert lines["large"][5].text == "1.00"
    assert lines["small"][4].text == "0 %"
    assert lines["none"][4].text == "–"


def test_without_a_gamma_there_is_nothing_to_compare():
    assert guarantee_lines(rows(), events(), [{"name": "small"}, {"name": "large"}]) == []
