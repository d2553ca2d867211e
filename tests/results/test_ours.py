"""Nothing is deleted, written over or written through that is not fddbench's."""

import shutil

import pytest
from tests.results.conftest import everything, fly

from fddbench import load
from fddbench.campaign.load import read_campaign
from fddbench.errors import ResultsError


@pytest.mark.parametrize("fresh", [False, True])
@pytest.mark.parametrize("listed", [False, True])
def test_shards_without_a_provenance_are_not_deleted(out, tmp_path, fresh, listed):
    """Also by a run of another campaign; what the list shows to be ours may be flown anew on demand."""
    (tmp_path / "other.yaml").write_text((out / "campaign.yaml").read_text().replace("seed: 5", "seed: 6"))
    other = read_campaign(tmp_path / "other.yaml")
    (out / "provenance.json").unlink()
    if not listed:
        (out / "manifest.jsonl").unlink()
    before = everything(out)
    if fresh and listed:
        assert fly(other, out, fresh=True).flights == 12
        assert len(load(out)) == 12
        return
    cure = "with --fresh" if listed else "remove the folder yourself"
    with pytest.raises(
        ResultsError, match=f"holds 12 shards and a provenance.json that is missing.*Nothing was.*{cure}"
    ):
        fly(other, out, fresh=fresh)
    assert everything(out) == before


@pytest.mark.parametrize("fresh", [False, True])
def test_ones_own_campaign_and_designs_are_no_results(campaign, tmp_path, fresh):
    """They have the names of frozen ones."""
    folder = tmp_path / "mine"
    (folder / "detectors").mkdir(parents=True)
    (folder / "campaign.yaml").write_text("precious")
    (folder / "detectors" / "own.yaml").write_text("precious")
    for _ in range(2):
        before = everything(folder)
        with pytest.raises(ResultsError, match=r"is no folder of results: it holds .*own.yaml"):
            fly(campaign, folder, fresh=fresh)
        assert everything(folder) == before
        assert not (folder / ".lock").exists()
    (folder / "detectors" / "own.yaml").unlink()
    with pytest.raises(ResultsError, match=r"holds campaign.yaml and a provenance.json that is missing"):
        fly(campaign, folder, fresh=fresh)


@pytest.mark.parametrize("name", ["rows/mine.txt", "detectors/mine.yaml", "notes/mine.txt"])
def test_a_file_among_the_results_is_not_deleted(campaign, out, name):
    (out / name).parent.mkdir(exist_ok=True)
    (out / name).write_text("precious")
    for fresh in (False, True):
        with pytest.raises(ResultsError, match=f"it holds {name}"):
            fly(campaign, out, fresh=fresh)
    assert (out / name).read_text() == "precious"


@pytest.mark.parametrize("name", ["rows", "detectors", "manifest.jsonl", "provenance.json", "campaign.yaml", ".pid"])
def test_results_are_not_written_through_links(campaign, out, tmp_path, name):
    target = shutil.move(out / name, tmp_path / "elsewhere")
    (out / name).symlink_to(target)
    before = everything(tmp_path)
    for fresh in (False, True):
        with pytest.raises(ResultsError, match=f"{name} is a link; results are not written through links"):
            fly(campaign, out, fresh=fresh)
    assert everything(tmp_path) == before


def test_a_run_that_died_in_its_first_moments_is_begun_again(campaign, tmp_path):
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "manifest.jsonl").write_bytes(b"")
    (folder / ".provenance.json.4711.tmp").write_bytes(b"{")
    assert fly(campaign, folder).flights == 12


def test_a_clearing_that_died_is_still_known_as_ours(campaign, out):
    (out / "manifest.jsonl").unlink()
    shutil.rmtree(out / "rows")
    assert fly(campaign, out, fresh=True).flights == 12
