"""LLVM text of single operations on vectors of W runs: exact, no fast-math flag, nothing fused."""

import struct
from typing import Any

__all__ = ["Vectors"]

_TWO52 = 4503599627370496.0
_TEMPLATES = {
    "add": "fadd {V} {0}, {1}",
    "sub": "fsub {V} {0}, {1}",
    "mul": "fmul {V} {0}, {1}",
    "div": "fdiv {V} {0}, {1}",
    "neg": "fneg {V} {0}",
    "abs": "call {V} @llvm.fabs.v{W}f64({V} {0})",
    "sqrt": "call {V} @llvm.sqrt.v{W}f64({V} {0})",
    "floor": "call {V} @llvm.floor.v{W}f64({V} {0})",
    "rint": "call {V} @llvm.nearbyint.v{W}f64({V} {0})",
    "lt": "fcmp olt {V} {0}, {1}",
    "le": "fcmp ole {V} {0}, {1}",
    "eq": "fcmp oeq {V} {0}, {1}",
    "ne": "fcmp une {V} {0}, {1}",
    "and": "and {M} {0}, {1}",
    "or": "or {M} {0}, {1}",
    "select": "select {M} {0}, {V} {1}, {V} {2}",
}
_HEXADECIMAL = "0x{:016X}"


class Vectors:
    """Writer of LLVM instructions on vectors of `lanes` doubles.

    Parameters
    ----------
    lanes : int
        Runs flown side by side.
    rounds : bool
        The processor rounds to whole numbers in one instruction (SSE4.1 and later).
    """

    def __init__(self, lanes: int, *, rounds: bool = True) -> None:
        self.lanes, self.rounds = lanes, rounds
        self.V, self.M, self.I = f"<{lanes} x double>", f"<{lanes} x i1>", f"<{lanes} x i64>"
        self.bytes = 8 * lanes
        self.lines: list[str] = []
        self._n = 0

    def let(self, text: str) -> str:
        """Name of a new value."""
        self._n += 1
        self.lines.append(f"  %v{self._n} = {text}")
        return f"%v{self._n}"

    def do(self, text: str) -> None:
        """Write an instruction or a label without a value."""
        self.lines.append(text if text.endswith(":") else "  " + text)

    def number(self, value: float) -> str:
        """The same number in every lane."""
        bits = struct.unpack("<Q", struct.pack("<d", value))[0]
        return f"splat (double {_HEXADECIMAL.format(bits)})"

    def integer(self, value: int) -> str:
        """The same 64-bit integer in every lane."""
        return f"splat (i64 {value})"

    def flag(self, value: bool) -> str:
        """True or false in every lane."""
        return f"splat (i1 {'true' if value else 'false'})"

    def spread(self, kind: str, scalar: str) -> str:
        """A scalar value in every lane."""
        vector = f"<{self.lanes} x {kind}>"
        first = self.let(f"insertelement {vector} poison, {kind} {scalar}, i64 0")
        return self.let(f"shufflevector {vector} {first}, {vector} poison, <{self.lanes} x i32> zeroinitializer")

    def as_integers(self, value: str) -> str:
        """Bits of doubles."""
        return self.let(f"bitcast {self.V} {value} to {self.I}")

    def as_doubles(self, value: str) -> str:
        """Doubles of bits."""
        return self.let(f"bitcast {self.I} {value} to {self.V}")

    def operation(self, op: str, *a: str) -> str:
        """Value of a primitive of the table."""
        special: Any = getattr(self, f"_{op}", None)
        if special is not None and not (self.rounds and op in {"floor", "rint"}):
            return special(*a)  # type: ignore[no-any-return]
        return self.let(_TEMPLATES[op].format(*a, V=self.V, M=self.M, W=self.lanes))

    def _extreme(self, comparison: str, a: str, b: str) -> str:
        chosen = self.let(
            f"select {self.M} {self.let(f'fcmp {comparison} {self.V} {a}, {b}')}, {self.V} {a}, {self.V} {b}"
        )
        if a.startswith("splat"):  # a number, which is not nan
            return chosen
        ordered = self.let(f"fcmp ord {self.V} {a}, {a}")
        return self.let(f"select {self.M} {ordered}, {self.V} {chosen}, {self.V} {a}")

    def _min(self, a: str, b: str) -> str:
        return self._extreme("olt", a, b)

    def _max(self, a: str, b: str) -> str:
        return self._extreme("ogt", a, b)

    def _not(self, a: str) -> str:
        return self.let(f"xor {self.M} {a}, {self.flag(value=True)}")

    def _number(self, a: str) -> str:
        return self.let(f"select {self.M} {a}, {self.V} {self.number(1.0)}, {self.V} zeroinitializer")

    def _rint(self, a: str) -> str:
        """By adding and subtracting 2^52, for processors without a rounding instruction."""
        size = self.operation("abs", a)
        whole = self.operation("sub", self.operation("add", size, self.number(_TWO52)), self.number(_TWO52))
        kept = self.operation("select", self.operation("lt", size, self.number(_TWO52)), whole, size)
        sign = self.let(f"and {self.I} {self.as_integers(a)}, {self.integer(-(2**63))}")
        return self.as_doubles(self.let(f"or {self.I} {self.as_integers(kept)}, {sign}"))

    def _floor(self, a: str) -> str:
        nearest = self._rint(a)
        above = self._number(self.operation("lt", a, nearest))
        return self.operation("sub", nearest, above)

    def _fraction(self, a: str) -> str:
        kept = self.let(f"and {self.I} {self.as_integers(a)}, {self.integer(-0x7FF0000000000001)}")
        return self.as_doubles(self.let(f"or {self.I} {kept}, {self.integer(0x3FE0000000000000)}"))

    def _exponent(self, a: str) -> str:
        high = self.let(f"lshr {self.I} {self.as_integers(a)}, {self.integer(52)}")
        biased = self.whole(self.let(f"and {self.I} {high}, {self.integer(0x7FF)}"))
        return self.operation("sub", biased, self.number(1022.0))

    def _power_of_two(self, a: str) -> str:
        biased = self.as_integers(self.operation("add", a, self.number(6755399441055744.0 + 1023.0)))
        return self.as_doubles(self.let(f"shl {self.I} {biased}, {self.integer(52)}"))

    def whole(self, integer: str) -> str:
        """Double of a non-negative integer below 2^52."""
        bits = self.let(f"or {self.I} {integer}, {self.integer(0x4330000000000000)}")
        return self.operation("sub", self.as_doubles(bits), self.number(_TWO52))

    def _pick(self, index: str, *rows: str) -> str:
        """By comparing the index with each row's number; `ring` rows are addressed directly instead (see `body`)."""
        chosen = rows[0]
        for j in range(1, len(rows)):
            here = self.operation("le", self.number(float(j)), index)
            chosen = self.operation("select", here, rows[j], chosen)
        return chosen

    def declarations(self) -> str:
        """Intrinsics used."""
        names = ("fabs", "sqrt", "floor", "nearbyint")
        return "\n".join(f"declare {self.V} @llvm.{name}.v{self.lanes}f64({self.V})" for name in names)
