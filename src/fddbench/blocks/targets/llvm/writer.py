"""Writer of LLVM instructions on vectors of W runs."""

import struct

__all__ = ["Vectors"]

_TWO52 = 4503599627370496.0


class Vectors:
    """Writer of LLVM instructions on vectors of `lanes` doubles.

    Parameters
    ----------
    lanes : int
        Runs flown side by side.
    rounds : bool
        The processor rounds to whole numbers in one instruction (SSE4.1 and later).

    Attributes
    ----------
    block : str
        Label last written.
    """

    def __init__(self, lanes: int, *, rounds: bool = True) -> None:
        self.lanes, self.rounds = lanes, rounds
        self.V, self.M, self.I = f"<{lanes} x double>", f"<{lanes} x i1>", f"<{lanes} x i64>"
        self.bytes = 8 * lanes
        self.block = ""
        self.lines: list[str] = []
        self._n = 0

    def let(self, text: str) -> str:
        """Name of a new value."""
        self._n += 1
        self.lines.append(f"  %v{self._n} = {text}")
        return f"%v{self._n}"

    def do(self, text: str) -> None:
        """Write an instruction or a label without a value."""
        if text.endswith(":"):
            self.block = text[:-1]
        self.lines.append(text if text.endswith(":") else "  " + text)

    def scalar(self, value: float) -> str:
        """A number, with its type."""
        return f"double 0x{struct.unpack('<Q', struct.pack('<d', value))[0]:016X}"

    def number(self, value: float) -> str:
        """The same number in every lane."""
        return f"splat ({self.scalar(value)})"

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

    def whole(self, integer: str) -> str:
        """Double of a non-negative integer below 2^52."""
        bits = self.let(f"or {self.I} {integer}, {self.integer(0x4330000000000000)}")
        return self.let(f"fsub {self.V} {self.as_doubles(bits)}, {self.number(_TWO52)}")

    def slot(self, number: int | str) -> str:
        """Address of a vector of the workspace."""
        return self.let(f"getelementptr inbounds {self.V}, ptr %work, i64 {number}")

    def load(self, number: int | str) -> str:
        """A vector of the workspace."""
        return self.let(f"load {self.V}, ptr {self.slot(number)}, align {self.bytes}")

    def store(self, value: str, number: int | str) -> None:
        """Write a vector of the workspace."""
        self.do(f"store {self.V} {value}, ptr {self.slot(number)}, align {self.bytes}")

    def branch_if_any(self, mask: str, yes: str, no: str) -> None:
        """Branch on whether any lane of a mask is set."""
        bits = self.let(f"bitcast {self.M} {mask} to i{self.lanes}")
        self.do(f"br i1 {self.let(f'icmp ne i{self.lanes} {bits}, 0')}, label %{yes}, label %{no}")
