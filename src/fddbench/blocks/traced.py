"""The value type that a step sees while it is traced: it answers NumPy's protocols and remembers what was done."""

from collections.abc import Hashable, Iterable, Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.blocks import array_functions, ufuncs
from fddbench.blocks.graph import Graph
from fddbench.blocks.manners import Manners, static
from fddbench.blocks.operations import OPERATIONS
from fddbench.blocks.primitives import Symbolic
from fddbench.blocks.trouble import trouble

__all__ = ["Traced"]


class Traced(Manners, np.lib.mixins.NDArrayOperatorsMixin, Symbolic):
    """Array of nodes with the shape and the manners of the NumPy array it stands for, its case axis of length 1.

    Parameters
    ----------
    graph : Graph
        Where operations are written down.
    ids : array of int
        Node of each element; views of it share memory as views of an array do.
    boolean : bool
        Elements are true or false.
    """

    __hash__ = None  # type: ignore[assignment]
    __array_priority__ = 1000

    def __init__(self, graph: Graph, ids: npt.NDArray[np.int64], *, boolean: bool = False) -> None:
        self.graph, self.ids, self.boolean = graph, ids, boolean

    # --- what it is ---
    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the array it stands for."""
        return self.ids.shape

    @property
    def ndim(self) -> int:
        """Number of axes."""
        return self.ids.ndim

    @property
    def size(self) -> int:
        """Number of elements."""
        return self.ids.size

    @property
    def dtype(self) -> np.dtype[Any]:
        """Boolean or float64."""
        return np.dtype(bool if self.boolean else float)

    @property
    def T(self) -> "Traced":
        """Transposed."""
        return self.like(self.ids.T)

    def __len__(self) -> int:
        return len(self.ids)

    def __iter__(self) -> Iterator["Traced"]:
        return (self[j] for j in range(len(self.ids)))

    def __repr__(self) -> str:
        return f"Traced(shape={self.shape}, dtype={self.dtype})"

    def like(self, ids: Any, *, boolean: bool | None = None) -> "Traced":
        """Another value of the same trace."""
        return Traced(self.graph, np.asarray(ids), boolean=self.boolean if boolean is None else boolean)

    def lift(self, value: Any) -> "Traced":
        """A number, plain array or traced value as a traced value of this trace."""
        if isinstance(value, Traced):
            return value if value.graph is self.graph else self._adopted(value)
        array = np.asarray(value)
        if array.dtype.kind not in "bfiu":
            trouble(f"{type(value).__name__} {value!r} is no array of numbers", "pass numbers, arrays or traced values")
        boolean = array.dtype.kind == "b"
        leaf: Any = self.graph.flag if boolean else self.graph.literal
        ids = np.array([leaf(x) for x in array.ravel().tolist()], dtype=np.int64).reshape(array.shape)
        return self.like(ids, boolean=boolean)

    def _adopted(self, other: "Traced") -> "Traced":
        """A value of another trace, where that is allowed."""
        ids = [self.graph.adopt(other.graph, int(node)) for node in other.ids.ravel()]
        return self.like(np.array(ids, dtype=np.int64).reshape(other.shape), boolean=other.boolean)

    def number(self) -> "Traced":
        """Itself, true and false as 1 and 0."""
        if not self.boolean:
            return self
        ids = [self.graph.add("number", int(node)) for node in self.ids.ravel()]
        return self.like(np.array(ids, dtype=np.int64).reshape(self.shape), boolean=False)

    def condition(self) -> Any:
        """Itself, numbers compared with 0."""
        return self if self.boolean else ufuncs.apply(np.not_equal, self, (self, 0.0))

    # --- operations ---
    def apply(self, name: str, arguments: tuple[Any, ...], value: Hashable = None) -> Any:
        """Operation `name` of the table on every element, operands broadcast as by NumPy; `value` as `Node` has it."""
        root = _innermost(self, arguments)
        if root is not self:
            return root.apply(name, arguments, value)
        if self.graph.expand and OPERATIONS[name].composite:
            return array_functions.definition(name)(*arguments)
        operation, lifted = OPERATIONS[name], [self.lift(argument) for argument in arguments]
        kinds = operation.arguments if operation.arity >= 0 else "f" * len(lifted)
        if any(kind == "b" and not v.boolean for kind, v in zip(kinds, lifted, strict=True)):
            trouble(f"{name} needs true or false, got numbers", "compare first: (a > 0.5) & (b > 0.5)")
        operands = [v.number() if kind == "f" else v for kind, v in zip(kinds, lifted, strict=True)]
        columns = np.broadcast_arrays(*(operand.ids for operand in operands))
        rows = zip(*(column.ravel().tolist() for column in columns), strict=True)
        nodes = [self.graph.add(name, *row, value=value) for row in rows]
        return self.like(np.array(nodes, dtype=np.int64).reshape(columns[0].shape), boolean=operation.result == "b")

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        """Whatever NumPy's element-wise functions do."""
        out = options.pop("out", None)
        if method == "reduce" and ufunc in array_functions.REDUCTIONS:
            axis = options.get("axis", 0)
            return array_functions.reduce_axis(self, array_functions.REDUCTIONS[ufunc], axis, keepdims=False)
        if method != "__call__" or any(value is not None for value in options.values()):
            trouble(f"np.{ufunc.__name__} with {method} {options or ''} cannot be traced", "use the plain call")
        result = ufuncs.apply(ufunc, _innermost(self, inputs), inputs)
        if out is None:
            return result
        if not isinstance(out[0], Traced):
            trouble("a traced value cannot be written into a plain array", "build it with np.stack or np.concatenate")
        out[0][...] = result
        return out[0]

    def __array_function__(self, func: Any, types: Any, args: Any, kwargs: Any) -> Any:
        """Whatever NumPy's array functions do, for those in `array_functions`."""
        handler = array_functions.HANDLERS.get(func)
        if handler is None:
            trouble(f"np.{func.__name__} is not among the functions that can be traced",
                    array_functions.CURES.get(func, "write it with + - * / and np.where"))  # fmt: skip
        return handler(_innermost(self, [*args, *kwargs.values()]), *args, **kwargs)

    # --- indexing ---
    def __getitem__(self, key: Any) -> "Traced":
        return self.like(self.ids[static(key)])

    def __setitem__(self, key: Any, value: Any) -> None:
        lifted = self.lift(value)
        if self.boolean and not lifted.boolean:
            trouble("numbers written into true or false", "compare first, or start from a float array")
        self.ids[static(key)] = lifted.ids if self.boolean else lifted.number().ids

    # --- methods of arrays ---
    def reshape(self, *shape: Any) -> "Traced":
        """As NumPy's."""
        return self.like(self.ids.reshape(*shape))

    def ravel(self) -> "Traced":
        """As NumPy's."""
        return self.like(self.ids.ravel())

    def copy(self) -> "Traced":
        """As NumPy's."""
        return self.like(self.ids.copy())

    def transpose(self, *axes: int) -> "Traced":
        """As NumPy's."""
        return self.like(self.ids.transpose(*axes))

    def astype(self, kind: Any, **_: Any) -> Any:
        """To float from anything; to integers from true and false only."""
        wanted = np.dtype(kind).kind
        if wanted == "b":
            return self.condition()
        if wanted in "iu" and not self.boolean:
            trouble("a traced number cannot become an integer", "use np.floor or np.rint and stay with floats")
        if wanted not in "fiu":
            trouble(f"astype({kind})", "stay with float and bool")
        return self.number().copy()


def _innermost(root: Traced, values: Iterable[Any]) -> Traced:
    """Of the traced values the one of the innermost trace: inside a `repeat` those of outside are taken in, not the reverse."""
    for value in values:
        if isinstance(value, list | tuple):
            root = _innermost(root, value)
        elif isinstance(value, Traced) and value.graph.depth > root.graph.depth:
            root = value
    return root
