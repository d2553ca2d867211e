import json
import re
from dataclasses import replace

import numpy as np
import pytest

from fddbench.metrics.bound import bounds_table
from fddbench.reporting.page.writing import page_html, write_page

LOST = dict.fromkeys(range(6), ("infeasible", "cannot hold <cruise>"))
EVIL = '<script>alert("x")</script>'


def sent(page):
    """What the script draws cells from."""
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)[1])


def text_of(page):
    return re.sub(r"<(script|style).*?</\1>", "", page, flags=re.DOTALL)


def test_page_is_one_file_without_network(make_report, tmp_path):
    output = tmp_path / "new" / "page.html"
    write_page(
        make_report(scenarios=("jam_a", "jam_b", "healthy"), flights=8, lost={1: ("error", "ValueError: departed")}),
        output,
    )
    page = output.read_text(encoding="utf-8")
    assert "http://" not in page
    assert "https://" not in page
    policy = re.search(r'Content-Security-Policy" content="([^"]+)"', page)[1].replace("&#39;", "'")
    assert policy.startswith("default-src 'none';")
    assert "unsafe" not in policy
    assert not re.findall(r'(?:src|href)="', page)
    assert "url(" not in page
    assert "@import" not in page
    assert "style=" not in text_of(page)
    for words in ("Beside the published Table 8", "Where does it fail?", "Over the envelope", "departed", "Clopper"):
        assert words in page


def test_no_row_is_in_the_page(make_report):
    few, many = (page_html(make_report(flights=n, recordings=(), published=())) for n in (20, 200))
    assert len(many) < 1.1 * len(few)


def test_the_dangerous_event_stands_before_what_is_late(make_report):
    page = page_html(make_report(scenarios=("noise_a",), flights=10, recordings=()))
    assert page.index("right in time") < page.index("healthy site declared</th>") < page.index("late or missed</th>")


def test_same_input_same_bytes(make_report):
    report = make_report(scenarios=("jam_b", "healthy"), flights=5)
    assert page_html(report) == page_html(report)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"scenarios": (), "flights": 0}, "the table of results is empty"),
        ({"scenarios": ("jam_a", "healthy"), "flights": 6, "lost": LOST, "recordings": ()}, "12 infeasible"),
        ({"scenarios": ("healthy",), "flights": 4}, "No false alarm"),
        ({"scenarios": ("jam_b",), "flights": 4, "detectors": ("voting_monitor",)}, "scored by 1 detector:"),
        ({"scenarios": ("oscill_a",), "flights": 1}, "1 flight in 1 scenario, "),
        ({"scenarios": ("jam_a",), "flights": 3, "published": ()}, "jam_a"),
        ({"scenarios": ("jam_a",), "flights": 6, "lost": LOST}, "6 infeasible"),
        ({"scenarios": ("jam_a",), "flights": 3, "detectors": ("a", "b", "c", "d", "e", "f", "g")}, "by 7 detectors"),
    ],
)
def test_page_of_edge_cases(make_report, changes, words):
    page = page_html(make_report(**changes))
    assert words in page
    assert not re.search(r"\bnan\b", text_of(page).lower())
    assert "&lt;NA&gt;" not in page
    sent(page)


def test_text_of_users_is_escaped(make_report):
    report = make_report(scenarios=("jam_a",), flights=6, lost={0: LOST[0]}, recordings=())
    campaign = {**report.campaign, "about": EVIL, "name": "<b>$x$"}
    designs = [{"name": EVIL, "kind": EVIL}]
    requirements = [{"name": EVIL, "verdict": EVIL, "about": EVIL}]
    rows = report.rows.assign(scenario=report.rows["scenario"].str.replace("jam_a", EVIL))
    page = page_html(
        replace(
            report, campaign=campaign, designs=designs, provenance={EVIL: EVIL}, rows=rows, requirements=requirements
        )
    )
    assert page.count("<script") == 2  # the data and ours
    assert "<b>$x$" not in page
    assert "&lt;script&gt;" in page
    assert "cannot hold &lt;cruise&gt;" in page
    assert sent(page)["s"][0]["n"] == EVIL


def test_events_show_when_there_are_some(make_report, make_events):
    event = {
        "scenario": "jam_a",
        "point": 0,
        "level": 0,
        "run": 0,
        "detector": "sliding_mode",
        "status": "ok",
    }
    event |= {"event": 2, "fault": "jam", "sites": "r2", "onset_s": 4.0, "end_s": 9.0, "outcome": "declared_before"}
    report = make_report(scenarios=("jam_a",), flights=2, recordings=(), events=make_events([event]))
    page = page_html(report)
    assert "r2, 4 s to 9 s" in page
    assert page.index("declared before</th>") < page.index("r2, 4 s to 9 s")


def test_a_design_tuned_on_these_flights_is_marked(make_report):
    page = page_html(make_report(scenarios=("jam_a",), flights=3, recordings=(), in_sample=("voting_monitor",)))
    assert "voting_monitor<small>in sample</small>" in page
    assert "sliding_mode<small>in sample" not in page
    assert "<strong>In sample:</strong>" in page


def test_requirements_stand_on_the_first_screen_failures_first(make_report):
    asked = {"of": "right_share", "limit": 0.98, "at_least": True, "runs_used": 10, "runs_planned": 40, "detector": "d"}
    told = [
        {"name": "right", "verdict": "pass", "value": 1.0, "low": 0.99, "high": 1.0, **asked},
        {"name": "few alarms", "verdict": "undecided", "of": "false_alarms_per_hour", "limit": 0.1, "value": 0.0, "low": 0.0,
         "high": float("inf"), "at_least": False, "flights_needed": 300},
        {"name": "plain", "verdict": "fail"},
    ]  # fmt: skip
    page = text_of(page_html(make_report(scenarios=("jam_a",), flights=3, recordings=(), requirements=told)))
    assert page.index("✗ fail") < page.index("? undecided") < page.index("✓ pass") < page.index("Detectors, best first")
    assert "Of 3 judgements 1 pass, 1 fail, 1 are undecided." in page
    assert "right share at least 98.0 %" in page
    assert "300 more flights" in page
    assert "Requirements" not in page_html(make_report(scenarios=("jam_a",), flights=3, recordings=()))


def test_recordings_with_ended_flights(make_report):
    report = make_report(scenarios=("jam_a",), flights=6)
    (recording,) = report.recordings
    for signals in recording.detectors.values():
        for values in signals.values():
            values[500:, 1] = np.nan
            values[:, 2] = np.nan
    page = page_html(report)
    assert "bands of 6 of 6 flights" in page
    assert not re.search(r"\bnan\b", text_of(page).lower())


def test_bounds_that_nobody_states_are_a_sentence_and_long_tables_say_what_paper_lacks(make_report):
    report = make_report(scenarios=("jam_a",), flights=4, recordings=(), published=())
    nobody = bounds_table([{"scenario": f"jam_{n}", "about": "this plant states no ideal model"} for n in range(41)])
    page = page_html(replace(report, bounds=nobody))
    assert page.count("this plant states no ideal model") == 1
    assert "lines; on the screen all" not in page
    own = {"model": "exact", "about": "exact in words", "p_fa": 1e-6, "window_s": 0.36, "flights": 25, "d": 5.5}
    own |= {"d_least": 5.0, "p_d": 0.77, "d_health": 100.0, "p_detect": 1.0}
    page = page_html(replace(report, bounds=bounds_table([own | {"scenario": f"jam_{n}"} for n in range(41)])))
    assert "The first 40 of 41 lines; on the screen all." in page
