"""Laws of what is seldom needed: the same bits, left out when nobody needs it, and only then."""

from typing import Any

import numpy as np
import pytest

from fddbench.blocks import functions
from fddbench.blocks.draws import with_draws
from fddbench.blocks.kernel import Addresses, build
from fddbench.blocks.lower import Spec, lower
from fddbench.blocks.plan import Plan
from fddbench.blocks.primitives import rarely
from fddbench.blocks.program import Program, trace
from fddbench.blocks.repeat import repeat

N_STATE, STREAMS = 5, ((1, "flight"), (2, "scenario"), (3, "scenario"))


def _wave(x: Any) -> Any:
    return functions.sin(functions.exp(-x * x) + functions.cos(x))


def _faults(state: Any, constants: Any, normals: Any, sample: Any) -> dict[str, Any]:
    """Faults one after the other, each taking what the one before made; draws and results shared with what is always needed."""
    first = constants[0]
    active = (sample >= first) & (sample < first + 5.0)
    y = 0.9 * state[0] + normals[0]
    shared = _wave(y)
    y = np.where(rarely(active), _wave(sample * 0.1) * constants[1] + normals[4] + normals[10], y)
    y = np.where(rarely(sample == first + 7.0), y + _wave(state[1]) + normals[5] * shared, y)
    later = rarely(y > 2.5)  # known only after the choices above
    z = np.where(later, _wave(y) - 3.0, y)
    nested = np.where(rarely(active), np.where(rarely(state[2] > 1.0), _wave(state[2] + 1.0), _wave(state[2])), z)
    looped = np.where(rarely(active), repeat(lambda x: 0.5 * x + _wave(state[3]), y[np.newaxis], count=3)[0], nested)
    seen = _wave(state[4] * 2.0)
    kept = np.where(rarely(active), seen, 0.5)  # recorded too, so needed always
    after = np.stack([y, z, nested, looped, state[4] * 0.5 + kept + normals[8]])
    return {"state": after, "seen": seen[np.newaxis], "finished": (np.abs(looped) > 50.0)[np.newaxis]}


def _program(step: Any = _faults) -> Program:
    return trace(step, state=N_STATE, constants=2, normals=12, sample=0)


def _flown(first: Any, step: Any = _faults, **how: Any) -> Any:
    n_cases = len(first)
    state = np.random.default_rng(0).normal(size=(N_STATE, n_cases))
    constants = np.stack([first, np.linspace(0.5, 2.0, n_cases)])
    where = Addresses(key=9, run=np.arange(n_cases), flight=1, scenario=5)
    kernel = build(_program(step), streams=STREAMS, recorded=("seen",), **how)
    return kernel.fly(state, constants, np.full(n_cases, 40), where, first=0, end=40)


@pytest.mark.parametrize("first", [np.full(37, 1e9), np.arange(37.0), np.where(np.arange(37) % 16 == 3, 4.0, 1e9)])
def test_machine_code_flies_as_numpy_does(where: Any, same: Any, first: Any) -> None:
    expected, found = _flown(first, backend="numpy"), _flown(first, **where)
    assert same(found.state, expected.state)
    assert same(found.recorded["seen"], expected.recorded["seen"])
    assert np.array_equal(found.samples, expected.samples)


def test_on_plain_arrays_it_says_nothing() -> None:
    flags = np.array([True, False])
    assert rarely(flags) is flags


def _plan(step: Any) -> Plan:
    recorded = ("seen",) if step is _faults else ()
    return lower(Spec(program=with_draws(_program(step)), streams=STREAMS, recorded=recorded))


def test_what_nobody_needs_is_behind_the_branch_and_nothing_else() -> None:
    plan = _plan(_faults)
    ops = [line.op for line in plan.sample]
    start, end = ops.index("skip"), ops.index("resume")
    draws = [plan.sample[j].value for j, op in enumerate(ops) if op == "draw" and start < j < end]
    assert draws == [(2, "scenario")]
    assert ops.count("draw") == 3
    assert ops[start:end].count("rint") >= 4
    assert "call" not in ops[start:end]  # its start is made of an earlier choice


def _cheap(state: Any, constants: Any, normals: Any, sample: Any) -> dict[str, Any]:
    return {"state": np.where(rarely(sample > constants[0]), state + normals[0] * 0.0 + 1.0, state)}


def _both(state: Any, constants: Any, normals: Any, sample: Any) -> dict[str, Any]:
    wave = _wave(state)
    return {"state": np.where(rarely(sample > constants[0]), wave, -wave) + 0.0 * normals[0]}


def _unsaid(state: Any, constants: Any, normals: Any, sample: Any) -> dict[str, Any]:
    return {"state": np.where(sample > constants[0], _wave(state), state) + 0.0 * normals[0]}


@pytest.mark.parametrize("step", [_cheap, _both, _unsaid])
def test_no_branch_where_it_would_spare_nothing(step: Any) -> None:
    assert "skip" not in [line.op for line in _plan(step).sample]


