"""The table of faults that are in the logs: which sites, from when to when."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from io import StringIO
from math import ceil, isfinite
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from fddbench.errors import FddbenchError, did_you_mean, reason_of
from fddbench.interfaces import NEVER, Floats, LoggedFaults

__all__ = ["Label", "labelled", "read_labels"]

_COLUMNS = ("log", "sites", "onset_s", "end_s")


@dataclass(frozen=True)
class Label:
    """A fault of a log, in the time of the flight [s]; `end_s` is its first healthy sample, None: it stays."""

    log: int
    sites: tuple[str, ...]
    onset_s: float
    end_s: float | None


def read_labels(
    path: Path, logs: Mapping[str, tuple[float, float]], sites: Sequence[str]
) -> tuple[tuple[Label, ...], list[str]]:
    """Labels of a CSV file, and everything that is wrong with it.

    Parameters
    ----------
    logs : mapping of str to (float, float)
        Pieces that are flown, by the name of their log, in its own time [s].
    sites : sequence of str
        Known fault sites.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
        lines = [line for line in text.splitlines() if not line.startswith("#")]
        header = len(text.splitlines()) - len(lines)
        table = pd.read_csv(
            StringIO("\n".join(lines)), dtype=str, keep_default_na=False, skipinitialspace=True, index_col=False
        )
    except Exception as error:  # pandas raises many kinds
        return (), [f"{path}: cannot be read as a table of faults: {reason_of(error)}"]
    table = table.rename(columns=lambda name: str(name).strip())
    missing = [name for name in _COLUMNS[:3] if name not in table.columns]
    strange = [name for name in table.columns if name not in _COLUMNS]
    if missing or strange:
        got = ", ".join(table.columns) or "none"
        return (), [f"{path}:{header + 1}: a table of faults has the columns {', '.join(_COLUMNS)}, got {got}"]
    found, wrong = [], []
    for number, row in enumerate(table.to_dict("records")):
        try:
            found.append(_label(row, logs, sites))
        except FddbenchError as error:
            wrong.append(f"{path}:{header + 2 + number}: {error}")
    return tuple(found), wrong


def _label(row: Mapping[Any, Any], logs: Mapping[str, tuple[float, float]], sites: Sequence[str]) -> Label:
    log, names = row["log"].strip(), tuple(name.strip() for name in row["sites"].split("+"))
    if log not in logs:
        raise FddbenchError(
            " ".join(filter(None, (f"no log is called {log!r}.", did_you_mean(log, logs), f"Known: {', '.join(logs)}")))
        )
    for name in names:
        if name not in sites or names.count(name) > 1:
            known = f"Known: {', '.join(sites)}; several are joined by +"
            raise FddbenchError(
                " ".join(
                    filter(None, (f"no fault site is called {name!r}, or twice.", did_you_mean(name, sites), known))
                )
            )
    begin_s, last_s = logs[log]
    onset_s = _time("onset_s", row["onset_s"])
    end_s = _time("end_s", row["end_s"]) if str(row.get("end_s", "")).strip() else None
    if not begin_s <= onset_s <= last_s:
        raise FddbenchError(
            f"onset_s = {onset_s:.10g} lies outside of what is flown of log {log}, {begin_s:.10g} to {last_s:.10g} s of its "
            "own time; correct it, or fly another piece (start_s, end_s of the log)"
        )
    if end_s is not None and not onset_s < end_s:
        raise FddbenchError(
            f"end_s = {end_s:.10g} does not lie after onset_s = {onset_s:.10g}; leave it empty for a fault that stays"
        )
    return Label(list(logs).index(log), names, onset_s - begin_s, None if end_s is None else end_s - begin_s)


def _time(key: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not isfinite(value):
        raise FddbenchError(f"{key} is {text!r:.40}, it must be a time of the log [s]")
    return value


def labelled(labels: Sequence[Label], log: np.ndarray, sites: Sequence[str], sample_s: float) -> LoggedFaults:
    """Labels of flights of these logs, (n_cases,) numbers from 0; a time between two samples counts from the later one."""
    own = {number: [each for each in labels if each.log == number] for number in {each.log for each in labels}}
    n_lines, n_cases = max(map(len, own.values()), default=0), len(log)
    first: Floats = np.full((n_lines, len(sites), n_cases), NEVER)
    last: Floats = np.full((n_lines, n_cases), NEVER)
    for number, each in own.items():
        mine = log == number
        for line, label in enumerate(each):
            for site in label.sites:
                first[line, list(sites).index(site), mine] = _sample(label.onset_s, sample_s)
            if label.end_s is not None:
                last[line, mine] = max(_sample(label.end_s, sample_s) - 1.0, _sample(label.onset_s, sample_s))
    return LoggedFaults(first=first, last=last)


def _sample(time_s: float, sample_s: float) -> float:
    """First sample at or after a time."""
    return float(ceil(time_s / sample_s - 1e-6))
