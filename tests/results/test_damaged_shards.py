"""A shard that is not the one that was written is read by nobody, and its flights are flown again to the same table."""

import shutil

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.results.conftest import fly
from tests.runner.tables import digest

from fddbench import load, load_events
from fddbench.campaign.load import read_campaign
from fddbench.errors import ResultsError

pytestmark = (
    pytest.mark.slow
)  # ten seconds; one damage of each kind is met in tests/runner/test_run.py on every occasion


def _flipped(data):
    at = len(data) // 2
    return data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :]


DAMAGES = {
    "truncated": lambda data, other: data[:-10],
    "empty": lambda data, other: b"",
    "text": lambda data, other: b"no table\n",
    "bit-flipped": lambda data, other: _flipped(data),
    "foreign": lambda data, other: other,
}


@pytest.fixture(scope="session")
def foreign(campaign, tmp_path_factory):
    """Results of the same campaign with another seed."""
    folder = tmp_path_factory.mktemp("foreign")
    (folder / "small.yaml").write_text(campaign.text.replace("seed: 5", "seed: 6"))
    fly(read_campaign(folder / "small.yaml"), folder / "out")
    return folder / "out"


@pytest.mark.parametrize("which", ["rows", "events"])
@pytest.mark.parametrize("damage", DAMAGES)
def test_damage_is_refused_and_mended_to_the_same_table(campaign, flown, foreign, out, which, damage):
    """Seen to fail with the comparison of sha256 in `mending._wrong` switched off: nothing is flown again."""
    path, other = (sorted((folder / which).iterdir())[1] for folder in (out, foreign))
    path.write_bytes(DAMAGES[damage](path.read_bytes(), other.read_bytes()))
    with pytest.raises(ResultsError, match="run the campaign again"):
        (load if which == "rows" else load_events)(out)
    told = []
    assert fly(campaign, out, notice=told.append).flights == 2
    assert any("is damaged or gone; its flights are flown again" in text for text in told)
    assert digest(out) == digest(flown)


@settings(max_examples=10)
@given(st.sets(st.integers(0, 11), min_size=1))
def test_any_shards_may_be_deleted(campaign, flown, tmp_path_factory, gone):
    """Seen to fail with the comparison of sha256 in `mending._wrong` switched off: a run finds nothing to fly."""
    out = shutil.copytree(flown, tmp_path_factory.mktemp("gone") / "out")
    shards = sorted([*(out / "rows").iterdir(), *(out / "events").iterdir()])
    assert len(shards) == 12
    for number in gone:
        shards[number].unlink()
    with pytest.raises(ResultsError, match="run the campaign again"):
        digest(out)
    assert 2 <= fly(campaign, out, notice=lambda text: None).flights <= 2 * len(gone)
    assert digest(out) == digest(flown)
    assert not list(out.rglob("*.tmp"))
