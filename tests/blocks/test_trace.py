"""Golden: what tracing keeps, drops and refuses, and where the refusal points."""

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from fddbench.blocks import functions
from fddbench.blocks.interpreter import Interpreter
from fddbench.blocks.linear import affine, column, largest, product, total
from fddbench.blocks.program import trace
from fddbench.blocks.rewrite import canonical, expand
from fddbench.blocks.trouble import TraceError


def _if(x: Any) -> Any:
    if x[0] > 0.0:
        return {"y": x}
    return {"y": -x}


def _written_into_an_array(x: Any) -> Any:
    y = np.zeros((2, 1))
    y[0] = x[0]
    return {"y": y}


@pytest.mark.parametrize(
    ("step", "cure"),
    [
        (_if, "use np.where"),
        (lambda x: {"y": x if (x[0] > 0.0) and (x[1] > 0.0) else -x}, "use np.where"),
        (lambda x: {"y": x[np.argmax(x)]}, "compare the rows with np.where"),
        (lambda x: {"y": x[x > 0.0]}, "use np.where"),
        (lambda x: {"y": np.arange(5.0)[x[0]]}, "interpolate"),
        (lambda x: {"y": np.where(x > 0.0)}, "use np.where(condition, a, b)"),
        (lambda x: {"y": np.sin(x)}, "use sin of fddbench.blocks.functions"),
        (lambda x: {"y": np.arctan2(x, x)}, "use atan2 of fddbench.blocks.functions"),
        (lambda x: {"y": x**3}, "multiply"),
        (lambda x: {"y": x % 2.0}, "np.floor"),
        (lambda x: {"y": np.linalg.norm(x)}, "np.sqrt"),
        (lambda x: {"y": np.interp(x[0], [0, 1], [0, 1])}, "interpolate"),
        (lambda x: {"y": float(x[0]) + x}, "fddbench.blocks.functions"),
        (_written_into_an_array, "np.stack or np.concatenate"),
        (lambda x: {"y": x & x}, "compare first"),
        (lambda x: {"y": x + "a"}, "pass numbers"),
        (lambda x: {"y": np.fft.fft(x)}, "np.where"),
        (lambda x: {"y": x[0] @ x[1]}, "blocks.linear.product"),
        (lambda x: {"y": np.zeros((2, 7))}, "its last axis must be the case axis"),
        (lambda x: {"y": x.astype(int)}, "np.floor"),
    ],
)
def test_what_cannot_be_traced_is_refused_with_the_line_and_the_cure(step: Callable[..., Any], cure: str) -> None:
    with pytest.raises(TraceError, match=re.escape(cure)) as caught:
        trace(step, x=2)
    first = step.__code__.co_firstlineno
    file, line = caught.value.where.rsplit(":", 1)
    lines = range(first, first + 4)
    if "case axis" not in cure:  # said of the result, so of the line that traces
        assert (file, int(line) in lines) == (__file__, True)


def test_an_error_survives_a_worker_process() -> None:
    import pickle

    with pytest.raises(TraceError, match="np.where") as caught:
        trace(_if, x=2)
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


def test_equal_operations_are_one_and_unused_ones_are_dropped() -> None:
    def step(x: Any) -> Any:
        unused = functions.sin(x[0])
        assert unused.shape == (1,)
        return {"y": (x[0] * x[1] + x[1] * x[0])[np.newaxis]}

    counts = trace(step, x=2).counts
    assert (counts["mul"], counts["add"], counts["sin"]) == (1, 1, 0)


def test_zeros_of_a_matrix_are_free() -> None:
    matrix = column([[0.0, 2.0], [0.0, 0.0]])
    program = trace(lambda x: {"y": product(matrix, x)}, x=2)
    assert {op: n for op, n in program.counts.items() if op not in {"input", "literal"}} == {"mul": 1}


def test_constants_are_computed_once_and_for_all() -> None:
    program = trace(lambda x: {"y": x * (np.float64(3.0) / 7.0 + functions.sin(np.array([0.5])))}, x=1)
    assert [node.op for node in program.nodes if node.arguments] == ["mul"]


def test_division_by_a_power_of_two_is_a_product() -> None:
    assert trace(lambda x: {"y": x / 8.0}, x=1).counts["mul"] == 1
    assert trace(lambda x: {"y": x / 10.0}, x=1).counts["div"] == 1


