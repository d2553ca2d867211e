"""Runs C on values that stand for any number: what every member of a struct is made of in the end."""

import struct
from collections.abc import Callable
from typing import Any

from fddbench.testing.read_back.audited import PRIMITIVES
from fddbench.testing.read_back.parsed import ReadBackError, functions_of
from fddbench.testing.read_back.values import Value, Values

__all__ = ["Reader"]

_BINARY = {
    "+": ("add", 0), "-": ("sub", 0), "*": ("mul", 0), "/": ("div", 0), "<": ("lt", 0), "<=": ("le", 0), ">": ("lt", 1),
    ">=": ("le", 1), "==": ("eq", 0), "!=": ("ne", 0), "&&": ("and", 0), "||": ("or", 0),
}  # fmt: skip
"""Operation of each sign, and whether its sides change places."""
_MATH = {"fabs": "abs", "sqrt": "sqrt", "floor": "floor", "nearbyint": "rint"}
_COMPOSITES = {"sin", "cos", "exp", "log", "pow", "atan2", "asin"}
_WHOLE: dict[str, Callable[[int, int], Any]] = {
    "+": lambda a, b: a + b, "-": lambda a, b: a - b, "<": lambda a, b: a < b, ">": lambda a, b: a > b,
}  # fmt: skip
_MOST_TURNS = 100000


