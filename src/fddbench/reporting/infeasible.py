"""Flights that cannot be flown: where they lie and why."""

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from fddbench.interfaces import Floats
from fddbench.reporting.formats import count, short
from fddbench.reporting.labels import label
from fddbench.reporting.tables import Cell

__all__ = ["INFEASIBLE", "infeasible_lines", "kind_of"]

INFEASIBLE = ("because of", "manoeuvre", "flights", "of", "where")
"""Heads of what `infeasible_lines` gives."""

_MOST_LINES = 40


def kind_of(reason: str) -> str:
    """Kind of a reason: what stands before its last colon, else its words without their numbers.

    >>> kind_of("turn: buffet: lift coefficient 1.2 > 1.1"), kind_of("drawn mass_kg 3e5 lies outside 1 to 2")
    ('turn: buffet', 'drawn mass_kg … lies outside … to …')
    """
    before, colon, _ = reason.rpartition(":")
    return before if colon else re.sub(r"(?<![\w])[-+]?[\d.]+(e[-+]?\d+)?\b", "…", reason)


def _flights(rows: pd.DataFrame) -> pd.DataFrame:
    """Flights that differ in where or what is flown, once each, with the kind of what forbids them ("": nothing)."""
    flights = rows.drop_duplicates("case").drop_duplicates(["manoeuvre", "point", "run"])
    lost = np.asarray(flights["status"] == "infeasible", dtype=bool)
    reasons = flights["reason"].astype(object).where(lost, "").fillna("")
    # a manoeuvre's name in front says nothing that its column does not
    short = [
        kind_of(reason).removeprefix(f"{name}: ") if reason else ""
        for reason, name in zip(reasons, flights["manoeuvre"], strict=True)
    ]
    return flights.assign(kind=short, infeasible=lost)


def infeasible_lines(rows: pd.DataFrame, axes: Sequence[tuple[str, str]]) -> list[list[Cell]]:
    """One line per kind of reason and manoeuvre: how many flights, and between which parameters; most frequent first."""
    flights = _flights(rows)
    flown = flights.groupby("manoeuvre", sort=False).size().to_dict()
    names = [f"p_{name}" for pair in axes for name in pair if f"p_{name}" in flights]
    lost = flights[np.asarray(flights["infeasible"], dtype=bool)]
    groups = sorted(lost.groupby(["kind", "manoeuvre"], sort=False), key=lambda pair: -len(pair[1]))
    return [
        [
            Cell(str(kind)),
            Cell(str(manoeuvre)),
            Cell(count(len(group))),
            Cell(count(flown[manoeuvre])),
            Cell(", ".join(_range(name, _numbers(group, name)) for name in names)),
        ]
        for (kind, manoeuvre), group in groups[:_MOST_LINES]
    ]


def _range(name: str, values: Floats) -> str:
    low, high = float(values.min()), float(values.max())
    return f"{label(name)} {short(low)}" + (f" to {short(high)}" if high > low else "")


def _numbers(table: pd.DataFrame, column: str) -> Any:
    return table[column].to_numpy(dtype=np.float64, na_value=np.nan)
