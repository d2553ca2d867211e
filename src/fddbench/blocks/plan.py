"""What a kernel does, instruction by instruction: loads, stores, operations, draws and calls, before any target's text.

`lower` makes a plan of a program; a target (LLVM; C is next) is a table from the names of instructions to text, and one frame
of loops around the sections of the plan. All that is to be decided is decided here: which rows live where, what is computed
once a block, in which order, which state rows are rings, how a table is searched. A target decides only how it is spelt.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

from fddbench.blocks.operations import OPERATIONS
from fddbench.blocks.table import Table

__all__ = ["INSTRUCTIONS", "NOTHING", "Instruction", "Plan", "Repeated"]

NOTHING = -1
"""Result of an instruction that gives none."""

MEMORY = {
    "literal": "number `value`, a float, in every lane",
    "flag": "true or false in every lane",
    "load": "vector number `value` of the workspace",
    "store": "register a into vector number `value` of the workspace",
    "constant": "row `value` of the constants of these cases",
    "time": "number of the sample, a float",
    "draw": "four random words of `value`: consumer number, and whose stream, flight or scenario",
    "uniform": "number of the open interval (0, 1) made of word `value` of the draw a",
    "ring_load": "workspace vector first + a, the nearest one outside; `value` is (first, depth), a the same in every lane",
    "ring_store": "register b into workspace vector first + a, nowhere if a is outside or not whole; `value` as above",
    "index": "whole number of a, which lies in the table that it is meant for, as an integer",
    "gather": "entry a, an index, of the table number `value`",
    "call": "repeat number `value[0]` on the workspace from vector `value[1]` on",
    "skip": "if a is false in every lane, go on behind the next `resume`; `value` numbers them from 0",
    "resume": "end of what may be skipped, number `value`; nothing from inside is read behind it but by `join`",
    "join": "a, a register from inside, where it was computed, 0 where it was skipped; follows `resume`, number `value`",
    "record": "register a stored as recorded row `value`, not-a-number where the flight is over",
}
"""Instructions beside the primitives of `OPERATIONS`: what each does with ``a, b`` (registers) and its ``value``."""

_LOWERED = {"input", "locate", "rarely", "repeat", "row", "pick"}
INSTRUCTIONS = (
    frozenset(MEMORY)
    | {name for name, operation in OPERATIONS.items() if not operation.composite and name not in _LOWERED}
    | {"pick"}
)
"""Names that a target's table must have."""


class Instruction(NamedTuple):
    """One line of a plan.

    Attributes
    ----------
    op : str
        One of `INSTRUCTIONS`.
    result : int
        Register written, once and for all in its function; `NOTHING` if there is none.
    arguments : tuple of int
        Registers read.
    value : any
        See `MEMORY`.
    """

    op: str
    result: int
    arguments: tuple[int, ...] = ()
    value: Any = None


@dataclass(frozen=True, kw_only=True)
class Repeated:
    """A function that runs a body many times over vectors of the workspace: rows that change first, then fixed ones.

    Attributes
    ----------
    before, each : tuple of Instruction
        Computed once a call; computed `count` times. ``load`` and ``store`` count from the vector that the call names.
    count : int
        How often.
    slots : int
        Vectors of workspace that a call needs, those of calls inside included.
    """

    before: tuple[Instruction, ...]
    each: tuple[Instruction, ...]
    count: int
    slots: int


@dataclass(frozen=True, kw_only=True)
class Plan:
    """A kernel.

    The frame of a target: for each block of cases, copy their state into workspace vectors 0 ... `n_state` - 1, run
    `prologue`, then run `sample` for each sample until all cases have ended or the call is over, and copy the state back.

    Attributes
    ----------
    n_state, n_recorded : int
        Rows of the state, and rows stored at every sample.
    prologue, sample : tuple of Instruction
        Once a block; once a sample. They share the workspace and no register.
    finished : tuple of int
        Registers of `sample`: a case ends where one is not 0.
    slots : int
        Vectors of workspace; the last one is written to in vain.
    tables : tuple of Table
        Constant memory, by number.
    repeats : tuple of Repeated
        Functions, by number; each calls earlier ones only.
    """

    n_state: int
    n_recorded: int
    prologue: tuple[Instruction, ...]
    sample: tuple[Instruction, ...]
    finished: tuple[int, ...]
    slots: int
    tables: tuple[Table, ...]
    repeats: tuple[Repeated, ...]
