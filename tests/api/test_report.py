"""`fddbench.report`: pages of one folder, of the newest, of several, its pictures, and the same numbers everywhere."""

import csv
import json
import re
import shutil
from io import StringIO

import pytest
import yaml
from markupsafe import Markup

import fddbench
from fddbench.cli import main
from fddbench.errors import FddbenchError

CAMPAIGN = {
    "name": "small", "benchmark": "yaw_rate", "wind": "light", "seed": 5, "duration_s": 12.0,
    "detectors": ["sliding_mode_published", "voting_monitor"],
    "dispersions": {"grid": {"gust_scale_ratio": [0.0, 1.0]}, "monte_carlo": {
        "runs": 4, "mass_kg": {"uniform": [180000, 220000]}, "v_cas_kt": {"uniform": [260, 320]},
        "altitude_ft": {"uniform": [15000, 25000]}}},
    "scenarios": [
        {"name": "healthy", "manoeuvre": "cruise"},
        {"name": "jam_a", "manoeuvre": "cruise",
         "faults": [{"kind": "jam", "sites": ["r1"], "onset_s": 2.0, "amplitude_percent": {"grid": [0.6, 1.25, 2.5]}}]},
        {"name": "jam_b", "manoeuvre": "cruise",
         "faults": [{"kind": "jam", "sites": ["r1", "r2"], "onset_s": 2.0, "amplitude_percent": 5.0}]},
    ],
}  # fmt: skip


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    made = tmp_path_factory.mktemp("report")
    (made / "small.yaml").write_text(yaml.safe_dump(CAMPAIGN), encoding="utf-8")
    fddbench.run(made / "small.yaml", made / "results" / "small", jobs=1)
    return made / "results" / "small"


@pytest.fixture(scope="module")
def page(flown):
    return fddbench.report(flown, replay=False).read_text(encoding="utf-8")


def sent(page):
    return json.loads(re.search(r'id="data">(.*?)</script>', page, re.DOTALL)[1])


def test_the_same_numbers_stand_in_page_terminal_table_and_scores(flown, page, capsys):
    data, summary = sent(page), fddbench.summary(flown)
    capsys.readouterr()
    assert main(["scores", str(flown)]) == 0
    scores = {(each["scenario"], each["detector"]): each for each in yaml.safe_load(capsys.readouterr().out)["scores"]}
    assert main(["table", str(flown), "--format", "csv"]) == 0
    table = {(each["scenario"], each["detector"]): each for each in csv.DictReader(StringIO(capsys.readouterr().out))}
    names = ("right", "late", "undecided", "missed", "wrong_site", "false_alarm")
    for line in summary.to_dict("records"):
        who = line["scenario"], line["detector"]
        cell = data["c"][[s["n"] for s in data["s"]].index(who[0])][data["d"].index(who[1])]
        first = ("quiet", *names[1:]) if line["healthy"] else names
        own = [0 if line[name] is None or line[name] is pd_na() else int(line[name]) for name in first]
        assert cell["o"] == own
        assert cell["n"] == line["flown"] == scores[who].get("flown") == sum(own)
        assert [scores[who].get(name, 0) for name in first] == own
        assert [int(table[who][name] or 0) for name in first] == own
        if cell["r"]:
            assert cell["r"][0] == fddbench_percent(line["right_percent"])


def test_false_alarms_of_distinct_flights_are_the_same_in_page_terminal_and_rows(flown, page):
    from fddbench.api.tables import alarms
    from fddbench.reporting.terminal import to_text

    rows, found = fddbench.load(flown), alarms(flown)
    healthy = rows[(rows["status"] == "ok").to_numpy(dtype=bool)]
    text = to_text(fddbench.summary(flown), found, wide=True).partition("False alarms of distinct flights")[2]
    cells = [
        re.sub("<[^>]+>", " ", line) for line in re.findall(r"<tr>.*?</tr>", page[page.index("h-ranks") :], re.DOTALL)
    ]
    for line in found.to_dict("records"):
        own = healthy[(healthy["detector"] == line["detector"]).to_numpy(dtype=bool)]
        assert line["distinct_flights"] == len(own[["manoeuvre", "point", "run"]].drop_duplicates())
        of = f"of {line['distinct_flights']} flights"
        assert any(line["detector"] in cell and of in cell for cell in cells)
        told = next(each.split() for each in text.splitlines() if each.strip().startswith(line["detector"]))
        assert told[1:3] == [str(line["distinct_flights"]), str(line["alarms"])]


def pd_na():
    import pandas as pd

    return pd.NA


