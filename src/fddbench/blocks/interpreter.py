"""The reference: a program run by NumPy on (n_rows, n_cases) arrays, operation by operation, no compiler needed."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.blocks.operations import OPERATIONS
from fddbench.blocks.program import Program
from fddbench.blocks.repeat import Loop
from fddbench.blocks.rewrite import depends_only_on, expand

__all__ = ["Interpreter"]

Floats = npt.NDArray[np.float64]


class Interpreter:
    """Runs a program; what depends on the fixed inputs alone is computed once.

    Parameters
    ----------
    program : Program
        Written out in primitives first, so that the bits are those of every other back end.
    fixed : tuple of str
        Inputs that `fix` sets once for many runs.

    Examples
    --------
    >>> from fddbench.blocks.program import trace
    >>> double = Interpreter(trace(lambda x: {"y": x * 2.0}, x=1))
    >>> double.run(x=np.array([[1.0, 2.0]]))["y"]
    array([[2., 4.]])
    """

    def __init__(self, program: Program, fixed: tuple[str, ...] = ()) -> None:
        self.program = expand(program)
        once = depends_only_on(self.program, set(fixed))
        order = range(len(self.program.nodes))
        self._once = [j for j in order if once[j]]
        self._each = [j for j in order if not once[j]]
        self._freed = self._last_uses(once)
        self._known: dict[int, Any] = {}
        loops = {node.value for node in self.program.nodes if node.op == "repeat"}
        self._bodies = {loop: Interpreter(loop.body, fixed=("fixed",)) for loop in loops}

    def _last_uses(self, once: list[bool]) -> dict[int, list[int]]:
        """Nodes to forget after each node, so that temporaries do not pile up; what is fixed stays for the next run."""
        kept = {node for rows in self.program.outputs.values() for node in rows}
        last = {a: j for j, node in enumerate(self.program.nodes) for a in node.arguments}
        freed: dict[int, list[int]] = {}
        for argument, j in last.items():
            if argument not in kept and not once[argument]:
                freed.setdefault(j, []).append(argument)
        return freed

    def fix(self, **inputs: Floats) -> None:
        """Set the fixed inputs."""
        self._known = {}
        self._compute(self._once, self._known, inputs)

    def run(self, **inputs: Any) -> Mapping[str, Floats]:
        """Outputs by name, (n_rows, n_cases), of the inputs that are not fixed."""
        values = dict(self._known)
        self._compute(self._each if self._known or not self._once else self._once + self._each, values, inputs)
        n_cases = max((np.shape(value)[-1] for value in values.values() if np.ndim(value)), default=1)
        return {
            name: np.array([np.broadcast_to(values[node], n_cases) for node in rows], dtype=float).reshape(-1, n_cases)
            for name, rows in self.program.outputs.items()
        }

    def _repeated(self, loop: Loop, rows: list[Any]) -> Floats:
        """Rows after the loop, (n_rows, n_cases)."""
        stacked = np.array(np.broadcast_arrays(*map(np.atleast_1d, rows)), dtype=float)
        x, body = stacked[: loop.rows], self._bodies[loop]
        body.fix(fixed=stacked[loop.rows :])
        for _ in range(loop.count):
            x = body.run(x=x)["x"]
        return np.broadcast_to(x, (loop.rows, stacked.shape[1]))

    def _compute(self, order: list[int], values: dict[int, Any], inputs: Mapping[str, Any]) -> None:
        nodes, freed = self.program.nodes, self._freed
        with np.errstate(all="ignore"):
            for j in order:
                op, arguments, value = nodes[j]
                if op == "input":
                    name, row = value
                    values[j] = inputs[name][row] if self.program.inputs[name] else inputs[name]
                elif not arguments:
                    values[j] = value
                elif op == "repeat":
                    values[j] = self._repeated(value, [values[a] for a in arguments])
                else:
                    extra = () if value is None else (value,)
                    values[j] = OPERATIONS[op].numpy(*extra, *[values[a] for a in arguments])  # type: ignore[misc]
                for argument in freed.get(j, ()):
                    del values[argument]
