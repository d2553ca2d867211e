"""The bound as text for a terminal, and as cells of the page."""

import pandas as pd

from fddbench.metrics.bound import MOST_D
from fddbench.reporting.formats import DASH, count, percent, present
from fddbench.reporting.tables import Cell

__all__ = ["HEADS", "bound_lines", "bounds_text"]

HEADS = ("scenario", "the ideal test knows", "limit [s]", "d", "least d", "P_D [%]", "alarm [%]", "flights")
"""Heads of what `bound_lines` gives."""


def bound_lines(bounds: pd.DataFrame) -> list[list[Cell]]:
    """One line of cells per scenario and model; the scenario's cell spans its models."""
    spans = bounds.groupby("scenario", sort=False).size().to_dict()
    lines, previous = [], None
    for line in bounds.to_dict("records"):
        cells = [Cell(line["model"] if present(line["model"]) else DASH, line["about"]), *map(Cell, _numbers(line))]
        if line["scenario"] != previous:
            cells.insert(0, Cell(line["scenario"], rows=int(spans[line["scenario"]])))
        previous = line["scenario"]
        lines.append(cells)
    return lines


def _numbers(line: dict) -> tuple[str, ...]:  # type: ignore[type-arg]
    """Limit, d, least d, P_D, probability of an alarm, flights; dashes where no bound is stated."""
    if not present(line["model"]):
        return (DASH,) * 6
    window = f"{line['window_s']:g}"
    shares = (percent(100.0 * line[name]) for name in ("p_d", "p_detect"))
    return window, _distance(line["d"]), _distance(line["d_least"]), *shares, count(line["flights"])


def _distance(d: float) -> str:
    return f"≥ {MOST_D:g}" if d >= MOST_D else f"{d:.3g}"


def bounds_text(bounds: pd.DataFrame) -> str:
    """Table of a terminal, with the models in words below it."""
    if bounds.empty:
        return "no faulty scenario: nothing to find"
    models: dict[str, str] = {}
    rows = [("scenario", "model", *HEADS[2:])]
    for line in bounds.to_dict("records"):
        name = line["model"] if present(line["model"]) else DASH
        models.setdefault(name, line["about"])
        rows.append((line["scenario"], name, *_numbers(line)))
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    text = []
    for row in rows:
        names = [cell.ljust(width) for cell, width in zip(row[:2], widths[:2], strict=True)]
        text.append("  ".join([*names, *(c.rjust(w) for c, w in zip(row[2:], widths[2:], strict=True))]).rstrip())
    text.insert(1, "-" * max(map(len, text)))
    p_fa = bounds["p_fa"].dropna()
    at = f", false alarms of its one decision {p_fa.iloc[0]:g}" if len(p_fa) else ""
    notes = [f"d: distance of the faults from the nearest other hypothesis in standard deviations{at}."]
    notes += [f"{name}: {about}" for name, about in models.items()]
    return "\n".join([*text, "", *notes])
