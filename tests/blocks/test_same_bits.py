"""Law: NumPy, the interpreter and machine code of every width and processor give the same bits."""

from collections.abc import Callable
from typing import Any

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fddbench.blocks import functions
from fddbench.blocks.operations import OPERATIONS
from fddbench.blocks.primitives import exponent, fraction, gather, locate, pick, power_of_two, rarely
from fddbench.blocks.program import trace
from fddbench.blocks.repeat import repeat
from fddbench.blocks.table import Table

SPECIAL = (0.0, -0.0, 0.5, -0.5, 1.5, 2.5, -2.5, 1.0, -1.0, 3.0, 0.1, -1e-3, 1e-310, -5e-324, 2.2250738585072014e-308,
           4503599627370495.5, -4503599627370496.5, 1e300, -1e300, 1.7976931348623157e308, np.inf, -np.inf, np.nan)  # fmt: skip
PAIRS = np.array(np.meshgrid(SPECIAL, SPECIAL)).reshape(2, -1)
FEW, MANY = Table.of([-1.0, 0.0, 0.0, 0.1, 2.5, np.inf]), Table.of(np.linspace(-150.0, 150.0, 301) / 60.0)

PRIMITIVES: dict[str, Callable[[Any, Any], Any]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "neg": lambda a, _: -a,
    "abs": lambda a, _: np.abs(a),
    "sqrt": lambda a, _: np.sqrt(a),
    "min": np.minimum,
    "max": np.maximum,
    "floor": lambda a, _: np.floor(a),
    "rint": lambda a, _: np.rint(a),
    "lt": lambda a, b: a < b,
    "le": lambda a, b: a <= b,
    "eq": lambda a, b: a == b,
    "ne": lambda a, b: a != b,
    "and": lambda a, b: (a < 1.0) & (b < 1.0),
    "or": lambda a, b: (a < 1.0) | (b < 1.0),
    "not": lambda a, b: ~(a < b),
    "select": lambda a, b: np.where(a < b, a, -b),
    "number": lambda a, b: (a < b) * 1.0,
    "fraction": lambda a, _: fraction(a),
    "exponent": lambda a, _: exponent(a),
    "power_of_two": lambda a, _: power_of_two(np.minimum(np.maximum(np.rint(a), -1022.0), 1023.0)),
    "pick": lambda a, b: pick(a, b, a * b, b - 1.0, b + 2.0),
    "rarely": lambda a, b: np.where(rarely(a < b), functions.sin(functions.cos(a)), b),
    "locate": lambda a, b: locate(FEW, a) + locate(MANY, b),
    "gather": lambda a, b: gather(FEW, a) * gather(MANY, b),
}


def _all_primitives(state: Any) -> dict[str, Any]:
    rows = [f(state[0], state[1]) for f in PRIMITIVES.values()]
    return {"state": state, "y": np.stack([np.where(row == row, row, row) * 1.0 for row in rows])}


def test_the_table_is_covered() -> None:
    primitives = {name for name, operation in OPERATIONS.items() if operation.numpy is not None}
    assert PRIMITIVES.keys() == primitives - {"row"}  # of a repeat, which has tests of its own


def test_primitives_on_special_numbers(where: dict[str, Any], once: Any, same: Any) -> None:
    program = trace(_all_primitives, state=2)
    with np.errstate(all="ignore"):
        eager = _all_primitives(PAIRS)["y"]
    found = once(program, PAIRS, **where)
    wrong = [name for name, a, b in zip(PRIMITIVES, eager, found, strict=True) if not same(a, b)]
    assert wrong == []


def test_the_interpreter_on_special_numbers(once: Any, same: Any) -> None:
    with np.errstate(all="ignore"):
        eager = _all_primitives(PAIRS)["y"]
    found = once(trace(_all_primitives, state=2), PAIRS, backend="numpy")
    wrong = [name for name, a, b in zip(PRIMITIVES, eager, found, strict=True) if not same(a, b)]
    assert wrong == []


