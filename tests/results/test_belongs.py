"""What belongs together: nothing is mixed that another campaign or program flew, and readers notice what is."""

import json
import re
import shutil
from dataclasses import replace

import pyarrow.parquet as pq
import pytest
from tests.results.conftest import TEXT, everything, fly

from fddbench import load, load_events, report, signals, sources
from fddbench.campaign.load import read_campaign
from fddbench.errors import OtherProgramWarning, ResultsError
from fddbench.results import manifest
from fddbench.results.fingerprint import Fingerprint, differences
from fddbench.results.folder import provenance_of
from fddbench.results.shards import write_table
from fddbench.runner import fingerprint as runner_fingerprint
from fddbench.runner.fingerprint import fingerprint_of
from fddbench.runner.work import Work, fly_and_write


def another_version(monkeypatch, **versions):
    known = runner_fingerprint.version_of
    monkeypatch.setattr(runner_fingerprint, "version_of", lambda name: versions.get(name) or known(name))


def other_source(monkeypatch, room="fddbench/metrics"):
    known = sources.own()
    monkeypatch.setattr(sources, "own", lambda: {**known, room: "0" * 64})


def test_every_shard_carries_the_fingerprint(campaign, out):
    own = fingerprint_of(campaign).sha256
    assert provenance_of(out)["fingerprints"] == [own]
    assert {shard.fingerprint for shard in manifest.shards(out)} == {own}
    for which in ("rows", "events"):
        for path in (out / which).iterdir():
            assert pq.read_schema(path).metadata[b"fddbench_fingerprint"] == own.encode()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda m: another_version(m, numpy="1.26.4"), r"numpy: \S+ there, 1.26.4 here"),
        (lambda m: another_version(m, fddbench="0.9"), r"the program: fddbench \S+ there, 0.9 here"),
        (lambda m: another_version(m, llvmlite="0.1"), "llvmlite: .* there, 0.1 here|^$"),
        (other_source, "other source code of fddbench/metrics"),
        (lambda m: m.setattr(runner_fingerprint, "SCHEMA_VERSION", "99"), r"the tables: schema version \d+ there, 99"),
    ],
)
def test_another_program_does_not_go_on(campaign, out, monkeypatch, change, message):
    if "llvmlite" in message:
        pytest.importorskip("llvmlite")
    shutil.rmtree(out / "events")
    before = everything(out)
    change(monkeypatch)
    with pytest.raises(ResultsError, match=f"(?s)another program:.*{message}.*--fresh"):
        fly(campaign, out)
    assert everything(out) == before


def test_fresh_flies_anew_and_is_of_this_program(campaign, flown, out, monkeypatch):
    other_source(monkeypatch)
    assert fly(campaign, out, fresh=True).flights == 12
    assert load(out).equals(load(flown))
    assert provenance_of(out)["fingerprints"] != provenance_of(flown)["fingerprints"]


def test_half_a_list_of_another_version(campaign, out):
    """Another program was at work here, as far as the folder knows; nothing is found done and nothing is mixed."""
    path = out / "provenance.json"
    found = json.loads(path.read_text())
    found |= {"fddbench": "0.0.9", "schema_version": "99", "libraries": found["libraries"] | {"numpy": "1.26.4"}}
    path.write_text(json.dumps(found))
    text = (out / "manifest.jsonl").read_bytes()
    (out / "manifest.jsonl").write_bytes(text[: len(text) // 2])
    before = everything(out)
    with pytest.raises(ResultsError, match=r"(?s)fddbench 0.0.9 there.*schema version 99 there.*numpy: 1.26.4 there"):
        fly(campaign, out)
    with pytest.raises(ResultsError, match=r"schema version 99, this fddbench reads.*fddbench 0.0.9.*--fresh"):
        load(out)
    assert everything(out) == before


def test_a_provenance_that_was_edited_is_seen(campaign, out):
    path = out / "provenance.json"
    text = path.read_text()
    path.write_text(text.replace(json.loads(text)["source"]["fddbench/metrics"], "0" * 64))
    with pytest.raises(ResultsError, match="not as it was written"):
        load(out)
    path.write_text(text.replace(json.loads(text)["fingerprints"][0], "0" * 64))
    for act in (load, lambda folder: fly(campaign, folder)):
        with pytest.raises(ResultsError, match="not as it was written"):
            act(out)


def relisted(folder, shard, **changes):
    """List another shard in place of one."""
    known = manifest.shards(folder)
    manifest.keep(folder, [replace(each, **changes) if each == shard else each for each in known])


def test_a_shard_of_a_fingerprint_that_is_not_listed_is_refused(campaign, out):
    relisted(out, manifest.shards(out)[0], fingerprint="f" * 64)
    with pytest.raises(ResultsError, match="was flown by a campaign or program that the folder does not list"):
        load(out)
    with pytest.raises(ResultsError, match="lists shards of another campaign or program.*--fresh"):
        fly(campaign, out)


def test_a_table_that_carries_another_fingerprint_is_refused(out):
    shard = manifest.shards(out)[0]
    table = pq.read_table(out / shard.rows)
    relisted(out, shard, rows_sha256=write_table(out / shard.rows, table, fingerprint="f" * 64))
    with pytest.raises(ResultsError, match=f"{re.escape(shard.rows)} carries another fingerprint"):
        load(out)


def _renamed(table):
    renamed = table.rename_columns(["run_number" if name == "run" else name for name in table.column_names])
    return renamed.replace_schema_metadata(table.schema.metadata)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda table: table.replace_schema_metadata({"fddbench_schema": "0"}), "has schema version 0, this fddbench"),
        (lambda table: table.replace_schema_metadata(None), "has schema version none"),
        (_renamed, "foreign schema: column run is missing, needs int64"),
        (lambda table: table.append_column("more", table["run"]), "have different columns"),
    ],
)
def test_a_table_of_another_schema_is_refused(out, change, message):
    shard = manifest.shards(out)[0]
    table = change(pq.read_table(out / shard.rows))
    relisted(out, shard, rows_sha256=write_table(out / shard.rows, table, fingerprint=shard.fingerprint))
    with pytest.raises(ResultsError, match=f"{message}.*--fresh"):
        load(out)