def test_sine_and_cosine_share_their_reduction_when_written_out() -> None:
    both = trace(lambda x: {"y": np.concatenate([functions.sin(x), functions.cos(x)])}, x=1)
    assert (both.counts["sin"], both.counts["cos"]) == (1, 1)
    written_out = expand(both).counts
    assert (written_out["rint"], written_out["sin"]) == (1, 0)


def test_outputs_that_are_not_kept_cost_nothing() -> None:
    program = trace(lambda x: {"y": x + 1.0, "z": functions.exp(x)}, x=1)
    assert program.keep("y").counts["exp"] == 0


def test_identity() -> None:
    first, again = (trace(lambda x: {"y": x + 1.0}, x=1) for _ in range(2))
    other = trace(lambda x: {"y": x + 2.0}, x=1)
    assert first.hash == again.hash != other.hash


def _two_ways(x: Any, swap: bool) -> dict[str, Any]:
    """The same sums and products, written down in another order."""

    def first() -> Any:
        return x[0] * x[1] + functions.sin(x[2])

    def second() -> Any:
        return np.where(x[0] > x[2], x[1], 3.0) - x[1] * x[0]

    a, b = (second(), first())[::-1] if swap else (first(), second())
    rows = np.stack([a, b, b * a if swap else a * b])
    return {"z": a[np.newaxis], "y": rows} if swap else {"y": rows, "z": a[np.newaxis]}


def test_identity_does_not_depend_on_the_order_of_tracing() -> None:
    one, other = (trace(lambda x, swap=swap: _two_ways(x, swap), x=3) for swap in (False, True))
    assert one.nodes != other.nodes
    assert one.hash == other.hash
    assert canonical(one) == canonical(other)
    assert canonical(one).hash == one.hash


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (lambda x: x[0] - x[1], lambda x: x[1] - x[0]),
        (lambda x: x[0] * 0.5, lambda x: x[0] * -0.5),
        (lambda x: x[0] + 1.0, lambda x: x[1] + 1.0),
        (lambda x: np.maximum(x[0], 0.0), lambda x: np.maximum(x[0], -0.0)),
    ],
)
def test_another_computation_is_another_identity(one: Callable[..., Any], other: Callable[..., Any]) -> None:
    assert len({trace(lambda x, f=f: {"y": f(x)}, x=2).hash for f in (one, other)}) == 2


def test_outputs_in_other_places_are_another_identity() -> None:
    programs = [trace(lambda x, names=names: dict(zip(names, x, strict=True)), x=2) for names in ("ab", "ba")]
    assert programs[0].hash != programs[1].hash


def test_each_node_knows_its_line() -> None:
    def step(x: Any) -> dict[str, Any]:
        moved = functions.interpolate(x[0], np.array([[0.0], [1.0]]), np.array([[0.0], [1.0]]))
        return {"y": (moved + x[1])[np.newaxis]}

    program = trace(step, x=2)
    lines = {node.op: origin.line for node, origin in zip(program.nodes, program.origins, strict=True) if origin}
    first = step.__code__.co_firstlineno
    assert lines["select"] == f"{__file__}:{first + 1}"
    assert lines["add"] == f"{__file__}:{first + 2}"
    assert [o is not None for o in expand(program).origins] == [True] * len(expand(program).nodes)


def test_lines_are_no_part_of_the_identity() -> None:
    one = trace(lambda x: {"y": x * 2.0}, x=1)
    other = trace(lambda x: {"y": x * 2.0}, x=1)
    assert one.origins != other.origins
    assert one == other
    assert one.hash == other.hash


class _Keeps:
    """A step that keeps a traced value between two calls."""

    last: Any = None

    def step(self, x: Any) -> dict[str, Any]:
        before, self.last = self.last, x
        return {"y": x if before is None else x + before}


def test_a_value_of_another_trace_is_refused() -> None:
    keeps = _Keeps()
    trace(keeps.step, x=1)
    with pytest.raises(TraceError, match="keep nothing between two calls") as caught:
        trace(keeps.step, x=1)
    assert caught.value.where == f"{__file__}:{_Keeps.step.__code__.co_firstlineno + 2}"


@pytest.mark.parametrize(
    "mix",
    [
        lambda x, a: np.where(x > 0.0, x, a),
        lambda x, a: np.where(a > 0.0, x, x),
        lambda x, a: np.concatenate([x, a]),
        lambda x, a: functions.atan2(x, a),
        lambda x, a: np.maximum(a, x),
        lambda x, a: np.clip(x, a, 1.0),
        lambda x, a: x @ a.reshape(1, 1),
        lambda x, a: np.full_like(x, a),
        lambda _, a: a,
    ],
)
def test_values_of_two_traces_are_never_mixed(mix: Callable[..., Any]) -> None:
    kept: list[Any] = []
    trace(lambda a: {"y": kept.append(a) or a}, a=1)
    with pytest.raises(TraceError, match="another trace"):
        trace(lambda x: {"y": mix(x, kept[0])}, x=1)


