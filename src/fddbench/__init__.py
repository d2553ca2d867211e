"""Open Monte-Carlo benchmark campaigns for aerospace fault detection and diagnosis.

>>> import fddbench
>>> rows = fddbench.load("results/smoke")  # doctest: +SKIP
"""

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["__version__", "load", "load_events"]
__version__ = "0.1.0"


def load(folder: "str | Path") -> "pd.DataFrame":
    """Rows of a folder of results, one per case and detector; Arrow-backed pandas, null means none.

    Raises
    ------
    fddbench.errors.ResultsError
        No folder of results, or a damaged one.
    """
    from fddbench.results import table  # pandas is heavy: it is imported by those who ask for a table

    return table.load(folder)


def load_events(folder: "str | Path") -> "pd.DataFrame":
    """Events of a folder of results, one per case, detector and fault where faults are several or end."""
    from fddbench.results import table

    return table.load_events(folder)
