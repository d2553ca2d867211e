"""What a step of each detector takes of a flight computer: counted, and measured as exported C where the run did that."""

from collections.abc import Mapping, Sequence
from typing import Any

from fddbench.blocks.operations import OPERATIONS
from fddbench.reporting.formats import DASH, count
from fddbench.reporting.tables import Cell

__all__ = ["LOAD_HEADS", "MEASURED_HEADS", "load_heads", "load_lines", "measured_by"]

LOAD_HEADS = ("detector", "operations", "multiply-adds", "÷", "√", "sin, exp and their kin", "state [B]", "numbers [B]")
"""Counted from the step: exact, the same on every machine."""
MEASURED_HEADS = ("C: code [B]", "tables [B]", "state [B]", "stack [B]", "ticks")
"""Measured on the exported C where it was flown."""
_MEASURED = ("code_bytes", "table_bytes", "state_bytes", "stack_bytes", "ticks")


def load_heads(designs: Sequence[Mapping[str, Any]]) -> tuple[str, ...]:
    """Columns of `load_lines`; what was measured only where something was."""
    return (*LOAD_HEADS, *MEASURED_HEADS) if any(each.get("in_c") for each in designs) else LOAD_HEADS


def load_lines(designs: Sequence[Mapping[str, Any]]) -> list[list[Cell]]:
    """One line per detector, the fewest operations a sample first; empty where nothing is known of any.

    Parameters
    ----------
    designs : sequence of mapping
        Each with name, cost (`fddbench.blocks.accounting.Cost` or None), every (it steps at every so manieth sample), opaque
        (why it cannot be counted) and in_c (what `fddbench.exported.load_c.LoadInC` holds, or nothing).
    """
    known = [each for each in designs if each.get("cost") is not None or each.get("opaque") or each.get("in_c")]
    width = len(load_heads(designs))
    return [_line(each)[:width] for each in sorted(known, key=_operations_a_sample)]


def measured_by(designs: Sequence[Mapping[str, Any]]) -> str:
    """Compilers and flags that the exported C was measured with; "" where none was."""
    return "; ".join(dict.fromkeys(str(each["in_c"]["by"]) for each in designs if each.get("in_c")))


def _operations_a_sample(design: Mapping[str, Any]) -> float:
    cost = design.get("cost")
    return float("inf") if cost is None else cost.flops / design.get("every", 1)


def _line(design: Mapping[str, Any]) -> list[Cell]:
    cost, measured = design.get("cost"), design.get("in_c") or {}
    if cost is None:
        counted = [Cell(DASH, str(design.get("opaque") or "")), *[Cell(DASH)] * (len(LOAD_HEADS) - 2)]
    else:
        seldom = design.get("every", 1) > 1
        rare = f"at every {count(design['every'])} samples" if seldom else ""
        numbers = (
            cost.multiply_adds, cost.operations.get("div", 0), cost.operations.get("sqrt", 0),
            sum(n for op, n in cost.operations.items() if OPERATIONS[op].composite), cost.state_bytes, cost.table_bytes,
        )  # fmt: skip
        counted = [Cell(count(cost.flops), rare), *(Cell(count(number)) for number in numbers)]
    return [Cell(str(design["name"])), *counted, *(Cell(count(measured.get(name))) for name in _MEASURED)]
