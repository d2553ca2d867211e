"""Schemas that ship: current, named by every campaign, and met by all that ships."""

import json
import re
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

import fddbench
from fddbench import gallery
from fddbench.api.schemas import HEADER, schema_text
from fddbench.api.starting import copy_shipped, start
from fddbench.campaign.reading.yaml_nodes import read_yaml
from fddbench.cli.main import main
from fddbench.errors import FddbenchError

CAMPAIGNS = sorted(gallery.folder("campaigns").glob("*.yaml"))
SHIPPED = sorted((gallery.folder("campaigns") / "schema").glob("*.json"))


def header(path):
    (line,) = [line for line in path.read_text(encoding="utf-8").splitlines() if line.startswith(HEADER)]
    return path.parent / line.removeprefix(HEADER)


def mistakes(validator, path):
    data = read_yaml(path).data
    return [f"{path.name} {error.json_path}: {error.message[:200]}" for error in validator.iter_errors(data)]


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_shipped_schema_is_current_and_sound(path):
    """After a new name, range or key: `make schemas`."""
    text = path.read_text(encoding="utf-8")
    assert text == schema_text(path.stem), "run `make schemas`"
    found = json.loads(text)
    Draft202012Validator.check_schema(found)
    validator = Draft202012Validator(found)
    own = [one for one in CAMPAIGNS if header(one) == path]
    assert own
    assert [wrong for one in own for wrong in mistakes(validator, one)] == []


def test_every_campaign_names_the_schema_of_its_benchmark_below_its_question():
    for path in CAMPAIGNS:
        text = path.read_text(encoding="utf-8")
        assert header(path) in SHIPPED
        assert header(path).stem == re.search(r"^benchmark: (\w+)", text, re.MULTILINE)[1]
        comments = text[: text.index("\nname:")].splitlines()
        assert comments[0].endswith((".", "?")) or len(comments) > 2
        assert comments[-1].startswith(HEADER)


@pytest.mark.parametrize("what", ["detector", "benchmark", "fault", "campaign"])
def test_what_init_writes_meets_the_schema_beside_it(what, tmp_path, monkeypatch):
    *_, campaign = start(tmp_path, what, "mine")
    path = header(campaign)
    assert path.stem == ("mine" if what == "benchmark" else "yaw_rate")
    if what == "benchmark":
        monkeypatch.chdir(campaign.parent)
        validator = Draft202012Validator(fddbench.schema("mine.py:Mine"))
        assert validator.schema == json.loads(path.read_text(encoding="utf-8"))
        wrong = read_yaml(campaign).data | {"benchmark": "other"}
        assert not validator.is_valid(wrong)
    else:
        assert path.read_text(encoding="utf-8") == (SHIPPED[0].parent / path.name).read_text(encoding="utf-8")
        validator = Draft202012Validator(json.loads(path.read_text(encoding="utf-8")))
    assert mistakes(validator, campaign) == []


def test_a_copy_of_the_shipped_campaigns_has_their_schemas(tmp_path):
    copy_shipped(tmp_path)
    assert all(header(path).is_file() for path in (tmp_path / "campaigns").glob("*.yaml"))


def test_the_general_schema_and_that_of_designs_accept_what_ships():
    general, designs = (Draft202012Validator(fddbench.schema(subject)) for subject in ("", "designs"))
    assert [wrong for path in CAMPAIGNS for wrong in mistakes(general, path)] == []
    shipped = sorted(gallery.folder("detectors").glob("*.yaml"))
    assert [wrong for path in shipped for wrong in mistakes(designs, path)] == []
    bad = read_yaml(next(path for path in shipped if path.stem == "coast")).data
    assert not designs.is_valid(bad | {"gains": bad["gains"] | {"differ_rad_s": 1}})


def test_the_command_prints_or_writes(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["schema", "designs"]) == 0
    text = capsys.readouterr().out
    assert text == schema_text("designs")
    assert main(["schema", "designs", "--output", "a/b.json"]) == 0
    assert Path("a/b.json").read_text(encoding="utf-8") == text
    assert f"{HEADER}b.json" in capsys.readouterr().err
    assert main(["schema", "jet_engin"]) == 2
    assert "there is no schema of 'jet_engin'. Did you mean 'jet_engine'?" in capsys.readouterr().err
    Path("file").touch()
    assert main(["schema", "designs", "--output", "file/b.json"]) == 2
    assert "cannot write file/b.json" in capsys.readouterr().err


def test_a_file_that_is_not_there_is_a_message():
    with pytest.raises(FddbenchError, match="no file nowhere.py"):
        fddbench.schema("nowhere.py:Mine")


@pytest.mark.parametrize(
    "body", ["raise ValueError('no')", "choices = {'plant': 3}", "def plant(self, chosen): raise SystemExit"]
)
def test_a_benchmark_that_cannot_be_used_is_a_message(body, tmp_path):
    lines = ["from fddbench.interfaces import SinglePlant", "class Mine(SinglePlant):", "    name = about = 'mine'"]
    (tmp_path / "mine.py").write_text("\n".join([*lines, f"    {body}", "    def loop(self, options): return None"]))
    with pytest.raises(FddbenchError, match=r"mine\.py"):
        fddbench.schema("mine.py:Mine", tmp_path)
