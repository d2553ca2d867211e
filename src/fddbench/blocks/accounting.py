"""What a step would cost on a flight computer: operations by kind, multiply-adds, bytes of state and tables."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from fddbench.blocks.operations import OPERATIONS
from fddbench.blocks.program import Program
from fddbench.blocks.rewrite import expand

__all__ = ["Cost", "cost"]

_DOUBLE = 8


@dataclass(frozen=True, kw_only=True)
class Cost:
    """Load of one sample of a step.

    Attributes
    ----------
    operations : mapping of str to int
        Number of operations by name in `OPERATIONS`, most frequent first; a sine counts as one.
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
    counted = Counter(node.op for node in program.nodes if node.arguments)
    written_out = expand(program)
    return Cost(
        operations=dict(counted.most_common()),
        flops=sum(_flops(node.op, len(node.arguments)) for node in written_out.nodes),
        multiply_adds=_multiply_adds(program),
        state_bytes=_DOUBLE * max(program.inputs.get(state, 0), 0),
        table_bytes=_DOUBLE * program.counts["literal"],
        by_block=_by_block(program),
    )


def _by_block(program: Program) -> dict[str, dict[str, int]]:
    """Operations by block and name, blocks in the order in which they were traced."""
    found: dict[str, Counter[str]] = {}
    for node, origin in zip(program.nodes, program.origins, strict=False):
        if node.arguments and origin is not None:
            found.setdefault(origin.block, Counter())[node.op] += 1
    return {block: dict(counted.most_common()) for block, counted in found.items()}


def _flops(op: str, arguments: int) -> int:
    """Cost of a primitive; a pick compares and selects once per row but the first."""
    return 2 * (arguments - 2) if op == "pick" else OPERATIONS[op].flops


def _multiply_adds(program: Program) -> int:
    """Additions and subtractions that take a product nobody else uses."""
    uses = Counter(a for node in program.nodes for a in node.arguments)
    uses.update(node for rows in program.outputs.values() for node in rows)
    return sum(
        any(program.nodes[a].op == "mul" and uses[a] == 1 for a in node.arguments)
        for node in program.nodes
        if node.op in {"add", "sub"}
    )
