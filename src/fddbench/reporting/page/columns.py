"""The rows of a campaign as plain arrays, cut into cells of one scenario and one detector."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from fddbench.interfaces import Floats
from fddbench.reporting.drawn import is_drawn
from fddbench.reporting.labels import of_a_fault

__all__ = ["FAILED", "NEEDS", "Columns"]

FAILED = ("false_alarm", "wrong_site", "late", "missed")
"""Outcomes of a decided flight in which something went wrong."""

NEEDS = (
    *(
        "case",
        "scenario",
        "manoeuvre",
        "point",
        "level",
        "run",
        "detector",
        "status",
        "reason",
        "flight_s",
        "departed_s",
    ),
    *("outcome", "n_faulty", "faulty_sites", "onset_s", "declared_sites", "false_alarm_time_s", "detection_time_s"),
    *("wrong_site_time_s", "detection_time_limit_s", "normalized_detection_time", "margin_healthy", "margin_faulty"),
    *("isolated", "over_declared", "changes", "estimate_bias", "estimate_rms", "watched"),
)
"""Columns of the rows that a page reads, beside parameters, sizes of faults and consequences."""

Index = npt.NDArray[np.int64]


class Columns:
    """Rows as arrays, each column made once and when it is asked for.

    Parameters
    ----------
    rows : DataFrame
        As ``fddbench.load`` gives them.

    Attributes
    ----------
    scenarios, detectors : tuple of str
        In order of appearance.
    ok, faulty : (n_rows,) arrays of bool
        Rows with a score, and those of flights with a fault.
    """

    def __init__(self, rows: pd.DataFrame) -> None:
        self._rows = rows
        self._known: dict[str, Any] = {}
        scenario, names = pd.factorize(rows["scenario"])
        detector, tools = pd.factorize(rows["detector"])
        self.scenarios = tuple(str(name) for name in names)
        self.detectors = tuple(str(name) for name in tools)
        self.scenario, self.detector = scenario, detector
        self.ok = np.asarray(rows["status"] == "ok", dtype=bool)
        self.faulty = self.numbers("n_faulty") > 0
        cell = scenario * max(len(tools), 1) + detector
        order = np.argsort(cell, kind="stable")
        ends = np.searchsorted(cell[order], np.arange(len(names) * len(tools) + 1))
        self._order, self._ends = order, ends

    def __len__(self) -> int:
        return len(self._rows)

    def numbers(self, name: str) -> Floats:
        """Column of numbers, NaN for null."""
        if name not in self._known:
            self._known[name] = self._rows[name].to_numpy(dtype=np.float64, na_value=np.nan)
        found: Floats = self._known[name]
        return found

    def texts(self, name: str) -> npt.NDArray[np.object_]:
        """Column of text, "" for null."""
        if name not in self._known:
            codes, names = pd.factorize(self._rows[name])
            known = np.array([*(str(each) for each in names), ""], dtype=object)
            self._known[name] = known[codes]
        found: npt.NDArray[np.object_] = self._known[name]
        return found

    def whole(self, name: str, places: Index) -> Index:
        """Some of a column of whole numbers without null."""
        return self.numbers(name)[places].astype(np.int64)

    @property
    def decided(self) -> npt.NDArray[np.bool_]:
        """Rows with a score that is not undecided."""
        if "decided" not in self._known:
            self._known["decided"] = np.asarray(self.ok & (self.texts("outcome") != "undecided"), dtype=bool)
        found: npt.NDArray[np.bool_] = self._known["decided"]
        return found

    @property
    def lost(self) -> npt.NDArray[np.bool_]:
        """Rows that should have been scored."""
        return np.asarray(~self.ok & (self.texts("status") != "infeasible"), dtype=bool)

    @property
    def failed(self) -> npt.NDArray[np.bool_]:
        """Rows in which something went wrong."""
        if "failed" not in self._known:
            self._known["failed"] = self.ok & np.asarray(pd.Series(self.texts("outcome")).isin(FAILED), dtype=bool)
        found: npt.NDArray[np.bool_] = self._known["failed"]
        return found

    def cell(self, scenario: int, detector: int) -> Index:
        """Places of the rows of a scenario and detector, in their order."""
        at = scenario * len(self.detectors) + detector
        found: Index = self._order[self._ends[at] : self._ends[at + 1]]
        return found

    def of(self, detector: int) -> Index:
        """Places of the rows of a detector."""
        return np.flatnonzero(self.detector == detector)

    def drawn(self, name: str, places: Index) -> bool:
        """Whether the values of a column of few values were drawn, not asked for."""
        return is_drawn(self.numbers(name)[places], self.numbers("run")[places])

    def varied(self, places: Index, prefixes: Sequence[str] = ("p_", "f")) -> list[str]:
        """Parameters and sizes of faults that differ among some rows, those of faults first."""
        names = [str(name) for name in self._rows.columns]
        sizes = [name for name in names if of_a_fault(name) and "f" in prefixes]
        own = [name for name in names if name.startswith("p_") and "p_" in prefixes]
        return [name for name in (*sizes, *own) if _differs(self.numbers(name)[places])]


def _differs(values: Floats) -> bool:
    known = values[~np.isnan(values)]
    return len(known) > 0 and float(known.max()) > float(known.min())