class Reader:
    """A file of C that is run symbolically: straight lines, loops of fixed length, calls of its own functions.

    Parameters
    ----------
    tree : tree of pycparser
        The file.
    values : Values
        Where what it computes is written down.
    """

    def __init__(self, tree: Any, values: Values) -> None:
        self.values, self.functions = values, functions_of(tree)
        self.structs = {
            n.name: self._members(n) for n in tree.ext if type(n).__name__ == "Typedef" and self._members(n)
        }
        self.constants: dict[str, Any] = {}
        for node in tree.ext:
            if type(node).__name__ == "Decl" and node.init is not None:
                self.constants[node.name] = self._initial(node.init, {})

    def blank(self, struct_name: str, leaf: Callable[[str, int], Value | None]) -> dict[str, Any]:
        """A struct whose numbers are given by member and row."""
        return {
            name: [leaf(name, row) for row in range(rows)] if rows else leaf(name, 0)
            for name, rows in self.structs[struct_name].items()
        }

    def call(self, name: str, *arguments: Any) -> Any:
        """Run a function of the file; what it returns."""
        function = self.functions[name]
        parameters = [p.name for p in function.decl.type.args.params if p.name] if function.decl.type.args else []
        if len(parameters) != len(arguments):
            raise ReadBackError(f"{name} takes {len(parameters)} arguments, got {len(arguments)}")
        own = dict(zip(parameters, arguments, strict=True))
        return self._block(function.body.block_items or [], own)

    def _members(self, node: Any) -> dict[str, int]:
        """Members of a struct and their rows, 0 for a single one; nothing for another type."""
        kind: Any = getattr(node.type, "type", None)
        if type(kind).__name__ != "Struct" or not kind.decls:
            return {}
        return {d.name: int(d.type.dim.value) if type(d.type).__name__ == "ArrayDecl" else 0 for d in kind.decls}

    def _block(self, items: list[Any], own: dict[str, Any]) -> Any:
        for item in items:
            kind = type(item).__name__
            if kind == "Return":
                return self._value(item.expr, own)
            if kind == "Decl":
                own[item.name] = self._declared(item, own)
            elif kind == "Assignment":
                self._assign(item.lvalue, self._value(item.rvalue, own), own, item.op)
            elif kind == "FuncCall":
                self._value(item, own)
            elif kind == "For":
                self._loop(item, own)
            else:
                raise ReadBackError(f"line {item.coord}: a statement of kind {kind}, which an export never has")
        return None

    def _declared(self, node: Any, own: dict[str, Any]) -> Any:
        if node.init is not None:
            return self._initial(node.init, own)
        if type(node.type).__name__ == "ArrayDecl":
            return [None] * int(node.type.dim.value.rstrip("U"))
        name = getattr(node.type.type, "names", [""])[0]
        return self.blank(name, lambda *_: None) if name in self.structs else None

    def _initial(self, node: Any, own: dict[str, Any]) -> Any:
        if type(node).__name__ == "InitList":
            return [self._initial(each, own) for each in node.exprs]
        return self._value(node, own)

    def _loop(self, node: Any, own: dict[str, Any]) -> None:
        self._assign(node.init.lvalue, self._value(node.init.rvalue, own), own, "=")
        for _ in range(_MOST_TURNS):
            condition = self._value(node.cond, own)
            if not isinstance(condition, bool):
                raise ReadBackError(f"line {node.coord}: a loop that depends on data")
            if not condition:
                return
            self._block(node.stmt.block_items, own)
            counter = node.next.expr.name
            own[counter] += 1 if node.next.op == "p++" else -1
        raise ReadBackError(f"line {node.coord}: a loop that does not end")

    def _assign(self, target: Any, value: Any, own: dict[str, Any], sign: str) -> None:
        if sign != "=":
            raise ReadBackError(f"an assignment {sign}, which an export never has")
        kind = type(target).__name__
        if kind == "ID":
            own[target.name] = value
        elif kind == "StructRef":
            holder = self._value(target.name, own)
            if target.field.name not in holder:
                raise ReadBackError(f"no member {target.field.name}")
            holder[target.field.name] = value
        elif kind == "ArrayRef":
            array, index = self._value(target.name, own), self._value(target.subscript, own)
            self._within(array, index)
            array[index] = value
        elif kind == "UnaryOp" and target.op == "*":
            scope, name = own[target.expr.name]
            scope[name] = value
        else:
            raise ReadBackError(f"an assignment to {kind}")

    def _within(self, array: Any, index: Any) -> None:
        if not isinstance(index, int) or isinstance(index, bool) or not isinstance(array, list):
            raise ReadBackError("an index that depends on data, or of what is no array")
        if not 0 <= index < len(array):
            raise ReadBackError(f"index {index} of an array of {len(array)}")

    def _value(self, node: Any, own: dict[str, Any]) -> Any:
        reader = _READERS.get(type(node).__name__)
        if reader is None:
            raise ReadBackError(f"an expression of kind {type(node).__name__}, which an export never has")
        return reader(self, node, own)

    def _of_constant(self, node: Any, _: dict[str, Any]) -> Any:
        if node.type in {"double", "float"}:
            return self.values.literal(float(node.value.rstrip("fF")))
        return int(node.value.rstrip("uUlL"), 0)

    def _of_id(self, node: Any, own: dict[str, Any]) -> Any:
        if node.name in {"true", "false"}:
            return self.values.new("flag", value=node.name == "true")
        found = own.get(node.name, self.constants.get(node.name))
        if found is None:
            raise ReadBackError(f"{node.name} is read before it is written")
        return found

    def _of_structref(self, node: Any, own: dict[str, Any]) -> Any:
        holder = self._value(node.name, own)
        found = holder.get(node.field.name)
        if found is None:
            raise ReadBackError(f"{node.field.name} is read before it is written")
        return found

    def _of_arrayref(self, node: Any, own: dict[str, Any]) -> Any:
        array, index = self._value(node.name, own), self._value(node.subscript, own)
        self._within(array, index)
        if array[index] is None:
            raise ReadBackError("a row is read before it is written")
        return array[index]

    def _of_cast(self, node: Any, own: dict[str, Any]) -> Any:
        return self._value(node.expr, own)

    def _of_compoundliteral(self, node: Any, own: dict[str, Any]) -> Any:
        return self._initial(node.init, own)

    def _of_unaryop(self, node: Any, own: dict[str, Any]) -> Any:
        if node.op == "&":
            held = own.get(node.expr.name)
            return held if isinstance(held, dict) else (own, node.expr.name)
        value = self._value(node.expr, own)
        op, _, number = self.values.entry(value)
        if node.op == "-":
            return self.values.literal(-number) if op == "literal" else self.values.new("neg", value)
        if node.op == "!":
            return self.values.new("not", value)
        raise ReadBackError(f"a sign {node.op}, which an export never has")

    def _of_binaryop(self, node: Any, own: dict[str, Any]) -> Any:
        left, right = self._value(node.left, own), self._value(node.right, own)
        if isinstance(left, int) and isinstance(right, int):
            return _WHOLE[node.op](left, right)
        if not (isinstance(left, Value) and isinstance(right, Value)) or node.op not in _BINARY:
            raise ReadBackError(f"line {node.coord}: {node.op} between what cannot be joined")
        op, swapped = _BINARY[node.op]
        return self.values.new(op, right, left) if swapped else self.values.new(op, left, right)

    def _of_ternaryop(self, node: Any, own: dict[str, Any]) -> Any:
        condition, yes, no = (self._value(each, own) for each in (node.cond, node.iftrue, node.iffalse))
        if (yes, no) == (self.values.literal(1.0), self.values.literal(0.0)):
            return self.values.new("number", condition)
        return self.values.new("select", condition, yes, no)

    def _of_funccall(self, node: Any, own: dict[str, Any]) -> Any:
        name, given = node.name.name, [self._value(each, own) for each in (node.args.exprs if node.args else [])]
        op = name.removeprefix("fdd_")
        if name in _MATH:
            return self.values.new(_MATH[name], *given)
        if name == "fdd_from_bits":
            return self.values.literal(struct.unpack(">d", struct.pack(">Q", given[0]))[0])
        if name in self.functions and name.startswith("fdd_") and op in PRIMITIVES | _COMPOSITES:
            return self._operation(op, given)
        if name not in self.functions:
            raise ReadBackError(f"a call of {name}, which this file does not have")
        return self.call(name, *given)

    def _operation(self, op: str, given: list[Any]) -> Value:
        if op == "pick":
            rows, n, index = given
            self._sized(rows, n)
            return self.values.new(op, index, *rows)
        if op in {"locate", "gather"}:
            table, n, place = given
            self._sized(table, n)
            numbers = [self.values.entry(each)[2] for each in table]
            return self.values.new(op, place, value=struct.pack(f"={len(numbers)}d", *numbers))
        return self.values.new(op, *given)

    def _sized(self, rows: list[Any], n: int) -> None:
        if len(rows) != n:
            raise ReadBackError(f"{n} entries of an array of {len(rows)}")


_READERS: dict[str, Callable[[Reader, Any, dict[str, Any]], Any]] = {
    "Constant": Reader._of_constant,
    "ID": Reader._of_id,
    "StructRef": Reader._of_structref,
    "ArrayRef": Reader._of_arrayref,
    "Cast": Reader._of_cast,
    "CompoundLiteral": Reader._of_compoundliteral,
    "UnaryOp": Reader._of_unaryop,
    "BinaryOp": Reader._of_binaryop,
    "TernaryOp": Reader._of_ternaryop,
    "FuncCall": Reader._of_funccall,
}
