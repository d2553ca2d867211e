"""Code that lies in a folder of results runs only where it was flown, or where its user said so."""

import json
import os
import shutil
from hashlib import sha256
from pathlib import Path

import pytest

import fddbench
from fddbench import plugin_files, private
from fddbench.campaign.plan import plan
from fddbench.cli import main
from fddbench.errors import UntrustedError
from fddbench.results import trust
from fddbench.results.folder import claim
from fddbench.runner.fingerprint import fingerprint_of, frozen, provenance_for

PLUGIN = """
from pathlib import Path
Path({mark!r}).touch()  # whoever imports this file leaves a trace
{copy}
"""
CAMPAIGN = """
name: brought
benchmark: yaw_rate
seed: 7
duration_s: 4.0
scenarios:
  - {name: healthy, manoeuvre: cruise}
detectors: [own]
"""


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    """A folder of results with a plug-in that another user flew, and the trace that the plug-in leaves when it is run."""
    mark, there = tmp_path / "it_ran", tmp_path / "there"
    there.mkdir()
    shutil.copytree(fddbench.gallery.folder("detectors"), tmp_path / "gallery")
    copy = (tmp_path / "gallery" / "cusum_example.py").read_text()
    (there / "brought.yaml").write_text(CAMPAIGN)
    (there / "detectors").mkdir()
    (there / "detectors" / "cusum_example.py").write_text(PLUGIN.format(mark=str(mark), copy=copy))
    (there / "detectors" / "own.yaml").write_text((tmp_path / "gallery" / "cusum_example.yaml").read_text())
    monkeypatch.setenv("FDDBENCH_CACHE", str(tmp_path / "their_cache"))
    monkeypatch.setattr(trust, "_known", set())
    out = tmp_path / "results"
    assert main(["run", str(there / "brought.yaml"), "--out", str(out), "--quiet"]) == 0
    assert mark.exists()
    assert fddbench.verify(out, refly=1) is not None  # its own user goes on as before
    monkeypatch.setenv("FDDBENCH_CACHE", str(tmp_path / "our_cache"))
    trust._known.clear()
    plugin_files._loaded.clear()  # as in a process of one's own
    mark.unlink()
    return out, mark


@pytest.mark.parametrize(
    "command",
    [["report"], ["replay", "healthy/0/0/0"], ["scores"], ["verify", "--refly", "1"], ["finding"]],
    ids=lambda command: command[0],
)
def test_code_from_elsewhere_is_not_run(elsewhere, capsys, command):
    out, mark = elsewhere
    assert main([command[0], str(out), *command[1:]]) in {0, 2}
    assert not mark.exists()
    assert "cusum_example.py" in capsys.readouterr().err


def test_a_page_from_elsewhere_is_written_from_the_rows_and_says_what_it_lacks(elsewhere, capsys):
    out, mark = elsewhere
    assert main(["report", str(out)]) == 0
    assert "Its page is written from the rows alone" in capsys.readouterr().err
    page = (out / "report.html").read_text(encoding="utf-8")
    assert not mark.exists()
    assert "No false alarm" in page
    assert "<svg" in page
    place = page[page.index('id="h-signals"') :][:900]
    assert "Not drawn" in place
    assert "cusum_example.py" in place
    assert "--trust" in place
    copy = shutil.copytree(out, out.parent / "copy")
    assert main(["report", str(out), str(copy)]) == 0
    assert not mark.exists()
    assert main(["report", str(out), "--trust"]) == 0
    assert mark.exists()
    assert "Not drawn" not in (out / "report.html").read_text(encoding="utf-8")


def test_a_page_of_frozen_texts_that_are_no_campaign_is_refused(elsewhere, capsys):
    out, mark = elsewhere
    provenance, yaml = out / "provenance.json", out / "campaign.yaml"
    told = json.loads(provenance.read_text())
    yaml.write_text(yaml.read_text().replace("seed: 7", "seed: [7]"))
    told["campaign_yaml_sha256"] = sha256(yaml.read_bytes()).hexdigest()
    provenance.write_text(json.dumps(told))
    assert main(["report", str(out)]) == 2
    assert "campaign.yaml:3:7: expected a whole number" in capsys.readouterr().err
    assert not mark.exists()


def test_rows_of_somebody_elses_code_are_counted_without_it(elsewhere):
    out, mark = elsewhere
    assert fddbench.load(out)["status"].tolist() == ["ok"]
    assert fddbench.summary(out)["detector"].tolist() == ["own"]
    assert not mark.exists()


