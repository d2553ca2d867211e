"""Laws of merging: a merged kernel flies the same bits, equal states are one, and what the caller keeps apart stays apart."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.blocks import kernel, llvm
from fddbench.blocks.kernel import Addresses, build
from fddbench.blocks.merge import check_alike, expand_state, merged, shared, shrink_state, start_keys
from fddbench.blocks.program import Program, trace
from fddbench.blocks.ring import ring
from fddbench.errors import FddbenchError

NOWHERE = Addresses(key=3, run=np.arange(19), flight=1, scenario=2)
N_LOOP, N_EACH = 3, 6


def _detector(x: Any, seen: Any, sample: Any, floor: float, limit: float) -> tuple[Any, Any]:
    """Detector of six states: filter, threshold, counter, and a ring of three."""
    residual = 0.9 * x[0] + 0.1 * np.abs(seen)
    threshold = np.maximum(0.95 * x[1] + 0.05 * residual, floor)
    rows, oldest = ring(x[3:6], residual, sample)
    count = np.where(oldest > threshold * limit, x[2] + 1.0, np.maximum(x[2] - 1.0, 0.0))
    return np.concatenate([np.stack([residual, threshold, count]), rows]), (count > 3.0)


def _bank(variants: list[tuple[float, float]]) -> Program:
    """A loop and several variants of one detector."""

    def step(state: Any, constants: Any, normals: Any, sample: Any) -> dict[str, Any]:
        loop = np.concatenate([0.9 * state[:2] + normals[:2] + constants[:2], state[2:3] * 0.5])
        parts, alarms = [loop], []
        for j, (floor, limit) in enumerate(variants):
            x = state[N_LOOP + j * N_EACH :][:N_EACH]
            after, alarm = _detector(x, loop[0] - loop[1], sample, floor, limit)
            parts.append(after)
            alarms.append(alarm)
        return {
            "state": np.concatenate(parts),
            "alarms": np.stack(alarms),
            "finished": (sample > 25.0) & alarms[0][np.newaxis],
        }

    return trace(step, state=N_LOOP + N_EACH * len(variants), constants=2, normals=4, sample=0)


def _start(n_variants: int, n_cases: int = 19) -> tuple[Any, Any]:
    rng = np.random.default_rng(4)
    loop = rng.normal(size=(N_LOOP, n_cases))
    each = np.repeat([[0.0], [0.01], [0.0], [0.0], [0.0], [0.0]], n_cases, axis=1)
    return np.concatenate([loop, *[each] * n_variants]), rng.normal(size=(2, n_cases))


def _keys(state: Any) -> list[Any]:
    return start_keys(state, [row >= N_LOOP for row in range(len(state))])


def _flown(program: Program, n_variants: int, **how: Any) -> Any:
    state, constants = _start(n_variants)
    kernel = build(program, streams=((1, "flight"),), recorded=("alarms",), **how)
    return kernel.fly(state, constants, np.full(19, 40), NOWHERE, first=0, end=40)


VARIANTS = [(0.02, 1.0), (0.02, 1.1), (0.05, 1.0), (0.02, 1.0)]


def test_a_merged_kernel_flies_the_same_bits(where: Any, same: Any) -> None:
    program, keys = _bank(VARIANTS), _keys(_start(4)[0])
    expected = _flown(program, 4, backend="numpy")
    for how in ({"backend": "numpy"}, where):
        found = _flown(program, 4, merge=keys, **how)
        assert same(found.state, expected.state)
        assert same(found.recorded["alarms"], expected.recorded["alarms"])
        assert np.array_equal(found.samples, expected.samples)
    assert np.nanmax(expected.recorded["alarms"]) == 1.0


def test_what_does_not_differ_is_flown_once() -> None:
    _, classes = merged(_bank(VARIANTS), _keys(_start(4)[0]))
    loop, first, limit, floor, again = (classes[:3], *(classes[3 + 6 * j : 9 + 6 * j] for j in range(4)))
    assert loop == [0, 1, 2]
    assert again == first
    assert [a == b for a, b in zip(limit, first, strict=True)] == [True, True, False, True, True, True]
    assert [a == b for a, b in zip(floor, first, strict=True)] == [True, False, False, True, True, True]
    assert len(set(classes)) == 3 + 6 + 1 + 2


def test_states_of_the_loop_never_merge() -> None:
    program = trace(lambda state: {"state": state * 0.5}, state=4)
    keys = start_keys(np.zeros((4, 7)), [False, False, True, True])
    assert merged(program, keys)[1] == [0, 1, 2, 2]


def test_starts_that_differ_between_cases_or_in_a_bit_do_not_merge() -> None:
    program = trace(lambda state: {"state": state * 0.5}, state=5)
    start = np.array([[0.0, 1.0], [0.0, 1.0], [0.0, 0.0], [0.0, 0.0], [-0.0, -0.0]])
    assert merged(program, start_keys(start, [True] * 5))[1] == [0, 1, 2, 2, 3]


def test_a_long_delay_line_is_split_row_by_row() -> None:
    def step(state: Any, sample: Any) -> dict[str, Any]:
        lines = [np.concatenate([(sample + 1.0) * np.ones((1, 1)), x[:-1]]) for x in (state[:300], state[300:])]
        return {"state": np.concatenate(lines)}

    _, classes = merged(trace(step, state=600, sample=0), [0] * 600)
    assert classes == [*range(300), *range(300)]


def test_rings_stay_rings() -> None:
    pytest.importorskip("llvmlite")

    def step(state: Any, sample: Any) -> dict[str, Any]:
        parts = [ring(state[first : first + 200], sample + 1.0, sample)[0] for first in (0, 200)]
        return {"state": np.concatenate(parts)}

    kernel = build(trace(step, state=400, sample=0), merge=[0] * 400, backend="llvm")
    assert len(kernel.kernel.text().splitlines()) < 200  # type: ignore[attr-defined]


def test_simplifications_that_merging_makes_possible_are_used() -> None:
    def step(state: Any, sample: Any) -> dict[str, Any]:
        a, b, c, d = state
        chosen = np.where(sample > 3.0, a, b)  # one number, once a and b are known to be equal
        return {"state": np.stack([a + 1.0, b + 1.0, c + chosen, d + a])}

    program, classes = merged(trace(step, state=4, sample=0), [0] * 4)
    assert classes == [0, 0, 1, 1]
    assert "select" not in program.counts


@settings(max_examples=25, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5), st.booleans()), min_size=6, max_size=6), st.data())
def test_merged_rows_are_equal_in_flight(same: Any, rules: list[tuple[int, int, bool]], data: Any) -> None:
    """Random updates from random starts."""

    def step(state: Any) -> dict[str, Any]:
        rows = [np.maximum(state[a], state[b]) if top else state[a] - 0.5 * state[b] for a, b, top in rules]
        return {"state": np.stack(rows)}

    start = data.draw(st.lists(st.sampled_from([0.0, 1.0]), min_size=6, max_size=6))
    program = trace(step, state=6)
    _, classes = merged(program, start)
    x = np.array(start)[:, np.newaxis]
    for _ in range(12):
        check_alike(x, classes)
        x = step(x)["state"]
    fly = {"constants": np.zeros((0, 1)), "samples": np.array([12]), "addresses": NOWHERE, "first": 0, "end": 12}
    begin = np.array(start)[:, np.newaxis]
    assert same(build(program, backend="numpy", merge=start).fly(begin, **fly).state, x)


def test_state_arrays_shrink_and_grow() -> None:
    classes, state = [0, 1, 0, 2], np.array([[1.0], [2.0], [1.0], [3.0]])
    assert shrink_state(state, classes).ravel().tolist() == [1.0, 2.0, 3.0]
    assert np.array_equal(expand_state(shrink_state(state, classes), classes), state)


def test_a_promise_that_is_not_kept_is_seen_before_flying() -> None:
    kernel = build(trace(lambda state: {"state": state * 0.5}, state=3), merge=["a", "b", "a"], backend="numpy")
    with pytest.raises(FddbenchError, match="state rows 0 and 2 were merged but differ"):
        kernel.fly(np.array([[1.0], [1.0], [1.5]]), np.zeros((0, 1)), np.array([3]), NOWHERE, first=0, end=3)


def test_one_key_a_row() -> None:
    with pytest.raises(FddbenchError, match="need a key for each of the 3 state rows, got 2"):
        build(trace(lambda state: {"state": state}, state=3), merge=[1, 2], backend="numpy")


def test_draws_are_told_once() -> None:
    program = trace(lambda state, normals: {"state": state + normals[:1]}, state=1, normals=4)
    with pytest.raises(FddbenchError, match="draws are told twice"):
        build(program, streams=((1, "flight"),), consumers=(1,), backend="numpy")


def test_streams_in_any_order(same: Any) -> None:
    program = trace(lambda state, normals: {"state": state, "y": normals}, state=1, normals=8)
    where = Addresses(key=3, run=np.arange(5), flight=1, scenario=np.arange(5) + 7)
    rows = [
        build(program, streams=streams, recorded=("y",)).fly(
            np.zeros((1, 5)), np.zeros((0, 5)), np.ones(5, dtype=np.int64), where, first=0, end=1
        ).recorded["y"][0]
        for streams in (((4, "scenario"), (2, "flight")), ((2, "flight"), (4, "scenario")))
    ]  # fmt: skip
    assert same(rows[0], np.concatenate([rows[1][4:], rows[1][:4]]))


def test_what_was_merged_once_is_merged_again_in_one_go() -> None:
    """A kernel from the cache knows the classes only."""
    program = _bank([(0.1, 1.0), (0.2, 1.0), (0.1, 1.0)]).keep("state", "finished")
    fewer, classes = merged(program, _keys(_start(3)[0]))
    assert len(set(classes)) < len(classes)
    assert shared(program, classes).hash == fewer.hash
    assert program.only("state").hash == program.keep("state").hash


@pytest.mark.skipif(not llvm.available(), reason="no llvmlite")
def test_a_kernel_is_merged_once(monkeypatch: pytest.MonkeyPatch, tmp_path: Any, same: Any) -> None:
    monkeypatch.setenv("FDDBENCH_CACHE", str(tmp_path))
    program, (state, _) = _bank([(0.1, 1.0), (0.2, 1.0), (0.1, 1.0)]), _start(3)
    first = _flown(program, 3, merge=_keys(state))
    monkeypatch.setattr(kernel, "merged", None)
    again = _flown(program, 3, merge=_keys(state))
    assert same(again.state, first.state)