def _numpy_manners(x: Any, u: Any) -> dict[str, Any]:
    """Everything that steps do with arrays, where the order of sums does not matter."""
    y = np.zeros_like(x)
    y[0] = x[1]
    y[1:3] += x[1:3] * 2.0
    flags = np.stack([x[0] > 0.0, x[1] >= x[2], x[2] != 0.5])
    rows = {
        "set": y,
        "where": np.where(flags, 1, 0),
        "count": np.sum(flags, axis=0)[np.newaxis],
        "any": np.any(flags, axis=0)[np.newaxis] | flags.all(axis=0)[np.newaxis],
        "or": (flags[0] + flags[1])[np.newaxis],
        "minus": 1.0 - flags,
        "index": x[[2, 0]],
        "new": x[0][np.newaxis],
        "step": x[::-1][:, np.newaxis].reshape(3, -1),
        "full": np.full_like(x[:1], 3.0) + np.ones_like(x[:1]),
        "spread": np.broadcast_to(u, (2, u.shape[-1])),
        "clip": np.clip(x, -0.5, 0.5),
        "sign": np.sign(x) + np.trunc(x) + np.ceil(x),
        "power": x**2 + (x * x) ** 0.5 + 2.0**-1 * x,
        "median": np.median(x, axis=0)[np.newaxis] + np.sort(x, axis=0)[:1],
        "extremes": np.stack([np.max(x, axis=0), x.min(axis=0), largest(x), np.maximum.reduce(x, axis=0)]),
        "finite": np.isfinite(x) & ~np.isnan(x),
        "diff": np.diff(x, axis=0),
        "sums": total(x)[np.newaxis] + np.array([1.0, 2.0])[:, np.newaxis],
        "affine": product(affine(np.arange(18.0).reshape(3, 2, 3, 1), x[:2]), x),
        "concatenated": np.concatenate([x, np.vstack([u, u]), np.ones((1, x.shape[-1]))]),
        "xor": flags ^ (x > 0.1),
        "degrees": np.deg2rad(x) + np.rad2deg(x),
    }
    assert len(x) == 3
    return rows


def test_traced_values_have_numpy_s_manners(same: Any) -> None:
    x, u = np.random.default_rng(2).normal(size=(3, 9)), np.linspace(-1.0, 1.0, 9)
    eager, traced = _numpy_manners(x, u), Interpreter(trace(_numpy_manners, x=3, u=0)).run(x=x, u=u)
    wrong = [name for name in eager if not same(np.asarray(eager[name], dtype=float) + 0.0, traced[name] + 0.0)]
    assert wrong == []


def test_matrix_products_are_summed_left_to_right(same: Any) -> None:
    matrix, x = np.random.default_rng(2).normal(size=(4, 3)), np.random.default_rng(3).normal(size=(3, 5))
    found = Interpreter(trace(lambda x: {"y": matrix @ x}, x=3)).run(x=x)["y"]
    assert same(found, product(column(matrix), x))


def test_what_is_fixed_may_be_used_by_the_run_before_it_is_used_by_the_fixed_part(same: Any) -> None:
    def step(c: Any, x: Any) -> dict[str, Any]:
        twice = c * 2.0
        early = x + twice
        return {"y": early * (twice * 3.0)}

    fixed, c, x = Interpreter(trace(step, c=1, x=1), fixed=("c",)), np.array([[0.5, 2.0]]), np.array([[3.0, 4.0]])
    fixed.fix(c=c)
    assert same(fixed.run(x=x)["y"], step(c, x)["y"])
    assert same(fixed.run(x=x)["y"], step(c, x)["y"])


def test_inputs_that_are_fixed_are_computed_once(same: Any) -> None:
    program = trace(lambda c, x: {"y": functions.exp(c) * x}, c=1, x=1)
    fixed, c, x = Interpreter(program, fixed=("c",)), np.array([[0.5, 2.0]]), np.array([[3.0, 4.0]])
    fixed.fix(c=c)
    assert same(fixed.run(x=x)["y"], Interpreter(program).run(c=c, x=x)["y"])
