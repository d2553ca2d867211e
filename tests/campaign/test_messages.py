"""Golden messages: every bad campaign of ``tests/bad_campaigns`` says where, what, what is allowed and what to do.

After a deliberate change: ``FDDBENCH_REWRITE=1 pytest tests/campaign/test_messages.py``, then read the difference.
"""

import os
import time
from pathlib import Path

import pytest

from fddbench.campaign.load import read_campaign
from fddbench.errors import CampaignError

FOLDER = Path(__file__).parent.parent / "bad_campaigns"
FILES = sorted([*FOLDER.glob("*.yaml"), *FOLDER.glob("*.set")])


def refusal(path, overrides=()):
    with pytest.raises(CampaignError, match=".") as caught:
        read_campaign(path, overrides)
    return str(caught.value)


@pytest.mark.parametrize("file", FILES, ids=lambda path: path.name)
def test_says_what_is_wrong(file, monkeypatch):
    monkeypatch.chdir(FOLDER)
    override = file.suffix == ".set"
    base, overrides = ("good_but_set.base", [file.read_text().strip()]) if override else (file.name, [])
    started = time.perf_counter()
    message = refusal(Path(base), overrides) + "\n"
    assert time.perf_counter() - started < 2.0
    expected = file.with_suffix(".txt")
    if os.environ.get("FDDBENCH_REWRITE"):
        expected.write_text(message)
    assert message == expected.read_text()
    assert max(map(len, message.splitlines())) < 500


BINARY = {
    "nul.yaml": (b"name: de\x00mo\n", "nul.yaml:1:9: control character U+0000; a campaign is plain text."),
    "elf.yaml": (b"\x7fELF\x02\x01\x01\x00", "elf.yaml:1:1: control character U+007F"),
    "png.yaml": (b"\x89PNG\r\n\x1a\n", "png.yaml:1:1: byte 0x89 is not UTF-8 text; is this a binary file?"),
    "latin.yaml": (b"name: x\nabout: S\xf8gaard\n", "latin.yaml:2:9: byte 0xf8 is not UTF-8 text"),
    "utf16.yaml": ("name: x".encode("utf-16"), "utf16.yaml:1:1: byte 0xff is not UTF-8 text"),
    "large.yaml": (b"# " + b"x" * 4_000_000, "large.yaml: larger than 4 MB; a campaign is a page of text"),
    "escape.yaml": (b'name: "a\\0b"\n', "escape.yaml:1:7: control characters are not read"),
}


@pytest.mark.parametrize("name", BINARY)
def test_refuses_what_is_not_text(name, tmp_path, monkeypatch):
    content, expected = BINARY[name]
    monkeypatch.chdir(tmp_path)
    Path(name).write_bytes(content)
    assert refusal(Path(name)).startswith(expected)


def test_refuses_a_missing_file_and_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert refusal(Path("missing/x.yaml")).startswith("missing/x.yaml: no such file.")
    assert "is a folder" in refusal(tmp_path)


def test_many_mistakes_stay_readable(write):
    path = write(**{"seed: 7": "seed: 7\n" + "\n".join(f"key_{n}: 1" for n in range(200))})
    assert len(refusal(path).splitlines()) == 52
    assert "and 150 more mistakes" in refusal(path)
