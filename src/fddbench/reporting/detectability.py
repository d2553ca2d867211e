"""Maps of the smallest fault that is found, one picture a scenario, and the same numbers for the whole envelope."""

from typing import Any

import numpy as np
import pandas as pd

from fddbench.metrics.detectable import SHARE
from fddbench.metrics.smallest import ABOUT, ABOVE, AT_MOST
from fddbench.reporting.formats import DASH, count, interval, percent, present, rate
from fddbench.reporting.labels import label
from fddbench.reporting.names import TITLE, shortened
from fddbench.reporting.svg.axes import ticks_text
from fddbench.reporting.svg.heat import HeatCell, Side, heat_scene
from fddbench.reporting.svg.scene import Scene
from fddbench.reporting.tables import Cell
from fddbench.units import suffix_of_name, unit_of_name

Line = dict[Any, Any]

__all__ = ["MAP_HEADS", "detectability_lines", "detectability_scenes", "quantity"]

MAP_HEADS = (
    "scenario", "detector", "smallest found", "found of larger", "smallest in cells", "in sight", "false alarms", "per hour",
)  # fmt: skip
_SIGN = {AT_MOST: "≤ ", ABOVE: "> "}
_MAP = ("site", "size", "times", "scenario")
"""What tells one map from another."""


def quantity(size: str, times: str = "") -> str:
    """What a map shows, with its unit.

    >>> quantity("loss_percent"), quantity("loss_percent", "elevator_trim_deg"), quantity("rate_deg_s", "gain_ratio")
    ('loss [%]', 'loss × |elevator trim| [deg]', 'rate × |gain| [deg/s -]')
    """
    if not times:
        return label(size)
    words = [name.removesuffix(suffix_of_name(name)).replace("_", " ") for name in (size, times)]
    units = [unit_of_name(times)] if size.endswith("_percent") else [unit_of_name(size), unit_of_name(times)]
    return f"{words[0]} × |{words[1]}| [{' '.join(filter(None, units))}]"


def detectability_lines(maps: pd.DataFrame, alarms: pd.DataFrame) -> list[list[Cell]]:
    """Cells of a line per map, scenario and detector: the whole envelope, the range of its cells, false alarms beside."""
    false_alarms = {line["detector"]: line for line in alarms.to_dict("records")}
    maps = _without_nulls(maps)
    whole = maps["x_low"].isna().to_numpy(dtype=bool)
    cells = dict(list(maps[~whole].groupby([*_MAP, "detector"], sort=False)))
    lines = []
    for line in maps[whole].to_dict("records"):
        own = cells[tuple(line[name] for name in (*_MAP, "detector"))]
        ends = interval(line["large_found_low_percent"], line["large_found_high_percent"])
        told = present(line["relation"])
        large = f"{percent(line['large_found_percent'])} %" if told else DASH
        sure = own[((own["relation"] == ABOUT) | (own["relation"] == AT_MOST)).to_numpy(dtype=bool, na_value=False)]
        lines.append(
            [
                Cell(line["scenario"], f"{line['site']}: {quantity(line['size'], line['times'])}"),
                Cell(line["detector"]),
                Cell(_number(line), f"n {count(line['flights'])}"),
                Cell(large, f"{count(line['large'])}{f': {ends}' if ends else ''}" if told else ""),
                Cell(_range(sure)),
                Cell(f"{len(sure)} of {int(np.sum(own['flights'].to_numpy(dtype=int) > 0))}"),
                *_alarm_cells(false_alarms[line["detector"]]),
            ]
        )
    return lines


def _without_nulls(maps: pd.DataFrame) -> pd.DataFrame:
    """The same lines, "" where a size is multiplied by nothing: null equals nothing, not even itself."""
    return maps.assign(times=maps["times"].fillna(""))


def _alarm_cells(line: Line) -> list[Cell]:
    ends = interval(line["false_alarm_low_per_hour"], line["false_alarm_high_per_hour"], rate)
    return [
        Cell(f"{count(line['alarms'])} of {count(line['distinct_flights'])}", f"{percent(line['alarms_percent'])} %"),
        Cell(rate(line["false_alarm_per_hour"]), ends),
    ]


def _range(cells: pd.DataFrame) -> str:
    sizes = cells["smallest"].to_numpy(dtype=float)
    return f"{rate(sizes.min())} … {rate(sizes.max())}" if len(sizes) else DASH


def _number(line: Line) -> str:
    if not present(line["relation"]):
        return DASH
    return f"{_SIGN.get(line['relation'], '')}{rate(line['smallest'])}"


def detectability_scenes(maps: pd.DataFrame, alarms: pd.DataFrame) -> list[dict[str, Any]]:
    """By map and scenario its title and a picture per detector, with one scale of colours."""
    cells = _without_nulls(maps[maps["x_low"].notna().to_numpy(dtype=bool)])
    false_alarms = {line["detector"]: line for line in alarms.to_dict("records")}
    found = []
    for _, own in cells.groupby(list(_MAP), sort=False):
        first = own.iloc[0]
        what = quantity(first["size"], first["times"])
        known = own["smallest"].to_numpy(dtype=float, na_value=np.nan)
        short = shortened(own["detector"].astype(str), TITLE)
        largest = float(np.max(known, where=np.isfinite(known), initial=0.0))
        scenes = [
            _scene(group, what, largest or 1.0, false_alarms[detector], short[str(detector)])
            for detector, group in own.groupby("detector", sort=False)
            if _finite(group)
        ]
        if scenes:
            found.append({"scenario": first["scenario"], "site": first["site"], "quantity": what, "scenes": scenes})
    return found


def _finite(group: pd.DataFrame) -> bool:
    """Whether an axis can hold the cells: sizes of 1e308 have no middle."""
    with np.errstate(over="ignore"):
        ends = group[["x_low", "x_high", "y_low", "y_high"]].to_numpy(dtype=float)
        return bool(np.isfinite(ends).all() and np.isfinite(np.ptp(ends)))


def _scene(group: pd.DataFrame, what: str, largest: float, alarms: Line, title: str) -> Scene:
    """Map of one detector."""
    sides = {axis: _side(group, axis) for axis in "xy"}
    cells = [_cell(line, largest) for line in group.to_dict("records") if line["flights"]]
    detector = str(group["detector"].iloc[0])
    return heat_scene(
        cells, x=sides["x"], y=sides["y"], title=title, note=_beside(alarms), look="o0",
        label=f"Smallest {what} found in {100 * SHARE:g} % of flights by {detector}",
    )  # fmt: skip


def _side(group: pd.DataFrame, axis: str) -> Side:
    edges = sorted({*group[f"{axis}_low"].tolist(), *group[f"{axis}_high"].tolist()})
    return Side(
        name=label(group[axis].iloc[0]), low=edges[0], high=edges[-1], ticks=[(e, ticks_text(e)) for e in edges]
    )


def _cell(line: Line, largest: float) -> HeatCell:
    told = present(line["relation"])
    above = told and line["relation"] == ABOVE
    return HeatCell(
        x=(line["x_low"], line["x_high"]), y=(line["y_low"], line["y_high"]),
        dark=None if above else line["smallest"] / largest if told else 0.0,
        text=_number(line) if told else f"n {line['flights']}", below=f"n {line['flights']}" if told else "",
        hatched=bool(line["small"]),
    )  # fmt: skip


def _beside(line: Line) -> str:
    """False alarms of a detector, in words."""
    hourly = f", {rate(line['false_alarm_per_hour'])} per h" if present(line["false_alarm_per_hour"]) else ""
    return f"false alarms: {count(line['alarms'])} of {count(line['distinct_flights'])} flights{hourly}"