def _rows(state: Any, constants: Any, normals: Any, sample: Any) -> dict[str, Any]:
    """Rows that seldom change: two that change places, one that others ask for, one that asks, one not worth a branch."""
    first = constants[0]
    turn = rarely((sample >= first) & (sample < first + 3.0))
    left = np.where(turn, _wave(state[1] + normals[0]), state[0])
    right = np.where(turn, _wave(state[0]) * constants[1], state[1])
    often = 0.5 * state[2] + left + 0.1 * state[3]  # asks for a new row, and for an old one that seldom changes
    later = np.where(rarely((sample == first + 1.0) | (often > 1.2)), _wave(often) + state[2] + left, state[3])
    plain = np.where(rarely(sample > first), state[4] + 1.0, state[4])
    return {"state": np.stack([left, right, often, later, plain]), "seen": (left - state[0])[np.newaxis]}


def _mixed(state: Any, constants: Any, normals: Any, sample: Any) -> dict[str, Any]:
    """Two rows become the same; one asks for what another makes of a new row; an old one that always changes is read late."""
    turn = rarely((sample >= constants[0]) & (sample < constants[0] + 3.0))
    both = np.where(turn, _wave(state[3] + normals[0]), state[0])
    left = np.where(turn, _wave(state[3] * 2.0), state[1])
    right = np.where(turn, _wave(0.5 * state[4] + left), state[2])
    half = 0.5 * state[4]
    late = _wave(half) + state[3]  # the old one, long after the new one is known
    return {"state": np.stack([both, left, right, half, 0.3 * both + late]), "seen": both[np.newaxis]}


def _always(state: Any, constants: Any, normals: Any, sample: Any) -> dict[str, Any]:
    """Rows that change in every sample, read behind a branch alone, and where another has its place."""
    turn = rarely((sample >= constants[0]) & (sample < constants[0] + 3.0))
    kept = np.where(turn, _wave(state[3]) + normals[0], state[0])
    alone = np.where(turn, _wave(state[1] + 2.0), state[4])
    again = np.where(turn, _wave(state[2] + 1.0), kept)
    return {"state": np.stack([kept, 0.1 * sample, kept, again, alone]), "seen": kept[np.newaxis]}


@pytest.mark.parametrize("step", [_rows, _mixed, _always])
def test_rows_that_seldom_change_fly_as_in_numpy(where: Any, same: Any, step: Any) -> None:
    first = np.concatenate([np.full(32, 1e9), np.arange(37.0), np.where(np.arange(37) % 16 == 3, 4.0, 1e9)])
    expected, found = _flown(first, step, backend="numpy"), _flown(first, step, **where)
    assert same(found.state, expected.state)
    assert same(found.recorded["seen"], expected.recorded["seen"])


def test_rows_that_seldom_change_are_neither_read_nor_written_in_other_samples() -> None:
    program = trace(lambda state, constants, sample: _lone(state, constants, sample), state=3, constants=1, sample=0)
    plan = lower(Spec(program=with_draws(program), streams=()))
    ops = [line.op for line in plan.sample]
    start, end = ops.index("skip"), ops.index("resume")
    behind = [(line.op, line.value) for line in plan.sample[start:end] if line.op in {"load", "store"}]
    assert {("load", 1), ("store", 0), ("store", 1)} <= set(behind)
    outside = [(line.op, line.value) for line in (*plan.sample[:start], *plan.sample[end:])]
    # the new row 0 is asked for behind the branch, and fetched there
    assert [line for line in outside if line[0] in {"load", "store"} and line[1] < 3] == [
        ("load", 2),
        ("load", 0),
        ("store", 2),
    ]
    assert "join" not in ops


def _lone(state: Any, constants: Any, sample: Any) -> dict[str, Any]:
    turn = rarely(sample == constants[0])
    shown, hidden = (np.where(turn, _wave(state[j] + state[2]), state[j]) for j in (0, 1))
    return {"state": np.stack([shown, hidden, 0.5 * state[2] + shown])}


def test_a_new_row_is_stored_when_the_old_one_has_been_read() -> None:
    """Not at the end of the sample, until when it would need a register."""
    program = trace(lambda state: {"state": np.stack([*(_wave(row) for row in state[:4]), state[0]])}, state=5)
    lines = lower(Spec(program=program, streams=())).sample
    assert [line.op for line in lines[-3:]] != ["store"] * 3
    stores = {line.value: place for place, line in enumerate(lines) if line.op == "store"}
    loads = {line.value: place for place, line in enumerate(lines) if line.op == "load"}
    assert all(stores[row] > loads[row] for row in range(4))
    assert min(stores.values()) < 0.6 * len(lines)


def test_it_is_faster_not_to_compute() -> None:
    """A count, not a time: the branch spares most of the operations of the sample."""

    def step(state: Any, constants: Any, normals: Any, sample: Any) -> dict[str, Any]:
        waves = sum(_wave(state + j + normals[4]) for j in range(5))
        return {"state": np.where(rarely(sample > constants[0]), waves, state * 0.5)}

    ops = [line.op for line in _plan(step).sample]
    inside = ops.index("resume") - ops.index("skip")
    assert inside > 0.9 * len(ops)
