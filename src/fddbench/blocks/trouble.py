"""What a step may not do, told with the line of the user's code and the cure."""

import sys
from dataclasses import dataclass
from typing import NoReturn

from fddbench.blocks.origin import outside
from fddbench.errors import FddbenchError

__all__ = ["TraceError", "trouble"]


@dataclass(eq=False)
class TraceError(FddbenchError):
    """A step does what cannot be flown on many flights together."""

    where: str
    problem: str
    cure: str

    def __str__(self) -> str:
        """Place, what is wrong, and what to do about it."""
        return f"{self.where}: {self.problem};\n{self.cure}."


def trouble(problem: str, cure: str) -> NoReturn:
    """Raise the error, with the innermost line that is neither ours nor NumPy's.

    Raises
    ------
    TraceError
        Always.
    """
    frame = outside(sys._getframe(1))
    raise TraceError(f"{frame.f_code.co_filename}:{frame.f_lineno}", problem, cure)
