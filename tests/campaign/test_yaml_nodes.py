import contextlib

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from fddbench.campaign.reading import yaml_nodes
from fddbench.campaign.reading.canonical import canonical_text
from fddbench.campaign.reading.scalars import resolve
from fddbench.campaign.reading.yaml_nodes import parse
from fddbench.errors import CampaignError

words = st.text(st.characters(codec="utf-8", exclude_categories=["Cc", "Cs", "Cn", "Co"]), max_size=30)
tricky = st.sampled_from(
    ["1e-3", "010", "on", "yes", "null", "", "0o17", "0x1F", "~", ".inf", "- a", "a: b", "# c", "<<"]
)
texts = words | tricky | st.lists(words, max_size=3).map("\n".join)
numbers = st.integers(-(2**70), 2**70) | st.floats(allow_nan=False, allow_infinity=False)
scalars = texts | numbers | st.booleans() | st.none()
keys = (words | tricky).filter(lambda word: word != "<<")
data = st.recursive(
    scalars, lambda inner: st.lists(inner, max_size=4) | st.dictionaries(keys, inner, max_size=4), max_leaves=15
)


@given(data)
def test_canonical_text_reads_back_and_is_a_fixed_point(content):
    text = canonical_text(content)
    again = parse(text, name="x").data
    assert again == content
    assert canonical_text(again) == text


@given(st.binary(max_size=200) | st.text(max_size=200).map(lambda text: text.encode("utf-8", "replace")))
def test_anything_else_is_read_or_refused(raw):
    with contextlib.suppress(CampaignError):
        parse(raw.decode("utf-8", "replace"), name="x")


@pytest.mark.parametrize(
    ("word", "value"),
    [
        ("1e-3", 1e-3),
        ("010", 10),
        ("on", "on"),
        ("no", "no"),
        ("1_000", "1_000"),
        ("12:30", "12:30"),
        ("0x1F", 31),
        ("0o17", 15),
    ],
)
def test_words_mean_what_yaml_1_2_says(word, value):
    assert resolve(word) == value
    assert type(resolve(word)) is type(value)


def test_quoted_numbers_are_text():
    assert parse("a: '1'\nb: \"2\"\nc: |\n  3\n", name="x").data == {"a": "1", "b": "2", "c": "3\n"}


def test_places_count_from_one():
    document = parse("a: 1\nb:\n  - {c: 2}\n", name="x")
    assert document.keys[("b", 0, "c")] == "x:3:6"
    assert document.values[("b", 0, "c")] == "x:3:9"
    assert document.where(("b", 0, "missing")) == "x:3:5"
    assert document.where(("a",), key=True) == "x:1:1"


@pytest.mark.parametrize("text", ["1e999", "9" * 100, ".INF", "-.inf", ".NaN"])
def test_refuses_numbers_without_size(text):
    with pytest.raises(CampaignError, match=r"x:1:4: "):
        parse(f"a: {text}\n", name="x")


DEEP = {
    "lists": ("a: " + "[" * 5000, "x:1:36"),
    "mappings": ("a: " + "{a: " * 5000, "x:1:132"),
    "blocks": ("- " * 5000, "x:1:67"),
    "keys": ("? " * 5000, "x:1:67"),
    "keys_in_line": ("{? " * 5000, "x:1:100"),
    "lists_as_keys": ("{[" * 3000, "x:1:34"),
    "indented": ("\n".join(" " * level + "a:" for level in range(2000)), "x:34:34"),
    "closed": ("[" * 34 + "]" * 34, "x:1:34"),
    "then_a_mistake": ("a: " + "[" * 500 + "\nb: }", "x:1:36"),
}


@pytest.mark.parametrize("loader", [yaml.SafeLoader, getattr(yaml, "CSafeLoader", yaml.SafeLoader)])
@pytest.mark.parametrize(("text", "place"), DEEP.values(), ids=DEEP)
def test_depth_is_refused_in_our_words_whatever_the_limit_of_pyyaml(text, place, loader, monkeypatch):
    monkeypatch.setattr(yaml_nodes, "_LOADER", loader)
    with pytest.raises(CampaignError, match="nested deeper than 32 levels; a campaign needs six") as caught:
        parse(text, name="x")
    assert [mistake.where for mistake in caught.value.mistakes] == [place]


def test_32_levels_are_read():
    assert parse("[" * 33 + "]" * 33, name="x").data


def test_a_limit_of_pyyaml_hides_no_mistake_found_before_it():
    with pytest.raises(CampaignError, match="anchors") as caught:
        parse("a: &b 1\nc: " + "[" * 5000, name="x")
    assert [mistake.where for mistake in caught.value.mistakes] == ["x:1:4", "x:2:36"]
