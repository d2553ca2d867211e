"""What was found behind the failures of a shipped campaign: each reason switched off, kept beside its scores."""

from collections.abc import Mapping
from typing import Any

import yaml

from fddbench import gallery
from fddbench.reporting.formats import count, interval, percent
from fddbench.reporting.tables import Cell

__all__ = ["REASONS", "reason_table"]

REASONS = ("reason", "flights", "as it is", "not right", "otherwise", "not right then")
"""Heads of what `reason_table` gives."""

_OUTCOMES = {"wrong_site": "wrong", "late": "late", "missed": "missed"}


def reason_table(campaign: str, sha256: str) -> list[list[Cell]]:
    """Lines of ``reports/<campaign>/reasons.yaml``; none where there is no such file, or where it is of another campaign."""
    path = gallery.folder("reports") / campaign / "reasons.yaml"
    if not path.is_file():
        return []
    content = yaml.safe_load(path.read_text(encoding="utf-8"))
    return [_line(line) for line in content["lines"]] if content["campaign_sha256"] == sha256 else []


def _line(line: Mapping[str, Any]) -> list[Cell]:
    sides = [cell for side in (line["as_it_is"], line["otherwise"]) for cell in (Cell(side["what"]), _share(side))]
    return [Cell(line["reason"]), Cell(line["flights"]), *sides]


def _share(side: Mapping[str, Any]) -> Cell:
    """Share of flights that were not right, what they were, and its interval."""
    counts = f"{count(side['not_right'])} of {count(side['of'])}"
    kinds = ", ".join(f"{count(side[name])} {word}" for name, word in _OUTCOMES.items() if side[name])
    ends = interval(side["low_percent"], side["high_percent"])
    text = f"{percent(100.0 * side['not_right'] / side['of'])} %"
    return Cell(text, "; ".join(filter(None, (f"{counts}: {ends} %", kinds))), alarm=side["not_right"] > 0)
