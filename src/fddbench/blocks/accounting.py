"""What a step would cost on a flight computer: operations by kind, multiply-adds, bytes of state and tables."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from fddbench.blocks.operations import OPERATIONS
from fddbench.blocks.program import Program
from fddbench.blocks.repeat import Loop
from fddbench.blocks.rewrite import expand

__all__ = ["Cost", "cost"]

_DOUBLE = 8
_NO_OPERATION = {"rarely", "repeat", "row"}


@dataclass(frozen=True, kw_only=True)
class Cost:
    """Load of one sample of a step.

    Attributes
    ----------
    operations : mapping of str to int
        Number of operations by name in `OPERATIONS`, most frequent first; a sine counts as one, a repeat as its body so
        many times.
    flops : int
        Floating-point operations of a scalar processor, sines and their kin written out.
    multiply_adds : int
        Products that go into one sum and nowhere else: a digital signal processor does each pair in one cycle.
    state_bytes : int
        Memory carried from sample to sample, in double precision.
    table_bytes : int
        Distinct numbers written in the step (gains, matrices, tables), in double precision.
    by_block : mapping of str to mapping of str to int
        `operations` of each block by its path, as ``Fused.LateralLoop.Observer``; what several blocks share counts where
        it was traced first, and "" is what belongs to no block.
    """

    operations: Mapping[str, int]
    flops: int
    multiply_adds: int
    state_bytes: int
    table_bytes: int
    by_block: Mapping[str, Mapping[str, int]]


def cost(program: Program, state: str = "state") -> Cost:
    """Cost of a traced step whose state is the input called `state`.

    Examples
    --------
    >>> from fddbench.blocks.program import trace
    >>> filter_ = trace(lambda state, u: {"state": 0.9 * state + 0.1 * u}, state=1, u=1)
    >>> found = cost(filter_)
    >>> dict(found.operations), found.flops, found.multiply_adds, found.state_bytes, found.table_bytes
    ({'mul': 2, 'add': 1}, 3, 1, 8, 16)
    """
    by_block = _by_block(program)
    return Cost(
        operations=dict(_operations(program).most_common()),
        flops=_flops(expand(program)),
        multiply_adds=_multiply_adds(program),
        state_bytes=_DOUBLE * max(program.inputs.get(state, 0), 0),
        table_bytes=_DOUBLE * _numbers(program),
        by_block={block: dict(counted.most_common()) for block, counted in by_block.items()},
    )


def _repeats(program: Program) -> list[Loop]:
    return [node.value for node in program.nodes if node.op == "repeat"]


def _operations(program: Program) -> Counter[str]:
    """Operations by name; a repeat counts as its body so many times."""
    counted = Counter(node.op for node in program.nodes if node.arguments and node.op not in _NO_OPERATION)
    for loop in _repeats(program):
        for op, n in _operations(loop.body).items():
            counted[op] += n * loop.count
    return counted


def _by_block(program: Program) -> dict[str, Counter[str]]:
    """Operations by block and name, blocks in the order in which they were traced."""
    found: dict[str, Counter[str]] = {}
    for node, origin in zip(program.nodes, program.origins, strict=False):
        if node.op == "repeat":
            for block, counted in _by_block(node.value.body).items():
                inside = found.setdefault(block, Counter())
                for op, n in counted.items():
                    inside[op] += n * node.value.count
        elif node.arguments and node.op not in _NO_OPERATION and origin is not None:
            found.setdefault(origin.block, Counter())[node.op] += 1
    return found


def _flops(program: Program) -> int:
    """Cost of a program in primitives; a pick compares and selects once per row but the first, a search halves the knots."""
    total = sum(loop.count * _flops(loop.body) for loop in _repeats(program))
    for op, arguments, value in program.nodes:
        if op == "pick":
            total += 2 * (len(arguments) - 2)
        elif op == "locate":
            total += len(value).bit_length()
        else:
            total += OPERATIONS[op].flops
    return total


def _numbers(program: Program) -> int:
    """Distinct literals and numbers in tables, each table once."""
    inside = sum(_numbers(loop.body) for loop in set(_repeats(program)))
    tables = {node.value for node in program.nodes if node.op in {"locate", "gather"}}
    return program.counts["literal"] + sum(map(len, tables)) + inside


def _multiply_adds(program: Program) -> int:
    """Additions and subtractions that take a product nobody else uses."""
    uses = Counter(a for node in program.nodes for a in node.arguments)
    uses.update(node for rows in program.outputs.values() for node in rows)
    inside = sum(loop.count * _multiply_adds(loop.body) for loop in _repeats(program))
    return inside + sum(
        any(program.nodes[a].op == "mul" and uses[a] == 1 for a in node.arguments)
        for node in program.nodes
        if node.op in {"add", "sub"}
    )
