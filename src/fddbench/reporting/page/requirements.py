"""Requirements and their verdicts as lines of the first screen."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

from fddbench.reporting.formats import DASH, count, percent, present, rate
from fddbench.reporting.tables import Cell

__all__ = ["RequirementLine", "requirement_lines", "requirement_sentence"]

_MARKS = {"pass": "✓ pass", "fail": "✗ fail", "undecided": "? undecided"}
_MOST = 60


@dataclass(frozen=True)
class RequirementLine:
    """A requirement on a detector: its name with what is asked, its verdict, cells, what it takes to decide."""

    name: Cell
    verdict: str
    mark: str
    cells: list[Cell]


def requirement_lines(judgements: Sequence[Mapping[str, Any]]) -> list[RequirementLine]:
    """Failures first, then what is undecided, then what passes.

    Parameters
    ----------
    judgements : sequence of mapping
        With name, detector, verdict, of, group, value, low, high, limit, at_least, within, runs_used, runs_planned,
        flights_needed and in_sample, as `fddbench.metrics.requirements` has them; only name and verdict must be there.
    """
    order = {"fail": 0, "undecided": 1, "pass": 2}
    ranked = sorted(judgements, key=lambda each: order.get(str(each["verdict"]), 3))
    return [_line(each) for each in ranked[:_MOST]]


def requirement_sentence(judgements: Sequence[Mapping[str, Any]]) -> str:
    """How many pass, fail and are undecided; "" without one."""
    if not judgements:
        return ""
    verdicts = [str(each["verdict"]) for each in judgements]
    told = [
        f"{verdicts.count(name)} {word}"
        for name, word in (("pass", "pass"), ("fail", "fail"), ("undecided", "are undecided"))
    ]
    return f"Of {len(verdicts)} judgements {', '.join(told)}."


def _line(each: Mapping[str, Any]) -> RequirementLine:
    verdict = str(each["verdict"])
    asked = ", ".join(filter(None, (_asked(each), str(each.get("group") or ""), str(each.get("about") or ""))))
    needed = each.get("flights_needed")
    takes = (
        "decided"
        if verdict != "undecided"
        else f"{count(needed)} more flights"
        if present(needed)
        else "never at this rate"
    )
    used = each.get("runs_used")
    runs = f"{count(used)} of {count(each.get('runs_planned'))} runs" if present(used) else DASH
    sample = "in sample" if each.get("in_sample") else ""
    return RequirementLine(
        name=Cell(str(each["name"]), asked), verdict=verdict, mark=_MARKS.get(verdict, verdict),
        cells=[Cell(str(each.get("detector") or DASH), sample), _measured(each), Cell(runs), Cell(takes)],
    )  # fmt: skip


def _number(each: Mapping[str, Any], value: Any) -> str:
    if not present(value) or value == inf:
        return DASH
    return f"{rate(value)} per h" if "per_hour" in str(each.get("of")) else f"{percent(100.0 * value)} %"


def _asked(each: Mapping[str, Any]) -> str:
    """``right share at least 98 %``."""
    if each.get("of") is None or not present(each.get("limit")):
        return ""
    within = f" of at most {each['within']:g}" if present(each.get("within")) else ""
    bound = "at least" if each.get("at_least") else "at most"
    return f"{str(each['of']).replace('_', ' ')}{within} {bound} {_number(each, each['limit'])}"


def _measured(each: Mapping[str, Any]) -> Cell:
    """Value and its interval, which holds at any look."""
    if not present(each.get("value")):
        return Cell(str(each.get("measured") or DASH))
    low, high = each.get("low"), each.get("high")
    ends = f"{_number(each, low)} … {_number(each, high)}" if present(low) and present(high) else ""
    return Cell(_number(each, each["value"]), ends)
