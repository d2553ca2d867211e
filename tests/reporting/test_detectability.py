"""From a benchmark that asks for maps to the table, the scores and the page."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from tests.metrics.test_detectable import MAP, frame

import fddbench
from fddbench.api.detectability import detectable_of
from fddbench.campaign.load import read_campaign
from fddbench.cli import main
from fddbench.errors import FddbenchError
from fddbench.metrics.alarms import summarize_alarms
from fddbench.metrics.detectable import DETECTABLE, summarize_detectable
from fddbench.reporting.detectability import MAP_HEADS, detectability_lines, detectability_scenes
from fddbench.runner.run import run_campaign

BESIDE = Path(__file__).parent.parent / "probes" / "beside"


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """Folder of results of drawn biases, of which a band of 1 deg finds those above 1 deg."""
    made = tmp_path_factory.mktemp("standby")
    (made / "detectors").mkdir()
    for name in ("standby.py", "detectors/band.py", "detectors/band.yaml", "detectors/spare_only.yaml"):
        shutil.copy(BESIDE / name, made / name)
    bias = {"kind": "bias", "sites": ["first"], "onset_s": 0.5, "amplitude_deg": {"uniform": [0.2, 3.0]}}
    content = {
        "name": "maps", "benchmark": "standby.py:Standby", "seed": 5, "duration_s": 2.0, "detectors": ["band", "spare_only"],
        "reconfigure": "band",
        "scenarios": [{"name": "bias", "manoeuvre": "hold", "faults": [bias]}],
        "dispersions": {"monte_carlo": {"runs": 240, "gain_per_s": {"uniform": [0.5, 4.0]}}},
    }  # fmt: skip
    (made / "maps.yaml").write_text(json.dumps(content), encoding="utf-8")
    run_campaign(read_campaign(made / "maps.yaml"), made / "out", jobs=1)
    return made / "out"


def test_the_table_of_a_folder_has_what_the_benchmark_asks_for(flown):
    maps = fddbench.detectable(flown)
    assert list(maps.columns) == list(fddbench.columns("detectable")) == DETECTABLE.names
    assert set(maps["detector"]) == {"band"}  # the other one does not watch the site
    assert (maps["x"].iloc[0], maps["y"].iloc[0]) == ("gain_per_s", "time_constant_s")
    whole = maps[maps["x_low"].isna()].iloc[0]
    assert whole["smallest"] == pytest.approx(1.0, abs=0.12)
    assert (whole["flights"], whole["relation"]) == (240, "about")


def test_scores_and_page_say_it(flown, capsys):
    assert main(["scores", str(flown)]) == 0
    line = yaml.safe_load(capsys.readouterr().out)["detectable"][0]
    assert (line["site"], line["size"], line["flights"], "times" in line) == ("first", "amplitude_deg", 240, False)
    page = fddbench.report(flown).read_text(encoding="utf-8")
    assert "Smallest faults found" in page
    assert "first: amplitude [deg]" in page


def test_a_benchmark_that_derives_nonsense_is_told(flown, monkeypatch):
    campaign = read_campaign(flown / "campaign.yaml")
    rows = fddbench.load(flown)
    for wrong, message in (
        (lambda *_: {"time_constant_s": "x"}, "ValueError"),
        (lambda *_: {}, r"needs \['time_constant_s'\]"),
    ):
        monkeypatch.setattr(type(campaign.bench), "derived", wrong)
        with pytest.raises(FddbenchError, match=message):
            detectable_of(rows, campaign)
    monkeypatch.setattr(type(campaign.bench), "detectability", ())
    assert detectable_of(rows, campaign).empty


def test_pictures_and_lines_say_how_much_stands_behind():
    rows = frame(300)
    maps, alarms = summarize_detectable(rows, [MAP, replace(MAP, times="")]), summarize_alarms(rows)
    pictures = detectability_scenes(maps, alarms)
    assert [picture["quantity"] for picture in pictures] == ["loss × |trim| [deg]", "loss [%]"]
    for picture in pictures:
        assert [scene.svg().count("<svg") for scene in picture["scenes"]] == [1] * len(picture["scenes"])
    lines = {(line[0].small, line[1].text): line for line in detectability_lines(maps, alarms)}
    assert {len(line) for line in lines.values()} == {len(MAP_HEADS)}
    good, blind = (lines["fin: loss × |trim| [deg]", name] for name in ("good", "blind"))
    assert good[2].small == "n 300"
    assert float(good[2].text) == pytest.approx(0.5, abs=0.1)
    assert blind[2].text.startswith("> ")
    assert blind[4].text == "–"
    assert blind[5].text.startswith("0 of ")


def test_too_few_flights_are_shown_as_such():
    rows = frame(20)
    maps, alarms = summarize_detectable(rows, [MAP]), summarize_alarms(rows)
    assert len(detectability_scenes(maps, alarms)) == 1
    for line in detectability_lines(maps, alarms):
        assert [cell.text for cell in line[2:5]] == ["–", "–", "–"]
    nothing = maps[np.zeros(len(maps), dtype=bool)]
    assert detectability_scenes(nothing, alarms) == []
    assert isinstance(nothing, pd.DataFrame)
