"""A campaign that is flown in parts is the campaign that is flown at once; what failed may be flown again."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.runner.jammed import jammed
from tests.runner.plugins import HEAD

import fddbench
from fddbench.cli import main
from fddbench.results.manifest import shards
from fddbench.results.whole import holdings

FRAGILE = """
import os


class Mine(Base):
    def start(self):
        return [0]

    def step(self, state, measured):
        state[0] += 1
        if state[0] == 5 and measured.mass_kg > 200000 and os.path.exists("FULL"):
            raise MemoryError("the machine is full")
        return state, Verdict([0, 0, 0], 0.0)
"""


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    path = tmp_path_factory.mktemp("parts") / "parts.yaml"
    path.write_text(jammed("parts", runs=4, detectors="voting_monitor, sliding_mode_published"))
    return path


@pytest.fixture(scope="module")
def whole(campaign):
    fddbench.run(campaign, campaign.parent / "whole", jobs=1)
    return fddbench.load(campaign.parent / "whole")


PARTS = ["scenario=jam_a", "detector=voting_monitor", "run=1-2", "run=0,detector=sliding_mode_published", "run=3"]


@settings(max_examples=2, deadline=None)
@given(st.lists(st.sampled_from(PARTS), min_size=1, max_size=2))
def test_parts_in_any_order_and_then_the_rest(campaign, whole, tmp_path_factory, parts):
    out = tmp_path_factory.mktemp("out") / "out"
    for part in parts:
        report = fddbench.run(campaign, out, only=part, jobs=1)
        assert report.continued + report.flights == report.total
        assert fddbench.run(campaign, out, only=part, jobs=1).flights == 0
    fddbench.run(campaign, out, jobs=1)
    assert fddbench.load(out).equals(whole)
    assert not holdings(out).partial


def test_a_part_is_called_one(campaign, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["run", str(campaign), "--out", str(out), "--quiet", "--only", "detector=voting_monitor,run=1"]) == 0
    assert "0 of 8 flights: healthy 0 of 4, jam_a 0 of 4; 2 more of some detectors only" in capsys.readouterr().out
    with pytest.warns(UserWarning, match="partial"):
        assert set(fddbench.load(out)["detector"]) == {"voting_monitor"}


def test_a_wrong_part_writes_nothing(campaign, tmp_path, capsys):
    assert main(["run", str(campaign), "--out", str(tmp_path / "out"), "--only", "scenario=jam_b"]) == 2
    assert "Did you mean 'jam_a'?" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.fixture
def fragile(tmp_path):
    """A campaign one of whose detectors fails while the machine is full."""
    (tmp_path / "detectors").mkdir()
    (tmp_path / "detectors" / "fragile.py").write_text(HEAD + FRAGILE.replace("FULL", str(tmp_path / "full")))
    (tmp_path / "detectors" / "fragile.yaml").write_text(
        "kind: fragile.py:Mine\nabout: a test\nsource: me\ntuned_on: null\ngains: {}\n"
    )
    path = tmp_path / "fragile.yaml"
    path.write_text(jammed("parts", runs=4, detectors="voting_monitor, fragile"))
    return path


def test_what_failed_is_flown_again_when_asked(fragile, tmp_path):
    path = fragile
    clean = fddbench.run(path, tmp_path / "clean", jobs=1)
    assert not clean.failed_rows
    (tmp_path / "full").write_text("the machine has no room")
    first = fddbench.run(path, tmp_path / "out", jobs=1)
    assert 0 < first.failed_rows < 8
    (tmp_path / "full").unlink()
    again = fddbench.run(path, tmp_path / "out", jobs=1, retry_failed=True)
    assert again.failed_rows == 0
    assert again.flights > 0
    assert fddbench.load(tmp_path / "out").equals(fddbench.load(tmp_path / "clean"))
    listed = shards(tmp_path / "out")
    assert fddbench.run(path, tmp_path / "out", jobs=1, retry_failed=True).flights == 0
    assert shards(tmp_path / "out") == listed


def test_what_failed_elsewhere_stays_when_a_part_is_flown_again(fragile, tmp_path):
    fddbench.run(fragile, tmp_path / "clean", jobs=1)
    (tmp_path / "full").write_text("the machine has no room")
    parts = ["scenario=healthy", "scenario=jam_a"]
    failed = [fddbench.run(fragile, tmp_path / "out", only=part, jobs=1).failed_rows for part in parts]
    assert failed == [failed[0], 2 * failed[0]] != [0, 0]
    (tmp_path / "full").unlink()
    again = fddbench.run(fragile, tmp_path / "out", only=parts[0], jobs=1, retry_failed=True)
    assert (again.flights, again.total, again.failed_rows) == (4, 4, failed[0])
    assert not holdings(tmp_path / "out").partial
    fddbench.run(fragile, tmp_path / "out", jobs=1, retry_failed=True)
    assert fddbench.load(tmp_path / "out").equals(fddbench.load(tmp_path / "clean"))


def test_a_shard_of_which_a_part_is_flown_again_is_flown_again_whole(fragile, tmp_path):
    (tmp_path / "full").write_text("the machine has no room")
    first = fddbench.run(fragile, tmp_path / "out", only="scenario=healthy", jobs=1)
    (tmp_path / "full").unlink()
    assert len(shards(tmp_path / "out")) == 1
    again = fddbench.run(fragile, tmp_path / "out", only="scenario=healthy,run=0", jobs=1, retry_failed=True)
    assert (first.failed_rows > 0, again.flights, again.total, again.failed_rows) == (True, 4, 4, 0)
