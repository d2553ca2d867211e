"""What comes before the detectors: consequences where the campaign names them, figures where it asks for them."""

import pandas as pd
import pytest

from fddbench.interfaces import Consequence
from fddbench.reporting.page.asked import asked

ANNOUNCED = (
    Consequence(name="peak_bank_deg", signal="phi_true_deg", how="peak", about="bank angle"),
    Consequence(name="heading_error_deg", signal="psi_deg", how="error", about="heading"),
)
ABOUT = "What does each fault do? Heading against the healthy flight,\n heading and bank."


def rows():
    one = pd.DataFrame({
        "scenario": ["healthy", "jam", "jam", "jam", "drift"], "manoeuvre": "cruise", "point": 0, "level": 0,
        "run": [0, 0, 1, 2, 0], "n_faulty": [0, 1, 1, 1, 1], "status": ["ok", "ok", "ok", "error", "ok"],
        "peak_bank_deg": [90.0, 2.0, 3.0, 80.0, 4.0], "healthy_peak_bank_deg": [None, 0.1, 0.2, 0.3, 0.5],
        "heading_error_deg": [None, -9.0, 5.0, 50.0, -1.0],
    })  # fmt: skip
    return pd.concat([one.assign(detector="a"), one.assign(detector="b")]).convert_dtypes(dtype_backend="pyarrow")


def told(*args, **more):
    return "".join(text for text, _ in asked(*args, **more))


def test_the_worst_scenario_of_each_number_that_the_campaign_names():
    assert told(ABOUT, rows(), ANNOUNCED, ["jam"]) == (
        "Worst for the aircraft: peak bank [deg] 4, healthy 0.5 in drift; heading error [deg] 7 in jam "
        "(medians of flights; all below). "
    )


def test_an_aircraft_that_acts_is_asked_for_all_of_them():
    text = told("What is left?", rows(), ANNOUNCED, [], commander="a")
    assert text.startswith("Worst for the aircraft, which acts on a: peak bank [deg] 4, healthy 0.5 in drift; heading")
    assert told("What is left?", rows(), ANNOUNCED, []) == ""


def test_a_peak_of_the_healthy_flight_is_no_consequence():
    turn = rows()
    turn["healthy_peak_bank_deg"] = turn["healthy_peak_bank_deg"].where(turn["scenario"] != "drift", 3.9999)
    assert "peak bank [deg] 2.5, healthy 0.15 in jam; heading" in told(ABOUT, turn, ANNOUNCED, [])
    turn["healthy_peak_bank_deg"] = turn["peak_bank_deg"]
    assert "bank" not in told(ABOUT, turn, ANNOUNCED, [])


def test_one_word_is_no_question_and_nothing_known_is_no_answer():
    assert told("A bank of filters?", rows(), ANNOUNCED, ["jam"]) == ""
    assert told("Roll and heading?", rows(), ANNOUNCED, []) == ""
    assert told("Embankment, headings", rows(), ANNOUNCED, []) == ""
    assert told(ABOUT, rows().iloc[:1], ANNOUNCED, []) == ""
    assert told(ABOUT, rows().drop(columns=["peak_bank_deg", "heading_error_deg"]), ANNOUNCED, []) == ""
    assert told(ABOUT, rows(), (), []) == ""


@pytest.mark.parametrize(
    ("about", "drawn", "expected"),
    [
        ("What do Figs 2 and 3 of the paper look like? Ten draws.", ["f", "g"],
         "Figs 2 and 3 are drawn below, under Signals, as flown here: f and g. "),
        ("What does Fig 1 look like?", ["f"], "Fig 1 is drawn below, under Signals, as flown here: f. "),
        ("What does Fig 1 look like?", [], ""),
        ("Which one is best? See Fig 1.", ["f"], ""),
        ("The gust of Fig 1.", ["f"], ""),
    ],
)  # fmt: skip
def test_figures_are_answered_by_where_they_are(about, drawn, expected):
    assert told(about, rows(), ANNOUNCED, drawn) == expected


def test_it_is_the_first_sentence_of_the_page(make_report):
    from dataclasses import replace

    from fddbench.reporting.page.content import content

    report = make_report(scenarios=("jam_a", "healthy"), flights=4)
    report = replace(report, campaign={**report.campaign, "about": "What do Figs 4 and 5 look like?"})
    text = "".join(text for text, _ in content(report)["answer"])
    names = " and ".join(each.scenario for each in report.recordings)
    assert text.startswith(f"Figs 4 and 5 are drawn below, under Signals, as flown here: {names}. ")
    assert "decided faulty flights" in text
