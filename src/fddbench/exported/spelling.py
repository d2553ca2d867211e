"""How numbers and operations are spelt in C, in double or in single precision."""

import re
import struct
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fddbench.blocks.operations import OPERATIONS
from fddbench.errors import DesignError

__all__ = ["DOUBLE", "SINGLE", "Spelling", "Text"]

_SMALLEST = float(np.finfo(np.float32).tiny)
"""Smallest normal number of single precision."""
_ROUND = ("fabs", "sqrt", "floor", "nearbyint")
_CHAINS = {"add": ("add", "sub"), "sub": ("add", "sub"), "mul": ("mul",), "and": ("and",), "or": ("or",)}
"""Operations of which a chain reads from left to right without brackets, with those that may stand on the left."""
_SWAPPABLE = {"add", "mul", "and", "or"}


@dataclass(frozen=True)
class Text:
    """An expression: its text, the operation outermost ("" for a name, a number or a call), and how many names it has."""

    text: str
    op: str = ""
    leaves: int = 1

    @property
    def inside(self) -> str:
        """The same as part of another expression."""
        return f"({self.text})" if self.op else self.text


@dataclass(frozen=True)
class Spelling:
    """A precision.

    Attributes
    ----------
    real : str
        Type of a number.
    suffix : str
        Of numbers, and of the functions of math.h.
    """

    real: str
    suffix: str

    def number(self, value: float) -> str:
        """A number that reads back to the same bits; one too small for the precision is its smallest normal one, never 0.

        >>> DOUBLE.number(1.0), DOUBLE.number(1e-300), SINGLE.number(0.1), DOUBLE.number(float("inf"))
        ('1.0', '1e-300', '0.1f', 'fdd_from_bits(0x7FF0000000000000ULL)')
        >>> SINGLE.number(-1e-300)
        '-1.1754944e-38f'
        """
        single = bool(self.suffix)
        with np.errstate(over="ignore"):
            own = float(np.float32(value)) if single else float(value)
        if single and value and abs(own) < _SMALLEST:  # a floor under a divisor stays one
            own = float(np.copysign(_SMALLEST, value))
        if not np.isfinite(own):
            bits = struct.unpack(">I" if single else ">Q", struct.pack(">f" if single else ">d", own))[0]
            return f"fdd_from_bits(0x{bits:0{8 if single else 16}X}{'U' if single else 'ULL'})"
        text = str(np.float32(own)) if single else repr(own)
        if not re.search(r"[.e]", text):
            text += ".0"
        return text + self.suffix

    def apply(self, op: str, arguments: Sequence[Text]) -> Text:
        """Expression of an operation."""
        template, own = OPERATIONS[op].c, list(arguments)
        if template.startswith("(") and template.endswith(
            ")"
        ):  # written without brackets, added where another needs them
            template = template[1:-1]
            chain = _CHAINS.get(op, ())
            if op in _SWAPPABLE and own[1].op in chain and own[0].op not in chain:
                own.reverse()
            spelt = [own[0].text if own[0].op in chain else own[0].inside, *(each.inside for each in own[1:])]
            return Text(self._functions(template.format(*spelt)), op, sum(each.leaves for each in own))
        if op in {"rarely", "repeat", "row", "pick", "locate", "gather"}:
            raise DesignError(f"the operation {op} has no expression of its own")
        return Text(
            self._functions(template.format(*(each.text for each in own))), "", sum(each.leaves for each in own)
        )

    def _functions(self, text: str) -> str:
        if not self.suffix:
            return text
        text = re.sub(rf"\b({'|'.join(_ROUND)})\(", rf"\1{self.suffix}(", text)
        return re.sub(r"(?<![\w.])(\d+\.\d+)(?![\w.])", rf"\1{self.suffix}", text)


DOUBLE, SINGLE = Spelling("double", ""), Spelling("float", "f")
