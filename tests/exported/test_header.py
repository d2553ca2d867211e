"""The header as its reader sees it: units, no shapes of Python, no line that is too long."""

import pytest

from fddbench.cli.exporting import _symbols
from fddbench.errors import DesignError
from fddbench.exported.symbols import library
from tests.exported.conftest import exported, traceable


def test_the_limit_of_usable_inputs_is_said(voting_monitor):
    _, header, source = voting_monitor
    said = " * Whether all inputs are numbers of at most 1e+09 in size, each in its own unit\n"
    assert said in header
    assert said in source


@pytest.mark.slow
def test_members_are_told_in_words_of_c():
    for at in traceable().values():
        _, header, _ = exported(*at)
        assert "n_cases" not in header, at
        assert max(map(len, header.splitlines())) <= 100, at


def test_a_long_comment_stands_above_its_member():
    _, header, _ = exported("smoke", "sliding_mode_published")
    assert "first sample. */\n    double energy_before[3];\n" in header


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("scalar", "scalar"),
        ("lookup:64", [{"lookup": 64}]),
        ("add", ["add"]),
        ("add,mul", ["add", "mul"]),
        ("ad", "ad"),
    ],
)
def test_symbols_of_a_command(text, wanted):
    assert _symbols(text) == wanted


def test_a_library_that_is_not_known_is_said():
    with pytest.raises(DesignError, match="no symbol library is called 'ad'"):
        library(_symbols("ad"))
