"""The guaranteed gamma beside what is detected."""

import pandas as pd

from fddbench.reporting.guarantees import guarantee_lines

DESIGNS = [{"name": "small", "gamma": 0.3}, {"name": "large", "gamma": 0.6}, {"name": "none", "gamma": None}]


def rows():
    found = []
    for detector, right in (("small", 2), ("large", 4), ("none", 1)):
        for case in range(4):
            detected = case < right
            found.append(
                {"detector": detector, "status": "ok", "n_faulty": 1, "classified": detected, "missed": not detected,
                 "censored": False, "false_alarm": False}
            )  # fmt: skip
        found.append({"detector": detector, "status": "ok", "n_faulty": 0, "false_alarm": detector == "none"})
    return pd.DataFrame(found)


def events():
    base = {"status": "ok", "censored": False}
    return pd.DataFrame(
        [
            {**base, "detector": "large", "missed": False, "false_alarm": False, "detection_time_s": 1.0},
            {**base, "detector": "large", "missed": False, "false_alarm": True, "detection_time_s": 0.0},
            {**base, "detector": "small", "missed": True, "false_alarm": False, "detection_time_s": None},
        ]
    )


def test_the_best_detection_comes_first_whatever_its_gamma():
    lines = guarantee_lines(rows(), events(), DESIGNS)
    assert [(line[0].text, line[1].text) for line in lines] == [("large", "0.6000"), ("small", "0.3000"), ("none", "–")]
    assert [line[2].text for line in lines] == ["100 %", "50.0 %", "25.0 %"]
    assert [line[3].text for line in lines] == ["0 %", "0 %", "20.0 %"]


def test_a_fault_declared_before_it_began_is_not_found_in_time():
    lines = {line[0].text: line for line in guarantee_lines(rows(), events(), DESIGNS)}
    assert (lines["large"][4].text, lines["large"][4].small.split(":")[0]) == ("50.0 %", "1 of 2")
    assert lines["small"][4].text == "0 %"
    assert lines["none"][4].text == "–"


def test_without_a_gamma_there_is_nothing_to_compare():
    assert guarantee_lines(rows(), events(), [{"name": "small"}, {"name": "large"}]) == []