def fddbench_percent(value):
    from fddbench.reporting.formats import percent

    return percent(value)


def test_the_terminal_prints_what_the_page_prints(flown, page, capsys):
    from fddbench.api.tables import alarms
    from fddbench.reporting.terminal import to_text

    summary = fddbench.summary(flown)
    text = to_text(summary, alarms(flown), wide=True)
    for line in summary.to_dict("records"):
        if not line["healthy"] and line["right_percent"] is not pd_na():
            assert f"{fddbench_percent(line['right_percent'])} [" in text
    assert "pools 2 points" in text
    assert "pools 2 points" in page


def test_the_newest_folder_is_reported_without_a_name(flown, monkeypatch, capsys):
    monkeypatch.chdir(flown.parent.parent)
    assert main(["report", "--no-replay"]) == 0
    assert capsys.readouterr().out.strip() == "results/small/report.html"
    monkeypatch.chdir(flown)
    assert main(["report"]) == 2
    assert "results/ holds no folder of results; fly a campaign first" in capsys.readouterr().err


def test_several_folders_are_compared(flown, tmp_path, capsys):
    other = tmp_path / "other"
    shutil.copytree(flown, other)
    assert main(["report", str(flown), str(other), "--output", str(tmp_path / "c.html")]) == 0
    text = (tmp_path / "c.html").read_text(encoding="utf-8")
    assert "comparisons show no difference" in text
    assert text.count('class="answer"') == 2
    assert main(["report", str(flown), str(tmp_path / "none")]) == 2
    assert "none is no folder" in capsys.readouterr().err


def test_who_sees_the_voted_signal_alone_comes_last_beside_other_folders_too(flown, monkeypatch):
    from fddbench.api import comparison_data

    best = comparison_data.comparison_data([flown]).folders[0].ranks[0][1]
    monkeypatch.setattr(comparison_data, "voted_only", lambda _: (best,))
    (folder,) = comparison_data.comparison_data([flown]).folders
    assert folder.ranks[-1][1:3] == (best, "sees the voted signal")


@pytest.mark.parametrize(
    "draw",
    [
        lambda r, f: r.outcome_matrix(f),
        lambda r, f: r.incidence(f),
        lambda r, f: r.incidence(f, "voting_monitor", "jam_b"),
        lambda r, f: r.envelope(f, "voting_monitor", "p_v_cas_kt", "p_gust_scale_ratio"),
        lambda r, f: r.size_curve(f, "sliding_mode_published", "jam_a"),
        lambda r, f: r.failures(f, "sliding_mode_published", "jam_a"),
    ],
)
def test_every_picture_is_a_function(flown, draw):
    picture = draw(fddbench.report, flown)
    assert picture._repr_svg_().startswith("<svg")
    assert picture._repr_svg_() == draw(fddbench.report, flown)._repr_svg_()


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (lambda r, f: r.incidence(f, "voting_moniter"), "Did you mean"),
        (lambda r, f: r.incidence(f, "voting_monitor", "healthy"), "no flight with a fault was flown in healthy"),
        (lambda r, f: r.envelope(f, "voting_monitor", "p_x", "p_y"), "there is no parameter 'p_x'"),
        (lambda r, f: r.size_curve(f, "voting_monitor", "jam_b"), "no size of a fault varies in jam_b"),
        (lambda r, f: r.operating_curve(f), "has no operating curve"),
        (lambda r, f: r.failures(f, "voting_monitor", "jam_b"), "nothing that varies goes with failure"),
    ],
)
def test_a_picture_that_cannot_be_says_why(flown, draw, message):
    with pytest.raises(FddbenchError, match=message):
        draw(fddbench.report, flown)


def test_commands_of_worst_flights_fly_again(flown, page):
    data = sent(page)
    case = f"{data['s'][2]['n']}/{data['c'][2][1]['w'][0]}"
    assert case in set(fddbench.load(flown, ["case"])["case"])
    assert data["f"] == Markup(flown.as_posix())


def test_an_alarm_before_the_onset_is_a_failure_where_a_picture_looks_for_most_of_them():
    from types import SimpleNamespace

    from fddbench.api.report_pictures import _scenario

    lines = (
        {"wrong_site": 1, "late": None, "missed": 0, "false_alarm": 0},
        {"wrong_site": 0, "late": 0, "missed": 0, "false_alarm": 2},
    )
    cells = {(s, 0): SimpleNamespace(line=line, incidence=True) for s, line in enumerate(lines)}
    assert _scenario(SimpleNamespace(scenarios=("calm", "gusty")), cells, "") == 1