def test_a_listed_file_that_is_no_table_is_refused(out):
    shard = manifest.shards(out)[0]
    (out / shard.rows).write_bytes(b"no table")
    relisted(out, shard, rows_sha256="6e5d0a9f1c6b5a0a3a31f1cbe5f1b0f0d9a4e6a8d6f6d9a2e1a1e3e0a7f5c4b2")
    with pytest.raises(ResultsError, match="is not the file that was written"):
        load(out)
    from hashlib import sha256

    relisted(out, manifest.shards(out)[0], rows_sha256=sha256(b"no table").hexdigest())
    with pytest.raises(ResultsError, match="is no table of fddbench"):
        load(out)


def test_missing_events_are_no_shorter_table(out):
    next((out / "events").iterdir()).unlink()
    with pytest.raises(ResultsError, match="is missing; run the campaign again"):
        load_events(out)


def test_a_worker_of_another_program_writes_nothing(campaign, out, monkeypatch):
    own, before = fingerprint_of(campaign).sha256, everything(out)
    other_source(monkeypatch)
    with pytest.raises(ResultsError, match="a worker .* is another program than its parent .*fddbench/metrics"):
        fly_and_write(Work(folder=str(out / "." / "."), fingerprint=own, backend="numpy"), ((0, 2),))
    assert everything(out) == before


def test_replay_by_another_program_says_so(out, monkeypatch):
    assert signals(out, "jam", ["0/0/1"]).cases == ("jam/0/0/1",)
    other_source(monkeypatch)
    with pytest.warns(
        OtherProgramWarning, match=r"was flown by another program \(other source code of fddbench/metrics\)"
    ):
        assert signals(out, "jam", ["0/0/1"]).cases == ("jam/0/0/1",)
    with pytest.warns(OtherProgramWarning):
        page = report(out).read_text()
    assert "signals flown again by another program" in page


def test_another_name_for_the_same_campaign_is_the_same(out, tmp_path):
    """What only describes a campaign decides no row."""
    (tmp_path / "again.yaml").write_text(TEXT.replace("name: small", "name: small\nabout: in other words"))
    again = read_campaign(tmp_path / "again.yaml")
    assert fly(again, out).flights == 0
    assert "in other words" in (out / "campaign.yaml").read_text()
    (out / "campaign.yaml").unlink()
    assert fly(again, out).flights == 0
    assert report(out).is_file()


def test_differences_are_told_in_words():
    plain = {"campaign_sha256": "", "schema_version": "1", "fddbench": "1.0", "libraries": {}, "source": {}}
    a = Fingerprint(files={"detectors/w.npy": "a", "detectors/x.py": "a", "detectors/y.py": "a"}, **plain)
    b = Fingerprint(files={"detectors/w.npy": "b", "detectors/z.py": "a"}, **plain)
    assert differences(a, a) == ()
    assert differences(a, b) == (
        "the file detectors/w.npy is not the same",
        "the files detectors/x.py, detectors/y.py are there and not here",
        "the file detectors/z.py is here and not there",
    )
    assert a.sha256 != b.sha256
    assert Fingerprint.of(json.loads(json.dumps(a.parts()))) == a
