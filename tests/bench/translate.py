"""A traced step in somebody else's expressions: the same operations, one for one."""

from collections.abc import Callable, Mapping
from types import FunctionType, SimpleNamespace
from typing import Any

from fddbench.blocks import functions
from fddbench.blocks.program import Program
from tests.bench import step


def translate(
    program: Program, inputs: Callable[[str, int], Any], table: Mapping[str, Callable[..., Any]]
) -> list[Any]:
    """Rows of the next state as values of the peer.

    Parameters
    ----------
    inputs : callable
        Value of a row of an input.
    table : mapping of str to callable
        Operation by name.
    """
    values: list[Any] = []
    for op, arguments, value in program.nodes:
        if op == "input":
            values.append(inputs(*value))
        elif not arguments:
            values.append(value)
        else:
            values.append(table[op](*(values[a] for a in arguments)))
    return [values[node] for node in program.outputs["state"]]


def transplanted(module: Any) -> Callable[..., Mapping[str, Any]]:
    """`step.quiet` with another module in the place of NumPy."""

    def pack(values: Any) -> Any:
        rows = ((getattr(values, name), count) for name, count in step.STATES.counts.items())
        return module.concatenate([value if count else value[None] for value, count in rows])

    interpolate = FunctionType(functions.interpolate.__code__, {**vars(functions), "np": module})
    world = {
        **vars(step), "np": module, "functions": SimpleNamespace(sin=module.sin, interpolate=interpolate),
        "STATES": SimpleNamespace(unpack=step.STATES.unpack, pack=pack),
    }  # fmt: skip
    for name in ("quiet", "step", "_rk4", "_observe"):
        world[name] = FunctionType(getattr(step, name).__code__, world)
    return world["quiet"]
