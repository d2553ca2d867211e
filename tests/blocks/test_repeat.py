"""Laws of repeats and of the integrator made of them: a loop is its body so many times, to the bit, everywhere."""

from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fddbench.blocks import functions
from fddbench.blocks.accounting import cost
from fddbench.blocks.integrate import rk4
from fddbench.blocks.linear import column, product
from fddbench.blocks.lookup import Grid, Lookup
from fddbench.blocks.program import trace
from fddbench.blocks.repeat import repeat
from fddbench.blocks.trouble import TraceError

GRID = Grid([-1.0, 0.0, 2.0])
TABLE = Lookup([1.0, -1.0, 3.0], GRID)


def _everything(state: Any, constants: Any, sample: Any) -> dict[str, Any]:
    """Repeats of all kinds: of what is held, is constant, is a condition, looks up, repeats in a repeat."""
    drive, light = 0.1 * sample + constants[0], state[2] > 0.0
    known = np.array([[0.0, 0.5], [0.25, 0.0]])[:, :, np.newaxis]

    def inner(x: Any, gain: Any) -> Any:
        return x * 0.5 + np.where(light, gain, drive)

    def outer(x: Any, gain: Any) -> Any:
        moved = product(known, x) + functions.sin(constants[1]) * gain
        return np.minimum(repeat(inner, moved, TABLE(GRID.find(x[0])), count=3), 4.0)

    once_a_block = repeat(lambda x: functions.cos(x * constants[1]), constants[:1], count=5)
    x = repeat(outer, state[:2], constants[0] * once_a_block[0], count=4)
    return {"state": np.concatenate([x, state[2:]]), "y": np.concatenate([x, once_a_block, light[np.newaxis]])}


def _chunk(n_cases: int) -> dict[str, Any]:
    rng = np.random.default_rng(3)
    return {"state": rng.normal(size=(3, n_cases)), "constants": rng.normal(size=(2, n_cases))}


def test_a_loop_is_its_body_so_many_times(where: Any, same: Any) -> None:
    from fddbench.blocks.kernel import Addresses, build

    chunk, nowhere = _chunk(37), Addresses(key=0, run=0, flight=0, scenario=0)
    program = trace(_everything, state=3, constants=2, sample=0)
    assert program.counts["repeat"] == 2
    state = chunk["state"]
    for k in range(6):
        state = _everything(state, chunk["constants"], np.float64(k))["state"]
    for how in (where, {"backend": "numpy"}):
        flown = build(program, recorded=("y",), **how).fly(
            **chunk, samples=np.full(37, 6), addresses=nowhere, first=0, end=6
        )
        assert same(flown.state, state)


