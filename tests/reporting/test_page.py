import re
from dataclasses import replace

import numpy as np
import pytest

from fddbench.reporting.page.writing import page_html, write_page

LOST = dict.fromkeys(range(6), ("infeasible", "cannot hold <cruise>"))


def test_page_is_one_file_without_network(make_report, tmp_path):
    output = tmp_path / "new" / "page.html"
    write_page(
        make_report(scenarios=("jam_a", "jam_b", "healthy"), flights=8, lost={1: ("error", "ValueError: departed")}),
        output,
    )
    page = output.read_text(encoding="utf-8")
    assert "http://" not in page
    assert "https://" not in page
    assert "<script" not in page
    assert "default-src &#39;none&#39;" in page or "default-src 'none'" in page
    sources = re.findall(r'(?:src|href)="([^"]{0,30})', page)
    assert sources
    assert all(source.startswith(("data:image/png;base64,", "#")) for source in sources)
    assert "url(" not in page
    assert "@import" not in page
    for words in ("Beside the published Table 8", "Detection time per fault", "Envelope flown", "departed", "Clopper"):
        assert words in page


def test_dangerous_event_comes_first(make_report):
    page = page_html(make_report(scenarios=("noise_a",), flights=10, recordings=()))
    assert page.index("Healthy sites declared") < page.index("Right: found in time") < page.index("Results by scenario")


def test_same_input_same_bytes(make_report):
    report = make_report(scenarios=("jam_b", "healthy"), flights=5)
    assert page_html(report) == page_html(report)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"scenarios": (), "flights": 0}, "the table of results is empty"),
        ({"scenarios": ("jam_a", "healthy"), "flights": 6, "lost": LOST, "recordings": ()}, "12 infeasible"),
        ({"scenarios": ("healthy",), "flights": 4}, "False alarms"),
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
    assert not re.search(r"\bnan\b", re.sub(r"base64,[^\"]*", "", page).lower())
    assert "&lt;NA&gt;" not in page


def test_text_of_users_is_escaped(make_report):
    report = make_report(scenarios=("jam_a",), flights=6, lost={0: LOST[0]}, recordings=())
    evil = '<script>alert("x")</script>'
    campaign = {**report.campaign, "about": evil, "name": "<b>$x$"}
    designs = [{"name": evil, "kind": evil}]
    page = page_html(replace(report, campaign=campaign, designs=designs, provenance={evil: evil}))
    assert "<script" not in page
    assert "<b>" not in page
    assert "&lt;script&gt;" in page
    assert "cannot hold &lt;cruise&gt;" in page


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
    assert "voting_monitor (in sample)" in page
    assert "<small>in sample</small>" in page
    assert "sliding_mode (in sample)" not in page


def test_recordings_with_ended_flights(make_report):
    report = make_report(scenarios=("jam_a",), flights=4)
    (recording,) = report.recordings
    for signals in recording.detectors.values():
        for values in signals.values():
            values[500:, 1] = np.nan
            values[:, 2] = np.nan
    assert "4 of 4 cases" in page_html(report)
