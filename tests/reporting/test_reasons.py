"""Reasons kept beside scores: of this campaign only, and such that switching them off makes a difference."""

import yaml

from fddbench import gallery
from fddbench.campaign.load import read_campaign
from fddbench.reporting.page.writing import page_html
from fddbench.reporting.reasons import reason_table

SHA = read_campaign(gallery.folder("campaigns") / "fes_monte_carlo.yaml").sha256
LINES = yaml.safe_load((gallery.folder("reports") / "fes_monte_carlo" / "reasons.yaml").read_text(encoding="utf-8"))[
    "lines"
]


def test_reasons_are_shown_with_their_own_campaign_only(make_report):
    lines = reason_table("fes_monte_carlo", SHA)
    assert [line[0].text for line in lines] == [line["reason"] for line in LINES]
    assert reason_table("fes_monte_carlo", "0" * 64) == reason_table("smoke", SHA) == []
    page = page_html(make_report(scenarios=("jam_a",), flights=3, recordings=(), reasons=lines))
    assert "and what eq (38) is for" in page
    assert "Where the scheme does not hold" not in page_html(
        make_report(scenarios=("jam_a",), flights=3, recordings=())
    )


def test_every_reason_makes_a_difference_beyond_its_intervals():
    """But for the sign of the gain, whose intervals touch: it is kept because the print differs from its own equation."""
    for line in LINES:
        (low, high) = sorted((line["as_it_is"], line["otherwise"]), key=lambda side: side["not_right"] / side["of"])
        assert low["not_right"] < high["not_right"]
        if not line["reason"].startswith(("printed gain", "errors")):
            assert low["high_percent"] < high["low_percent"], line["reason"]