def _all_functions(state: Any) -> dict[str, Any]:
    x, angle, ratio, knots = state[0], state[1], state[2], np.array([[-1.0], [0.0], [0.0], [2.0]])
    table = np.array([[1.0], [3.0], [-1.0], [5.0]])
    rows = [
        functions.sin(angle), functions.cos(angle), functions.exp(angle), functions.log(x), functions.pow_(x, 1.7),
        functions.atan2(angle, ratio), functions.asin(ratio), functions.interpolate(angle, knots, table),
        functions.interpolate_2d(angle, ratio, knots, knots[1:], np.stack([table[1:] * k for k in range(4)])),
    ]  # fmt: skip
    return {"state": state, "y": np.stack(rows)}


def test_functions(where: dict[str, Any], once: Any, same: Any) -> None:
    rng = np.random.default_rng(5)
    state = np.stack([rng.lognormal(0.0, 9.0, 500), rng.normal(0.0, 60.0, 500), rng.uniform(-1.0, 1.0, 500)])
    state[:, :6] = [
        [0.0, -1.0, np.inf, np.nan, 1.0, 1e-300],
        [0.0, -0.0, 720.0, -760.0, np.nan, -709.0],
        [0, 1, -1, 0.5, 0, 0],
    ]
    with np.errstate(all="ignore"):
        eager = _all_functions(state)["y"]
    assert same(once(trace(_all_functions, state=3), state, **where), eager)
    assert same(once(trace(_all_functions, state=3), state, backend="numpy"), eager)


NUMBERS = st.sampled_from([0.5, 2.0, -3.25, 1.0, 0.1, -1.0, 7.0])
BINARY = st.sampled_from(
    ["add", "sub", "mul", "div", "min", "max", "select", "number", "locate", "gather", "repeat", "rarely"]
)
UNARY = st.sampled_from(["neg", "abs", "sqrt", "floor", "rint"])
NAMED = st.sampled_from(["sin", "cos", "exp", "log"])
INSTRUCTION = st.one_of(
    st.tuples(BINARY, st.integers(0, 99), st.integers(0, 99) | NUMBERS),
    st.tuples(UNARY, st.integers(0, 99), st.just(0)),
    st.tuples(NAMED, st.integers(0, 99), st.just(0)),
)
N_ROWS = 3


def _step(instructions: list[tuple[str, int, int | float]]) -> Callable[[Any], dict[str, Any]]:
    """A step that applies the instructions one after the other to rows it already has."""

    def step(state: Any) -> dict[str, Any]:
        rows = list(state)
        for op, first, second in instructions:
            a = rows[first % len(rows)]
            b = rows[second % len(rows)] if isinstance(second, int) else second
            if op == "repeat":
                rows.append(repeat(lambda x, b=b: 0.5 * x + np.maximum(b, rows[0]), a, count=3))
            else:
                rows.append(vars(functions)[op](a) if op in {"sin", "cos", "exp", "log"} else PRIMITIVES[op](a, b))
        return {"state": np.stack(rows[-N_ROWS:]), "y": np.stack(rows)}

    return step


@settings(max_examples=8, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    instructions=st.lists(INSTRUCTION, min_size=1, max_size=40),
    n_cases=st.sampled_from([1, 3, 64, 100]),
    seed=st.integers(0, 2**32 - 1),
)
def test_random_programs(where: Any, once: Any, same: Any, instructions: Any, n_cases: int, seed: int) -> None:
    step = _step(instructions)
    state = np.random.default_rng(seed).normal(0.0, 3.0, (N_ROWS, n_cases))
    program = trace(step, state=N_ROWS)
    with np.errstate(all="ignore"):
        eager = step(state)["y"]
    reference = once(program, state, backend="numpy")
    assert same(reference, eager)
    assert same(once(program, state, **where), reference)


def test_nothing_is_fused(where: dict[str, Any], once: Any) -> None:
    program = trace(lambda state: {"state": state, "y": (state[0] * state[0] - state[1])[np.newaxis]}, state=2)
    square = 1.0 + 2.0**-29
    found = once(program, np.array([[1.0 + 2.0**-30] * 5, [square] * 5]), **where)
    assert (found == 0.0).all()  # a fused product would leave 2^-60
