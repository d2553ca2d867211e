"""Records and their places in one array: nothing is lost, nothing changes places, and what does not fit is refused by name."""

import re
from dataclasses import FrozenInstanceError, dataclass, fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fddbench.blocks.block import Stateless, program
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, filled, leaves, mapped, record


@record
class Pair:
    left: object
    right: object


@record
class Triple:
    first: object
    second: object
    third: object


@record
class Single:
    only: object


KINDS = (Pair, Triple, Single, Nothing)


def record_of(parts):
    """Shape of one of the records above, of the given parts."""
    kind = next(kind for kind in KINDS if len(fields(kind)) == len(parts))
    return kind(**{field.name: part for field, part in zip(fields(kind), parts, strict=True)})


shapes = st.recursive(
    st.integers(0, 4),
    lambda part: st.lists(part, max_size=3).flatmap(lambda parts: st.sampled_from([record_of(parts), tuple(parts)])),
    max_leaves=8,
).filter(lambda shape: not isinstance(shape, int))


@given(shapes, st.integers(1, 5))
def test_unpacking_what_was_packed_gives_it_back(shape, n_cases):
    layout = Layout(shape)
    rows = np.arange(layout.size * n_cases, dtype=float).reshape(layout.size, n_cases)
    named = layout.unpack(rows)
    assert type(named) is type(shape)
    assert layout.pack(named, n_cases).tobytes() == rows.tobytes()
    layout.check(named, n_cases)


@given(shapes, st.integers(1, 4), st.randoms(use_true_random=False))
def test_packing_what_was_unpacked_gives_it_back(shape, n_cases, random):
    layout = Layout(shape)
    values = mapped(
        lambda rows: np.array([[random.random() for _ in range(n_cases)] for _ in range(rows or 1)])[() if rows else 0],
        shape,
    )
    again = layout.unpack(layout.pack(values, n_cases))
    for (path, given_), (same, found) in zip(leaves(values), leaves(again), strict=True):
        assert path == same
        assert np.array_equal(given_, found)


@given(shapes)
def test_places_follow_each_other_and_every_row_has_a_name(shape):
    layout = Layout(shape)
    assert len(layout.names) == len(set(layout.names)) == layout.size
    rows = [np.arange(layout.size)[place] for place in layout.places.values()]
    assert np.concatenate([np.atleast_1d(each) for each in rows] or [[]]).tolist() == list(range(layout.size))
    assert list(layout.places) == [path for path, _ in leaves(shape)]


NESTED = Pair(left=ROW, right=(2, Single(only=Pair(left=3, right=ROW)), Nothing()))


def test_paths_and_names_say_where_a_leaf_is():
    layout = Layout(NESTED)
    assert list(layout.counts) == ["left", "right.0", "right.1.only.left", "right.1.only.right"]
    assert layout.names == (
        *("left", "right.0_1", "right.0_2"),
        *("right.1.only.left_1", "right.1.only.left_2", "right.1.only.left_3", "right.1.only.right"),
    )
    assert layout.unpack(np.zeros((7, 4))).right[1].only.left.shape == (3, 4)
    assert layout.unpack(np.zeros((7, 4))).right[1].only.right.shape == (4,)


def test_unpacked_leaves_are_views():
    rows = np.zeros((7, 2))
    Layout(NESTED).unpack(rows).right[1].only.left[1] = 5.0
    assert rows[4].tolist() == [5.0, 5.0]


@given(shapes, st.floats(-10, 10), st.integers(1, 5))
def test_spreading_repeats_numbers_and_keeps_arrays(shape, value, n_cases):
    layout = Layout(shape)
    spread = layout.spread(mapped(lambda _: value, shape), n_cases)
    layout.check(spread, n_cases)
    assert (layout.pack(spread, n_cases) == value).all()
    assert layout.pack(mapped(lambda _: value, shape), n_cases).tobytes() == layout.pack(spread, n_cases).tobytes()
    rows = np.random.default_rng(0).normal(size=(layout.size, n_cases))
    kept = layout.spread(layout.unpack(rows), n_cases)
    assert layout.pack(kept, n_cases).tobytes() == rows.tobytes()


def test_spreading_a_column_repeats_it_for_every_case():
    layout = Layout(Pair(left=ROW, right=2))
    spread = layout.spread(Pair(left=np.array([1.0, 2.0, 3.0]), right=np.array([[4.0], [5.0]])), 3)
    assert layout.pack(spread, 3).tolist() == [[1.0, 2.0, 3.0], [4.0] * 3, [5.0] * 3]


LAYOUT = Layout(Pair(left=ROW, right=Pair(left=2, right=ROW)))
GOOD = Pair(left=np.zeros(3), right=Pair(left=np.zeros((2, 3)), right=np.zeros(3)))


def everywhere(values):
    """Both doors that a wrong record may come through."""
    return (lambda: LAYOUT.pack(values, 3)), (lambda: LAYOUT.check(values, 3))