@settings(max_examples=6, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(count=st.integers(0, 40), n=st.integers(1, 4), seed=st.integers(0, 2**32 - 1))
def test_any_count(where: Any, once: Any, same: Any, count: int, n: int, seed: int) -> None:
    matrix = column(np.random.default_rng(seed).normal(size=(n, n)) * 0.5)

    def step(state: Any) -> dict[str, Any]:
        x = repeat(lambda x, u: product(matrix, np.maximum(x, -1.0)) + u, state[:n], state[n:], count=count)
        return {"state": state, "y": x}

    state = np.random.default_rng(seed + 1).normal(size=(2 * n, 21))
    program = trace(step, state=2 * n)
    assert program.counts["repeat"] == (count > 1)
    assert same(once(program, state, **where), step(state)["y"])
    assert same(once(program, state, backend="numpy"), step(state)["y"])


def _decay(state: Any, count: int = 5) -> dict[str, Any]:
    return {"state": repeat(lambda x, rate: x - x * rate * 0.0625 + 0.0, state[:1], state[1:], count=count)}


def test_numbers_known_outside_are_written_into_the_body() -> None:
    def step(x: Any) -> dict[str, Any]:
        matrix = np.stack([x * 0.0, x * 0.0 + 2.0])  # traced, but known
        return {"y": repeat(lambda y, m: m[0] * y + m[1] * y[0], x, matrix, count=9)}

    (loop,) = (node.value for node in trace(step, x=2).nodes if node.op == "repeat")
    assert loop.body.inputs["fixed"] == 0
    assert dict(loop.body.counts) == {"input": 1, "literal": 1, "mul": 1}


def test_only_what_the_body_needs_is_handed_over() -> None:
    def step(x: Any) -> dict[str, Any]:
        return {"y": repeat(lambda y, m: y * m[1], x[:1], x, count=9)}

    (node,) = (node for node in trace(step, x=3).nodes if node.op == "repeat")
    assert len(node.arguments) == 2


def test_a_step_without_traced_arguments_may_use_traced_values() -> None:
    def step(x: Any) -> dict[str, Any]:
        return {"y": repeat(lambda y: y * 0.5 + x, np.zeros((1, 1)), count=50)}

    program = trace(step, x=1)
    assert program.counts["repeat"] == 1
    assert len(program.nodes) < 10


def test_identity() -> None:
    def step(x: Any, gain: float = 0.5, count: int = 7, swap: bool = False) -> dict[str, Any]:
        a, b = x[1] * 3.0, x[2] * 5.0
        return {"y": repeat(lambda y: (y * b + a if swap else a + b * y) * gain, x[:1], count=count)}

    hashes = [
        trace(lambda x, more=more: step(x, **more), x=3).hash
        for more in ({}, {"gain": 0.25}, {"count": 8}, {"swap": True})
    ]
    assert len(set(hashes)) == 3
    assert hashes[0] == hashes[3]


def test_a_step_that_gives_other_rows_is_refused_with_its_place() -> None:
    def step(x: Any) -> dict[str, Any]:
        return {"y": repeat(lambda y: y[:1], x, count=3)}

    with pytest.raises(TraceError, match=r"turns rows of shape \(2, 1\) into \(1, 1\)") as caught:
        trace(step, x=2)
    assert caught.value.where == f"{__file__}:{step.__code__.co_firstlineno + 1}"


def test_a_value_of_an_unrelated_trace_is_refused_inside_too() -> None:
    kept: list[Any] = []
    trace(lambda a: {"y": kept.append(a) or a}, a=1)
    with pytest.raises(TraceError, match="another trace"):
        trace(lambda x: {"y": repeat(lambda y: y + kept[0], x, count=3)}, x=1)


def test_a_value_from_inside_does_not_get_out() -> None:
    kept: list[Any] = []

    def step(x: Any) -> dict[str, Any]:
        y = repeat(lambda y: (kept.append(y), y * 0.5)[1], x, count=3)
        return {"y": y + kept[0]}

    with pytest.raises(TraceError, match="another trace"):
        trace(step, x=1)


def test_a_repeat_costs_its_body_so_many_times() -> None:
    one, many = (
        cost(trace(lambda state: _decay(state, 1), state=2)),
        cost(trace(lambda state: _decay(state, 200), state=2)),
    )
    assert dict(many.operations) == {op: 200 * n for op, n in one.operations.items()}
    assert (many.flops, many.multiply_adds) == (200 * one.flops, 200 * one.multiply_adds)
    assert many.table_bytes == one.table_bytes


class _Plant:
    def step(self, state: Any) -> dict[str, Any]:
        return {"state": rk4(lambda x: self.derivative(x), state, step_s=0.1, substeps=10)}

    def derivative(self, x: Any) -> Any:
        return x * -0.5


def test_the_operations_of_a_repeat_belong_to_its_block() -> None:
    found = cost(trace(_Plant().step, state=1))
    assert found.by_block == {"_Plant": dict(found.operations)}
    assert found.operations["add"] == 10 * 7


def test_a_thousand_substeps_are_as_large_as_two() -> None:
    def text_lines(substeps: int) -> int:
        program = trace(lambda state: {"state": rk4(lambda x: -x, state, step_s=0.1, substeps=substeps)}, state=3)
        return len(build(program, backend="llvm").text().splitlines())  # type: ignore[attr-defined]

    pytest.importorskip("llvmlite")
    from fddbench.blocks.kernel import build

    assert text_lines(1000) == text_lines(2)


def test_one_substep_is_no_loop() -> None:
    matrix = column([[-1.0, 0.5], [0.0, -2.0]])

    def by_hand(x: Any, h: float = 0.02) -> Any:
        k1 = product(matrix, x)
        k2 = product(matrix, x + (0.5 * h) * k1)
        k3 = product(matrix, x + (0.5 * h) * k2)
        k4 = product(matrix, x + h * k3)
        return x + (h / 6.0) * (k1 + 2.0 * k2 + 2.0 * k3 + k4)

    ours = trace(lambda x: {"y": rk4(lambda x: product(matrix, x), x, step_s=0.02)}, x=2)
    assert ours.nodes == trace(lambda x: {"y": by_hand(x)}, x=2).nodes


def test_order_four() -> None:
    errors = [
        float(np.abs(rk4(lambda x: x, np.ones((1, 1)), step_s=1.0, substeps=n) - np.exp(1.0))[0, 0]) for n in (10, 20)
    ]
    assert 14.0 < errors[0] / errors[1] < 18.0


def test_no_substep_is_a_mistake() -> None:
    with pytest.raises(ValueError, match="substeps >= 1"):
        rk4(lambda x: x, np.ones((1, 1)), step_s=1.0, substeps=0)
