"""The README's campaign is run and gives the README's table."""

import re
import shutil
from pathlib import Path

import pytest
import yaml

from fddbench import gallery
from fddbench.cli import main
from fddbench.cli.main import parser

README = Path(__file__).parents[1] / "README.md"
TEXT = README.read_text(encoding="utf-8")


def _block(language: str) -> str:
    return re.search(rf"```{language}\n(.*?)```", TEXT, flags=re.DOTALL)[1]


def test_the_campaign_gives_the_table(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    campaign = _block("yaml")
    assert campaign.count("\n") <= 12
    Path("readme.yaml").write_text(campaign)
    assert main(["run", "readme.yaml", "--quiet"]) == 0
    printed = [line.rstrip() for line in capsys.readouterr().out.splitlines()]
    table = [line.rstrip() for line in _block("text").splitlines()]
    assert printed[: len(table)] == table


def test_every_command_is_named():
    for action in parser()._subparsers._group_actions:
        for name in action.choices:
            assert f"`fddbench {name}" in TEXT


def test_the_table_of_scores_is_the_kept_one():
    kept = yaml.safe_load((gallery.folder("reports") / "yaw_rate_table8" / "scores.yaml").read_text(encoding="utf-8"))
    ours = {line["scenario"]: line for line in kept["scores"] if line["detector"] == "sliding_mode_published"}
    rows = re.findall(r"^\| ([A-Z][\w]*-[AB]) \| (\d+), (\d+) \|.*\| (\d+) of (\d+) \|$", TEXT, flags=re.MULTILINE)
    assert len(rows) == 10
    for name, median, largest, hits, flights in rows:
        line = ours[name.lower().replace("-", "_")]
        assert float(median) == pytest.approx(line["detection_time_median_s"] * 100)
        assert float(largest) == pytest.approx(line["detection_time_max_s"] * 100)
        assert (int(hits), int(flights)) == (line["right"], line["flown"])


def test_the_table_of_the_boeing_747_is_the_kept_one():
    kept = yaml.safe_load((gallery.folder("reports") / "b747_monte_carlo" / "scores.yaml").read_text(encoding="utf-8"))
    right = {(line["scenario"], line["detector"]): line.get("right") for line in kept["scores"]}
    alarms = {line["detector"]: line["alarms"] for line in kept["false_alarms"]}
    maps = {line["detector"]: line["smallest"] for line in kept["detectable"] if line["scenario"] == "elevator_loss"}
    rows = re.findall(r"^\| `(\w+)`, .* \| (\d+) \| ([\d.]+)° \| (\d+) \| (\d+) \| (\d+) \|$", TEXT, flags=re.MULTILINE)
    assert len(rows) == 5
    for name, elevator, smallest, thrust, both, false in rows:
        detector = f"{name}_envelope"
        counts = [right[scenario, detector] for scenario in ("elevator_loss", "thrust_loss", "both_losses")]
        assert counts == [int(elevator), int(thrust), int(both)]
        assert alarms[detector] == int(false)
        assert f"{maps[detector]:.2f}" == smallest


@pytest.mark.skipif(shutil.which("make") is None, reason="make is not here")
def test_the_two_commands_exist():
    makefile = (README.parent / "Makefile").read_text(encoding="utf-8")
    for target in re.findall(r"^make (\w+)", _block("sh"), flags=re.MULTILINE):
        assert f"\n{target}:" in makefile
