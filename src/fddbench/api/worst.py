"""The flights to look at, worst first."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from fddbench.errors import FddbenchError
from fddbench.results.counted import read_tallies
from fddbench.results.kept import kept_of
from fddbench.results.table import load

__all__ = ["worst"]

_NEEDS = (
    *("scenario", "point", "level", "run", "detector", "status", "reason", "outcome", "n_faulty", "false_alarm_time_s"),
    *("detection_time_s", "wrong_site_time_s", "declared_sites", "faulty_sites", "margin_healthy", "departed_s"),
)


def worst(folder: str | Path, detectors: Sequence[str] = (), *, most: int = 3) -> pd.DataFrame:
    """Flights to look at: columns ``case``, ``detector``, ``outcome`` and ``what`` (what went wrong, in words), worst first.

    Parameters
    ----------
    folder : str or Path
        Folder of results.
    detectors : sequence of str
        These alone; all by default.
    most : int
        At most so many flights of one kind in a scenario, for a detector.

    Raises
    ------
    FddbenchError
        No folder of results, or no such detector in it.
    """
    if most < 1:
        raise FddbenchError(f"most = {most}: at least one flight of a kind")
    rows = load(folder, ["case", *_NEEDS])
    known = [str(name) for name in rows["detector"].unique()]
    unknown = [name for name in detectors if name not in known]
    if unknown:
        raise FddbenchError(f"no detector in {folder} is called {unknown[0]!r}; known: {', '.join(known)}")
    if detectors:
        rows = rows[np.asarray(rows["detector"].isin(list(detectors)), dtype=bool)]
    lines = [
        (rank, line)
        for _, group in rows.groupby(["scenario", "detector"], sort=False)
        for rank, line in _of_one(group, most)
    ]
    lines += list(_counted(Path(folder), rows, detectors))
    # by what went wrong, then in the order of the rows
    ordered = [line for _, line in sorted(lines, key=lambda each: each[0])]
    return pd.DataFrame(ordered, columns=["case", "detector", "outcome", "what"])


def _counted(folder: Path, rows: pd.DataFrame, detectors: Sequence[str]) -> Iterator[tuple[int, dict[str, Any]]]:
    """Of a folder that does not keep all rows, one flight of each kind of failure that none is kept of."""
    if kept_of(folder) is None:
        return
    there = set(zip(rows["scenario"], rows["detector"], rows["outcome"], strict=True))
    tallies = read_tallies(folder)
    wrong = tallies[
        tallies["outcome"].isin(list(_RANKS)) & (tallies["detector"].isin(list(detectors)) | (not detectors))
    ]
    for key, group in wrong.groupby(["scenario", "detector", "outcome"], sort=False):
        if key not in there:
            first, (scenario, detector, outcome) = group.iloc[0], [str(part) for part in key]
            case = f"{scenario}/{first['point']}/{first['level']}/{first['example_run']}"
            what = f"{outcome.replace('_', ' ')}: one of {int(group['rows'].sum())}, whose rows are not kept"
            yield _RANKS[outcome], {"case": case, "detector": detector, "outcome": outcome, "what": what}


def _of_one(group: pd.DataFrame, most: int) -> Iterator[tuple[int, dict[str, Any]]]:
    """Flights to look at of one scenario and detector, with the rank of what went wrong."""
    for rank, (wanted, by, smallest, words) in enumerate(_KINDS):
        chosen = group[wanted(group).to_numpy(dtype=bool, na_value=False)]  # null: no score, no outcome
        if by:
            value = chosen[by].to_numpy(dtype=float, na_value=np.nan)
            order = np.argsort(np.nan_to_num(value if smallest else -value, nan=np.inf), kind="stable")
            chosen = chosen.iloc[order]
        for line in chosen.head(most if rank < len(_KINDS) - 2 else 1).to_dict("records"):
            yield (
                rank,
                {"case": line["case"], "detector": line["detector"], "outcome": line["outcome"], "what": words(line)},
            )


def _seconds(value: Any) -> str:
    return f"{float(value):.2f} s"


_KINDS: Sequence[tuple[Callable[[pd.DataFrame], Any], str, bool, Callable[[dict[Any, Any]], str]]] = (
    (lambda g: ~g["status"].isin(["ok", "infeasible"]), "", True, lambda r: f"{r['status']}: {r['reason']}"),
    (
        lambda g: g["outcome"] == "wrong_site", "wrong_site_time_s", True,
        lambda r: f"declares {r['declared_sites']}, faulty is {r['faulty_sites']}; wrong {_seconds(r['wrong_site_time_s'])} "
        "after the onset",
    ),
    (lambda g: g["outcome"] == "missed", "", True, lambda r: f"misses {r['faulty_sites']}"),
    (
        lambda g: g["outcome"] == "late", "detection_time_s", False,
        lambda r: f"late: finds {r['faulty_sites']} after {_seconds(r['detection_time_s'])}",
    ),
    (
        lambda g: g["outcome"] == "false_alarm", "false_alarm_time_s", True,
        lambda r: f"false alarm at {_seconds(r['false_alarm_time_s'])}",
    ),
    (
        lambda g: g["departed_s"].notna() & ~g["outcome"].isin(["missed", "wrong_site"]), "departed_s", True,
        lambda r: f"departs at {_seconds(r['departed_s'])}",
    ),
    (
        lambda g: (g["outcome"] == "right") & g["detection_time_s"].notna(), "detection_time_s", False,
        lambda r: f"slowest of those found in time: {_seconds(r['detection_time_s'])}",
    ),
    (
        lambda g: (g["outcome"] == "quiet") & g["margin_healthy"].notna(), "margin_healthy", False,
        lambda r: f"largest margin of the healthy flights: {float(r['margin_healthy']):.2f} of the threshold",
    ),
)  # fmt: skip
"""What went wrong, worst first: which rows, ordered by what, the smallest first, and in words. Of the last two one flight."""

_RANKS = {"wrong_site": 1, "missed": 2, "late": 3, "false_alarm": 4}
"""Outcomes that are failures, by the places of their kinds."""