def test_trusted_once_it_runs_until_it_changes(elsewhere, capsys):
    out, mark = elsewhere
    assert main(["replay", str(out), "healthy/0/0/0", "--trust"]) == 0
    assert mark.exists()
    assert main(["replay", str(out), "healthy/0/0/0"]) == 0
    shutil.copytree(out, out.parent / "moved")  # it is the code that is known, not the folder
    assert len(fddbench.signals(out.parent / "moved", "healthy").time_s)
    (out / "helpful.py").write_text("")  # what could be imported beside it is no part of what was trusted
    with pytest.raises(UntrustedError):
        fddbench.signals(out, "healthy")


def test_a_campaign_that_hides_its_plugin_does_not_run_it(elsewhere):
    out, mark = elsewhere
    provenance = out / "provenance.json"
    provenance.write_text(provenance.read_text().replace("detectors/cusum_example.py", "detectors/cusum_example.txt"))
    with pytest.raises(fddbench.errors.FddbenchError):
        fddbench.signals(out, "healthy")
    assert not mark.exists()


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="permissions of POSIX")
@pytest.mark.parametrize("mode", [0o770, 0o707])
def test_a_folder_that_others_may_write_is_not_private(tmp_path, monkeypatch, mode):
    where = tmp_path / "shared"
    where.mkdir(mode=0o700)
    where.joinpath("a").write_bytes(b"theirs")
    assert private.read(where / "a") == b"theirs"
    where.chmod(mode)
    assert "written by others" in private.trouble(where)
    assert private.read(where / "a") is None
    with pytest.raises(PermissionError, match="written by others"):
        private.made(where)
    monkeypatch.setenv("FDDBENCH_CACHE", str(where))
    monkeypatch.setattr(trust, "_known", set())
    trust.remember("ab")
    assert trust.is_known("ab")  # as long as this process lasts
    trust._known.clear()
    assert not trust.is_known("ab")


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="permissions of POSIX")
def test_a_file_that_others_may_write_and_a_link_are_not_read(tmp_path):
    own = private.made(tmp_path / "own")
    (own / "a").write_bytes(b"x")
    (own / "a").chmod(0o666)
    assert private.read(own / "a") is None
    (own / "b").symlink_to(Path(__file__))
    assert private.read(own / "b") is None


@pytest.mark.skipif(getattr(os, "geteuid", lambda: 1)() != 0, reason="only root can give a file away")
def test_a_folder_of_another_user_is_not_private(tmp_path):
    own = private.made(tmp_path / "own")
    (own / "a").write_bytes(b"x")
    os.chown(own, 65534, 65534)
    assert "another user" in private.trouble(own)
    assert private.read(own / "a") is None


def test_a_folder_that_looks_cut_off_does_not_run_its_plugin(elsewhere):
    out, mark = elsewhere
    told = json.loads((out / "provenance.json").read_text())
    stage = {
        "fingerprint": told["fingerprints"][0],
        "scenarios": {"healthy": [1, 1, 1]},
        "detectors": ["own"],
        "points": None,
        "campaign_yaml_sha256": told["campaign_yaml_sha256"],
    }
    told |= {"stages": [stage, stage | {"campaign_yaml_sha256": "0" * 64}], "campaign_yaml_sha256": "0" * 64}
    (out / "provenance.json").write_text(json.dumps(told))
    with pytest.raises(UntrustedError):
        fddbench.extend(out, detectors=["voting_monitor"])
    assert not mark.exists()


@pytest.mark.parametrize("name", ["detectors/supplier/more.c", "detectors/supplier/more.h"])
def test_c_that_was_put_beside_known_c_is_not_trusted(tmp_path, monkeypatch, name):
    monkeypatch.setenv("FDDBENCH_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(trust, "_known", set())
    there, out = tmp_path / "there", tmp_path / "results"
    (there / "detectors").mkdir(parents=True)
    fddbench.export("voting_monitor", there / "detectors" / "supplier")
    design = (fddbench.gallery.folder("detectors") / "voting_monitor.yaml").read_text()
    (there / "detectors" / "own.yaml").write_text(design.replace("kind:", "code: supplier\nkind:", 1))
    (there / "brought.yaml").write_text(CAMPAIGN)
    campaign = fddbench.read(there / "brought.yaml")
    out.mkdir()
    claim(out, files=campaign.files(), provenance=provenance_for(plan(campaign), fingerprint_of(campaign)), fresh=True)
    assert frozen(out).designs[0].files.keys() == campaign.designs[0].files.keys()
    (out / name).write_text("/* whoever compiles this runs it */")
    with pytest.raises(UntrustedError, match="supplier"):
        frozen(out)
