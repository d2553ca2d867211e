"""Shares of rows with their intervals by run, as columns in percent, and what they pool."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow as pa

from fddbench.metrics.clustered import korn_graubard

__all__ = ["column", "decided", "flown_of", "percents", "pools", "share", "share_columns"]

_POOLED = {"scenario": "scenarios", "manoeuvre": "manoeuvres", "point": "points", "level": "levels"}


def column(name: str, kind: pa.DataType, about: str) -> pa.Field:
    """Column that explains itself."""
    return pa.field(name, kind, metadata={"about": about})


def share_columns(name: str, about: str) -> list[pa.Field]:
    """Columns of a share in percent and of its 95 % interval."""
    what = {"": f"share: {about} [%]", "_low": "lower end of its 95 % interval [%]", "_high": "upper end [%]"}
    return [column(f"{name}{end}_percent", pa.float64(), text) for end, text in what.items()]


def share(name: str, hits: npt.ArrayLike, runs: Any) -> dict[str, float | None]:
    """Share of rows in percent under ``<name>_percent``, and its interval under ``_low_percent`` and ``_high_percent``.

    With one row in every run the interval is the exact one; several rows of a run are clustered. None without a row, and no
    interval of a single run.

    >>> {name: round(value, 1) for name, value in share("right", [1, 1, 1, 0], [0, 1, 2, 3]).items()}
    {'right_percent': 75.0, 'right_low_percent': 19.4, 'right_high_percent': 99.4}
    """
    found = korn_graubard(hits, np.asarray(runs))
    return percents(name, found.share, found.low, found.high)


def percents(name: str, value: float | None, low: float | None, high: float | None) -> dict[str, float | None]:
    """A share and its interval as percents under their names."""
    ends = {"": value, "_low": low, "_high": high}
    return {f"{name}{end}_percent": None if each is None else 100.0 * each for end, each in ends.items()}


def flown_of(rows: pd.DataFrame) -> pd.DataFrame:
    """Rows with status ok; the rows themselves, not a copy, where all are."""
    ok = np.asarray(rows["status"] == "ok", dtype=bool)
    return rows if ok.all() else rows[ok]


def decided(flown: pd.DataFrame) -> npt.NDArray[np.bool_]:
    """Which flown flights have been decided, (n_rows,): only these have a part in shares of outcomes."""
    outcome = flown["outcome"]
    if isinstance(outcome.dtype, pd.ArrowDtype):  # a million rows at once
        return np.asarray((outcome != "undecided").fillna(value=False), dtype=bool)
    return np.array(
        [isinstance(name, str) and name != "undecided" for name in np.asarray(outcome, dtype=object)], dtype=bool
    )


def pools(rows: pd.DataFrame, *columns: str) -> str | None:
    """What rows pool beside runs in words, of the columns ``scenario``, ``manoeuvre``, ``point``, ``level``; None: nothing.

    >>> pools(pd.DataFrame({"scenario": ["a", "b"], "point": [0, 0]}), "scenario", "point")
    '2 scenarios'
    """
    several = {name: rows[name].nunique() for name in columns}
    return ", ".join(f"{n} {_POOLED[name]}" for name, n in several.items() if n > 1) or None
