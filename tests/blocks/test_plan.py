"""Laws of the lowered plan: what every target may rely on."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest

from fddbench.blocks import functions
from fddbench.blocks.draws import with_draws
from fddbench.blocks.lower import Spec, lower
from fddbench.blocks.plan import INSTRUCTIONS, MEMORY, NOTHING, Instruction, Plan
from fddbench.blocks.primitives import gather, locate, rarely
from fddbench.blocks.program import trace
from fddbench.blocks.repeat import repeat
from fddbench.blocks.ring import ring
from fddbench.blocks.table import Table
from fddbench.blocks.targets.llvm import memory


def _step(state: Any, constants: Any, normals: Any, sample: Any) -> dict[str, Any]:
    """Something of everything."""
    share = functions.exp(constants[0]) * np.where(constants[1] > 0.0, 1.0, constants[2])
    rows, oldest = ring(state[2:6], normals[0], sample)
    place = locate(Table.of([0.0, 1.0]), state[0])
    looked = gather(Table.of([1.0, 2.0, 3.0]), place) + gather(Table.of([4.0, 5.0, 6.0]), place)
    moved = repeat(lambda x: x * share + oldest, state[:2], count=3) + looked
    flags = (moved[0] > 1.0) & (constants[1] > 0.0)
    moved = moved + np.where(rarely(sample > 99.0), functions.sin(functions.sin(state[1])), 0.0)
    return {"state": np.concatenate([moved, rows]), "finished": flags[np.newaxis], "y": normals[:2]}


@pytest.fixture(scope="module")
def plan() -> Plan:
    program = with_draws(trace(_step, state=6, constants=3, normals=4, sample=0))
    return lower(Spec(program=program, streams=((1, "flight"),), recorded=("y",)))


def _defined(lines: Iterable[Instruction], known: set[int]) -> set[int]:
    """Registers after some instructions, each written once and before it is read."""
    for line in lines:
        assert set(line.arguments) <= known, line
        assert line.result == NOTHING or line.result not in known, line
        known.add(line.result)
    return known


def test_registers_are_written_once_and_before_they_are_read(plan: Plan) -> None:
    prologue, sample = _defined(plan.prologue, set()), _defined(plan.sample, set())
    assert prologue & sample <= {NOTHING}
    assert set(plan.finished) <= sample
    ops = [line.op for line in plan.sample]
    inside = {line.result for line in plan.sample[ops.index("skip") : ops.index("resume")]}
    for line in plan.sample[ops.index("resume") :]:
        assert line.op == "join" or not inside & set(line.arguments) - {NOTHING}, line
    for function in plan.repeats:
        _defined(function.each, _defined(function.before, set()))


def test_the_workspace_is_large_enough_and_never_read_before_it_is_written(plan: Plan) -> None:
    written = set(range(plan.n_state))
    for line in (*plan.prologue, *plan.sample):
        if line.op == "store":
            written.add(line.value)
        if line.op == "call":
            number, area = line.value
            assert area + plan.repeats[number].slots < plan.slots
            assert area >= plan.n_state
        if line.op == "load":
            assert line.value in written
    assert max(written) < plan.slots - 1


def test_what_depends_on_constants_alone_is_computed_once_a_block(plan: Plan) -> None:
    assert "constant" in {line.op for line in plan.prologue}
    assert "constant" not in {line.op for line in plan.sample}
    assert [line.op for line in plan.sample].count("draw") == 1
    assert {"ring_load", "ring_store", "call", "record"} <= {line.op for line in plan.sample}


def test_tables_of_one_length_share_the_index_of_a_place(plan: Plan) -> None:
    ops = [line.op for line in plan.sample]
    assert (ops.count("index"), ops.count("gather"), len(plan.tables)) == (1, 2, 2)


def test_every_instruction_is_in_the_list_and_in_the_table_of_the_target(plan: Plan) -> None:
    used = {line.op for section in (plan.prologue, plan.sample) for line in section}
    assert used <= INSTRUCTIONS
    assert set(MEMORY) <= INSTRUCTIONS
    assert memory.table(1, 1).keys() == INSTRUCTIONS
