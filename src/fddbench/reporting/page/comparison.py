"""The page of several folders of results: each by itself, and what differs on the flights that two hold."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from fddbench.reporting.comparison import comparison_cells
from fddbench.reporting.page.alarms_said import Said
from fddbench.reporting.page.writing import rendered
from fddbench.reporting.tables import Cell

__all__ = ["ComparedFolder", "Comparison", "comparison_html", "write_comparison"]

HEADS = ("scenario", "detector", "measure", "first", "other", "other − first [95 %]", "p, Holm", "")


@dataclass(frozen=True, kw_only=True)
class ComparedFolder:
    """A folder of results in short."""

    folder: str
    campaign: str
    about: str
    partial: str
    answer: Said
    ranks: list[tuple[int, str, str, list[Cell]]]


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """What the page shows.

    Attributes
    ----------
    folders : sequence of ComparedFolder
        In the order in which they were named.
    tables : sequence of (folder, table)
        Lines of `fddbench.compare`, the first folder beside this one.
    reasons : sequence of str
        Why others cannot be compared flight by flight.
    """

    folders: Sequence[ComparedFolder]
    tables: Sequence[tuple[str, pd.DataFrame]] = field(default=())
    reasons: Sequence[str] = field(default=())


def write_comparison(comparison: Comparison, output: Path) -> None:
    """Write the page to the file `output`; its folder is made."""
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(comparison_html(comparison), encoding="utf-8")


def comparison_html(comparison: Comparison) -> str:
    """Text of the page."""
    filled: dict[str, Any] = {
        "folders": comparison.folders,
        "tables": [(name, *comparison_cells(table)) for name, table in comparison.tables],
        "heads": HEADS,
        "reasons": comparison.reasons,
        "payload": {},
    }
    return rendered("comparison.html.j2", filled)
