"""Nothing is shown as whole that is not."""

import pandas as pd
import pytest
from tests.results.conftest import fly

from fddbench import alarms, load, load_events, report, summary
from fddbench.api.tables import overview
from fddbench.campaign.load import read_campaign
from fddbench.cli import commands, main
from fddbench.errors import PartialResultsWarning
from fddbench.results import table
from fddbench.results.whole import holdings

SAID = "4 of 12 flights: healthy 2 of 6, jam 2 of 6"


@pytest.fixture
def partial(out):
    """Two of six shards listed, as after Ctrl-C."""
    path = out / "manifest.jsonl"
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join(line for line in lines if b'"cases": [[0, ' in line or b'"cases": [[2, ' in line))
    return out


@pytest.mark.parametrize("read", [load, load_events, summary])
def test_readers_are_warned_at_their_own_line(partial, read):
    with pytest.warns(PartialResultsWarning, match=f"partial, it holds {SAID}; run the campaign again") as caught:
        read(partial)
    assert caught[0].filename == __file__


def test_the_page_says_it(partial):
    assert f"Not the whole campaign: {SAID}." in report(partial).read_text()


def test_the_terminal_says_it_and_scores_are_refused(partial, capsys):
    commands._summary(partial, overview(partial), wide=False, failed=False)
    assert capsys.readouterr().out.startswith(f"not the whole campaign: {SAID}\n")
    assert main(["scores", str(partial)]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert f"holds {SAID}. Scores that are kept are those of a whole campaign" in told.err


def test_a_whole_folder_says_nothing_of_it(flown, capsys):
    assert not holdings(flown).partial
    commands._summary(flown, overview(flown), wide=False, failed=False)
    assert "whole" not in capsys.readouterr().out
    assert main(["scores", str(flown)]) == 0
    assert len(load(flown)) == 12


def test_a_command_prints_the_warning_as_a_line(partial, campaign, capsys, monkeypatch):
    from fddbench.api import pages

    monkeypatch.setattr(pages, "report", lambda folders, output, **more: len(load(folders[0])))
    assert main(["report", str(partial)]) == 0
    assert (
        capsys.readouterr().err
        == f"fddbench: {partial} is partial, it holds {SAID}; run the campaign again to fly the rest\n"
    )


def test_the_rest_is_flown(partial, campaign, flown):
    assert fly(campaign, partial).flights == 8
    assert load(partial).equals(load(flown))


def test_a_large_campaign_is_summarised_detector_by_detector_to_the_same_numbers(campaign, tmp_path, monkeypatch):
    two = read_campaign(campaign.path, ["detectors=[voting_monitor, sliding_mode_published]"])
    fly(two, tmp_path / "out")
    whole, public = overview(tmp_path / "out"), (summary(tmp_path / "out"), alarms(tmp_path / "out"))
    monkeypatch.setattr(table, "_MANY", 1)
    parts = [set(rows["detector"]) for rows in table.read_in_parts(tmp_path / "out", ["detector"])]
    assert parts == [{"voting_monitor"}, {"sliding_mode_published"}]
    for once, in_parts, given in zip(whole, overview(tmp_path / "out"), public, strict=True):
        pd.testing.assert_frame_equal(once, in_parts, check_exact=True)
        pd.testing.assert_frame_equal(once, given, check_exact=True)
