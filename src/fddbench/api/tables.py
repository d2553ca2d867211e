"""Tables of a folder of results."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from fddbench.metrics.summary import NEEDS, summarize
from fddbench.results import table

__all__ = ["load", "load_events", "summary"]


def load(folder: str | Path, columns: Sequence[str] | None = None) -> pd.DataFrame:
    """Rows of a folder of results, one per case and detector; Arrow-backed pandas, null means none.

    See `fddbench.results.table.load`.
    """
    return table.load(folder, columns)


def load_events(folder: str | Path) -> pd.DataFrame:
    """Events of a folder of results, one per case, detector and fault where faults are several or end."""
    return table.load_events(folder)


def summary(folder: str | Path) -> pd.DataFrame:
    """One line per scenario and detector: counts, rates with exact intervals, detection times.

    The columns are those of `fddbench.metrics.summary.SUMMARY`.
    """
    return summarize(table.load(folder, ["case", *NEEDS]))
