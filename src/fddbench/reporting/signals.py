"""What of re-flown cases is shown: which panels, which stretch of time, which flights."""

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt
import pandas as pd

from fddbench.interfaces import Floats, Recording
from fddbench.reporting.page.columns import FAILED

__all__ = ["rank_of_cases", "redundant", "signal_panels", "window"]

_MOST_PANELS = 3


def rank_of_cases(recording: Recording, rows: pd.DataFrame) -> npt.NDArray[np.int64]:
    """Positions in the recording, worst flight first, over all detectors.

    Worst is who fails with most detectors (an alarm before the onset, a healthy site, late, missed), then the slowest
    detection; of healthy flights the largest margin.
    """
    here = rows[np.asarray(rows["scenario"] == recording.scenario, dtype=bool)]
    here = here[np.asarray(here["case"].isin(list(recording.cases)) & (here["status"] == "ok"), dtype=bool)]
    failed = np.asarray(here["outcome"].isin(list(FAILED)), dtype=bool)
    slow = here["normalized_detection_time"].to_numpy(dtype=np.float64, na_value=np.nan)
    margin = here["margin_healthy"].to_numpy(dtype=np.float64, na_value=np.nan)
    case = here["case"].to_numpy(dtype=object)
    table = pd.DataFrame({"case": case, "failed": failed, "slow": slow, "margin": margin}).groupby("case", sort=False)
    found = table.agg(failed=("failed", "sum"), slow=("slow", "max"), margin=("margin", "max")).reindex(
        list(recording.cases)
    )
    second = found["margin"] if recording.onset_s is None else found["slow"]
    order = np.lexsort((-second.fillna(-1.0).to_numpy(), -found["failed"].fillna(-1.0).to_numpy()))
    return order.astype(np.int64)


def window(recording: Recording) -> tuple[int, int]:
    """First and last sample shown: from 1 s before the onset to shortly after the last declaration; healthy: all."""
    time_s, n_time = recording.time_s, len(recording.time_s)
    if recording.onset_s is None:
        return 0, n_time
    onset = float(np.nanmin(recording.onset_s))
    changes = [_changes(of["n_declared"]) for of in recording.detectors.values()]
    last = max(
        (float(time_s[change[-1] + 1]) for change in changes if len(change)),
        default=float(np.nanmax(recording.onset_s)) + 3.0,
    )
    last = max(last, onset) + max(0.4, 0.2 * (last - onset))
    return int(np.searchsorted(time_s, onset - 1.0)), int(np.searchsorted(time_s, last, side="right"))


def _changes(n_declared: Floats) -> npt.NDArray[np.int64]:
    """Return the samples before which some flight changed its verdict; a flight's end (NaN) is no change."""
    steps = np.diff(n_declared, axis=0)
    return np.flatnonzero(np.any(np.abs(np.nan_to_num(steps)) > 0, axis=1))


def signal_panels(signals: Mapping[str, Floats]) -> list[list[str]]:
    """Return the signals of each panel: a threshold lies with the signal recorded before it, the verdict comes last."""
    panels: list[list[str]] = []
    for name in signals:
        if "threshold" in name and panels:
            panels[-1].append(name)
        elif "threshold" not in name and name not in ("n_declared", "alarm", "residual"):
            panels.append([name])
    if not any(len(panel) > 1 for panel in panels):
        panels.insert(0, ["residual"])
    return [*panels[:_MOST_PANELS], ["n_declared"]]


def redundant(signals: Mapping[str, Floats]) -> list[str]:
    """Names of the first group of two to four numbered signals: the redundant sensors."""
    groups: dict[str, list[str]] = {}
    for name in signals:
        stem, _, number = name.rpartition("_")
        if stem and number.isdigit():
            groups.setdefault(stem, []).append(name)
    return next((names for names in groups.values() if 2 <= len(names) <= 4), [])
