"""The list of a folder: a cut-off append is no line, anything else that is not as it was written is damage."""

import json

import pytest
from tests.results.conftest import everything, fly

from fddbench import load
from fddbench.errors import PartialResultsWarning, ResultsError
from fddbench.results import manifest
from fddbench.results.whole import holdings


def test_a_last_line_without_its_end_is_flown_again(campaign, flown, out):
    path, before = out / "manifest.jsonl", load(flown)
    for cut in (1, 40):
        path.write_bytes((flown / "manifest.jsonl").read_bytes()[:-cut])
        with pytest.warns(PartialResultsWarning, match=r"partial, it holds 10 of 12 flights: \w+ 5 of 6"):
            assert len(load(out)) == 10
        assert fly(campaign, out).flights == 2
        assert load(out).equals(before)
        assert path.read_bytes() == (flown / "manifest.jsonl").read_bytes()


@pytest.mark.slow
def test_every_flipped_bit_is_an_error_or_a_cut_off_append(out):
    """Of a list of three lines. Seen to fail without the checksum of a line: digits of counts and cases change unseen."""
    path = out / "manifest.jsonl"
    lines = path.read_bytes().splitlines(keepends=True)[:3]
    text = b"".join(lines)
    whole = manifest.survey(out).shards[:3]
    for bit in range(8 * len(text)):
        flipped = bytearray(text)
        flipped[bit // 8] ^= 1 << bit % 8
        path.write_bytes(flipped)
        found = manifest.survey(out)
        cut_off = flipped[-1:] != b"\n"
        assert found.wrong or (cut_off and found.shards == whole[:2]), (bit, flipped)
        assert all(shard in whole for shard in found.shards)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda lines: [*lines, b"\n"], "line 7: it is not the line that was written"),
        (lambda lines: [*lines, b"\xff\n"], "line 7: it is not"),
        (lambda lines: [*lines, lines[0]], "line 7: it lists flights that an earlier line has"),
        (lambda lines: [lines[0].replace(b'"ok": 2', b'"ok": 3'), *lines[1:]], "line 1: it is not"),
        (lambda lines: [lines[0][:50] + b"\n", *lines[1:]], "line 1: it is not"),
        (lambda lines: [line.replace(b"rows/", b"../rows/", 1) for line in lines], "line 1: .*5 more like it"),
    ],
)
def test_any_other_damage_is_an_error_that_deletes_nothing_and_is_mended(campaign, flown, out, change, message):
    path = out / "manifest.jsonl"
    path.write_bytes(b"".join(change(path.read_bytes().splitlines(keepends=True))))
    before = everything(out)
    for read in (load, holdings):
        with pytest.raises(ResultsError, match=f"manifest.jsonl, {message}.*run the campaign again"):
            read(out)
    assert everything(out) == before
    told = []
    fly(campaign, out, notice=told.append)
    assert any("its flights are flown again" in text for text in told)
    assert load(out).equals(load(flown))


def test_a_missing_list_is_an_error(campaign, out):
    (out / "manifest.jsonl").unlink()
    before = everything(out)
    for act in (load, lambda folder: fly(campaign, folder)):
        with pytest.raises(ResultsError, match=r"manifest.jsonl cannot be read \(No such file.*--fresh"):
            act(out)
    assert everything(out) == before
    assert fly(campaign, out, fresh=True).flights == 12


def test_a_list_that_ends_early_is_partial(out):
    path = out / "manifest.jsonl"
    path.write_bytes(b"".join(path.read_bytes().splitlines(keepends=True)[:2]))
    assert sum(holdings(out).held.values()) == 4
    path.write_bytes(b"")
    with pytest.raises(ResultsError, match="holds no rows yet"):
        load(out)


def test_flights_beyond_the_case_table_are_an_error(out):
    path = out / "provenance.json"
    found = json.loads(path.read_text())
    found["flights"]["jam"] = 3
    path.write_text(json.dumps(found))
    with pytest.raises(ResultsError, match="flights beyond the 9"):
        load(out)
