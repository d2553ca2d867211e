"""A comparison as plain text for a terminal, and as cells of a page."""

from typing import Any

import pandas as pd

from fddbench.reporting.formats import DASH, count, interval, present, signed
from fddbench.reporting.tables import Cell

__all__ = ["comparison_cells", "comparison_text"]


def comparison_cells(table: pd.DataFrame) -> tuple[list[list[Cell]], str]:
    """Cells of what differs, and how many lines do not; of a page."""
    lines = table.to_dict("records")
    differ = [line for line in lines if line["difference"]]
    cells = [_cells(line) for line in differ]
    return cells, f"{len(lines) - len(differ)} of {len(lines)} comparisons show no difference."


def _cells(line: dict[Any, Any]) -> list[Cell]:
    names = (str(line["scenario"]), _who(line), str(line["measure"]).replace("_", " "))
    said = _verdict(line)
    return [
        *(Cell(text) for text in (*names, _number(line["a"]), _number(line["b"]))),
        Cell(_difference(line), f"{count(line['pairs'])} flights"),
        Cell(_p(line["p_holm"])),
        Cell(said, alarm=said == "worse"),
    ]


def _verdict(line: dict[Any, Any]) -> str:
    return str(line["verdict"]) if present(line["verdict"]) else "chance may explain it"


def comparison_text(table: pd.DataFrame) -> str:
    """Lines of what differs, then how many do not; shares in percent, times in seconds, 95 % intervals."""
    lines = table.to_dict("records")
    differ = [line for line in lines if line["difference"]]
    heads = ("scenario", "detector", "measure", "a", "b", "b - a [95 %]", "p Holm", "")
    cells = [heads] + [
        (
            str(line["scenario"]), _who(line), str(line["measure"]), _number(line["a"]), _number(line["b"]),
            _difference(line), _p(line["p_holm"]), str(line["verdict"]) if present(line["verdict"]) else "",
        )
        for line in differ
    ]  # fmt: skip
    widths = [max(len(row[i]) for row in cells) for i in range(len(heads))]
    text = ["  ".join(value.ljust(width) for value, width in zip(row, widths, strict=True)).rstrip() for row in cells]
    same = len(lines) - len(differ)
    pairs = {int(line["pairs"]) for line in lines if line["measure"] != "detection_time"}
    flights = f"{min(pairs)} to {max(pairs)}" if len(pairs) > 1 else f"{next(iter(pairs), 0)}"
    note = (
        f"{same} of {len(lines)} comparisons show no difference; {flights} flights in each scenario, paired by flight."
    )
    return "\n".join([*(text if differ else []), *([""] if differ else []), note])


def _who(line: dict[Any, Any]) -> str:
    one, other = str(line["detector_a"]), str(line["detector_b"])
    return one if one == other else f"{one} > {other}"


def _number(value: float) -> str:
    return f"{value:.4g}"


def _difference(line: dict[Any, Any]) -> str:
    ends = interval(line["low"], line["high"], lambda end: f"{end:.3g}").replace(" … ", ", ")
    return signed(float(f"{line['difference']:.3g}")) + (f" [{ends}]" if ends else "")


def _p(value: float) -> str:
    return DASH if not present(value) else "<0.001" if value < 0.001 else f"{value:.3f}"
