"""An auditor's command: a sound folder passes, every kind of damage is named, a row of another program is found."""

import json
import shutil

import pyarrow.compute as pc
import pyarrow.parquet as pq
import pytest

import fddbench
from fddbench.cli.main import main
from fddbench.results import manifest
from fddbench.results.folder import provenance_of
from fddbench.results.shards import write_table

CAMPAIGN = """
name: verified
benchmark: yaw_rate
seed: 4
duration_s: 3.0
detectors: [sliding_mode_published, voting_monitor]
dispersions: {monte_carlo: {runs: 6, mass_kg: {uniform: [180000, 220000]}}}
scenarios:
  - {name: healthy, manoeuvre: cruise}
  - {name: jam_b, manoeuvre: cruise, faults: [{kind: jam, sites: [r1, r2], onset_s: 1.0, amplitude_percent: 5.0}]}
"""


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """Folder of results, not to be changed."""
    own = tmp_path_factory.mktemp("verified")
    (own / "verified.yaml").write_text(CAMPAIGN, encoding="utf-8")
    assert main(["run", str(own / "verified.yaml"), "--out", str(own / "out"), "--quiet", "--jobs", "1"]) == 0
    return own / "out"


@pytest.fixture
def folder(flown, tmp_path):
    """A copy of it."""
    shutil.copytree(flown, tmp_path / "out")
    return tmp_path / "out"


def contents(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_a_sound_folder_passes_and_is_not_written_to(folder, capsys):
    before = contents(folder)
    assert main(["verify", str(folder), "--refly", "5", "--seed", "1"]) == 0
    assert capsys.readouterr().out == f"5 flights flown again, 10 rows, 0 otherwise\n{folder} is sound and whole\n"
    assert contents(folder) == before
    assert fddbench.verify(folder, refly=1000).flights == 12


def _flip(path):
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(bytes(data))


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        (lambda f: _flip(next((f / "rows").glob("*"))), "is not the file that was written (its sha256 differs)"),
        (lambda f: next((f / "rows").glob("*")).unlink(), "is missing"),
        (lambda f: (f / "campaign.yaml").write_text("name: other\n"), "campaign.yaml is not the file of these results"),
        (
            lambda f: (f / "detectors" / "voting_monitor.yaml").unlink(),
            "voting_monitor.yaml is not the file of these results",
        ),
        (
            lambda f: shutil.copy(next((f / "rows").glob("*")), f / "rows" / "9-9-1.parquet"),
            "is not listed: nobody reads it",
        ),
        (lambda f: _flip(f / "manifest.jsonl"), "it is not the line that was written"),
        (lambda f: (f / "manifest.jsonl").write_bytes(b""), "it is not whole: 0 of 12 flights"),
    ],
)
def test_every_damage_is_named_and_nothing_is_flown_from_it(folder, capsys, damage, said):
    damage(folder)
    before = contents(folder)
    assert main(["verify", str(folder), "--refly", "3"]) == 1
    out = capsys.readouterr().out
    assert said in out
    assert "nothing was flown again: mend the folder first" in out
    assert contents(folder) == before


def test_a_number_changed_with_all_its_checksums_is_found_by_flying_again(folder, capsys):
    """Who edits a result and signs it anew passes every checksum."""
    changed = []
    for shard in manifest.shards(folder):
        table = pq.read_table(folder / shard.rows)
        at = table.schema.get_field_index("margin_healthy")
        table = table.set_column(at, table.schema.field(at), pc.add(table["margin_healthy"], 1e-12))
        sha256 = write_table(folder / shard.rows, table, fingerprint=shard.fingerprint)
        changed.append(manifest.Shard(**{**vars(shard), "rows_sha256": sha256}))
    manifest.keep(folder, changed)
    assert main(["verify", str(folder)]) == 0
    assert main(["verify", str(folder), "--refly", "2", "--seed", "3"]) == 1
    assert "margin_healthy" in capsys.readouterr().out


def test_what_is_no_folder_of_results_is_a_message(tmp_path, folder, capsys):
    assert main(["verify", str(tmp_path)]) == 2
    assert "is no folder of results" in capsys.readouterr().err
    provenance = provenance_of(folder)
    provenance["seed_of_something"] = 1
    provenance["libraries"] = {**provenance["libraries"], "numpy": "0"}
    (folder / "provenance.json").write_text(json.dumps(provenance))
    assert main(["verify", str(folder)]) == 2
    assert "is not as it was written" in capsys.readouterr().err