@pytest.mark.parametrize(
    ("values", "missing", "unknown"),
    [
        (Single(only=1.0), ["left", "right.left", "right.right"], ["only"]),
        (Pair(left=0.0, right=0.0), ["right.left", "right.right"], ["right"]),
        (Pair(left=0.0, right=Single(only=1.0)), ["right.left", "right.right"], ["right.only"]),
        (Pair(left=Nothing(), right=Pair(left=0.0, right=0.0)), ["left"], []),
        (Pair(left=0.0, right=(1.0, 2.0)), ["right.left", "right.right"], ["right.0", "right.1"]),
        (Nothing(), ["left", "right.left", "right.right"], []),
    ],
)
def test_missing_and_unknown_leaves_are_refused_by_name(values, missing, unknown):
    """In declared order: the text may become part of a row, and a row is the same every time."""
    expected = f"need exactly the fields ['left', 'right.left', 'right.right'], {missing=}, {unknown=}"
    for refused in (*everywhere(values), lambda: LAYOUT.spread(values, 3)):
        with pytest.raises(TypeError, match=f"^{re.escape(expected)}$"):
            refused()


@pytest.mark.parametrize(
    ("left", "inner", "message"),
    [
        (np.zeros((1, 3)), np.zeros((2, 3)), "left needs the shape (n_cases,), got (1, 3)"),
        (np.zeros(()), np.zeros((2, 3)), "left needs the shape (n_cases,), got ()"),
        (np.zeros(3), np.zeros((3, 3)), "right.left needs the shape (2, n_cases), got (3, 3)"),
        (np.zeros(3), np.zeros(3), "right.left needs the shape (2, n_cases), got (3,)"),
        (np.zeros(3), np.zeros((2, 3, 1)), "right.left needs the shape (2, n_cases), got (2, 3, 1)"),
    ],
)
def test_a_wrong_shape_is_refused_with_its_path(left, inner, message):
    for refused in everywhere(Pair(left=left, right=Pair(left=inner, right=np.zeros(3)))):
        with pytest.raises(TypeError, match=f"^{re.escape(message)}$"):
            refused()
    LAYOUT.check(GOOD, 3)
    assert LAYOUT.pack(GOOD, 3).shape == (4, 3)


def test_check_refuses_another_number_of_cases_and_plain_numbers():
    with pytest.raises(TypeError, match=r"left needs the shape \(n_cases,\), got \(3,\)"):
        LAYOUT.check(GOOD, 4)
    with pytest.raises(TypeError, match=r"left needs the shape \(n_cases,\), got \(\)"):
        LAYOUT.check(Pair(left=0.0, right=GOOD.right), 3)


@record
class Reversed:
    """The fields of `Pair` in the other order."""

    right: object
    left: object


def test_leaves_are_placed_by_name_and_never_by_order():
    for rows in (ROW, 2):
        values = Reversed(right=np.full((rows, 1) if rows else 1, 7.0), left=np.ones(1))
        layout = Layout(Pair(left=ROW, right=rows))
        layout.check(values, 1)
        assert layout.pack(values).ravel().tolist() == [1.0] + [7.0] * (rows or 1)
        assert layout.unpack(layout.pack(layout.spread(values, 1))).left.tolist() == [1.0]


def test_a_record_is_frozen_made_by_keyword_and_complete():
    pair = Pair(left=1.0, right=2.0)
    with pytest.raises(FrozenInstanceError):
        pair.left = 3.0
    with pytest.raises((FrozenInstanceError, AttributeError, TypeError)):
        pair.other = 3.0
    with pytest.raises(TypeError, match="positional"):
        Pair(1.0, 2.0)
    with pytest.raises(TypeError, match="right"):
        Pair(left=1.0)


def test_another_dataclass_is_a_leaf():
    @dataclass(frozen=True)
    class Plain:
        inside: int

    plain = Plain(1)
    assert list(leaves(Pair(left=plain, right=(plain,)))) == [("left", plain), ("right.0", plain)]
    assert list(leaves(Pair)) == [("", Pair)]  # a class is no record of values


def test_mapping_takes_the_leaves_of_several_records_together():
    one, other = Pair(left=1, right=(2, 3)), Pair(left=10, right=(20, 30))
    assert mapped(lambda a, b: a + b, one, other) == Pair(left=11, right=(22, 33))
    assert filled(one, iter("abc")) == Pair(left="a", right=("b", "c"))


@pytest.mark.parametrize("shape", [Nothing(), (), Pair(left=Nothing(), right=())])
def test_nothing_takes_no_row(shape):
    layout = Layout(shape)
    assert (layout.size, layout.names) == (0, ())
    assert layout.pack(layout.unpack(np.zeros((0, 3))), 3).shape == (0, 3)


@record
class Levels:
    slow: Row
    fast: Rows


class Lags(Stateless):
    """A block whose size depends on the instance."""

    def __init__(self, n):
        self.states = Layout(Levels(slow=ROW, fast=n))

    def step(self, x, c, n, u):
        del c, n
        return Levels(slow=0.9 * x.slow + 0.1 * u, fast=0.5 * x.fast + 0.5 * u), x.slow


@pytest.mark.parametrize("n", [1, 4])
def test_every_block_can_be_traced_alone(n):
    block = Lags(n)
    traced = program(block, shown=lambda slow: {"slow": slow}, u=0)
    assert len(traced.outputs["state"]) == n + 1
    assert len(traced.outputs["slow"]) == 1
    begun = block.states.spread(block.start(Nothing()), 2)
    assert not block.states.pack(begun, 2).any()
    after, _ = block.step(begun, Nothing(), Nothing(), np.array([1.0, 2.0]))
    assert block.states.pack(after).tolist() == [[0.1, 0.2], *[[0.5, 1.0]] * n]
