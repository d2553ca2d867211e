"""Maps of the smallest fault that is found, one picture a scenario, and the same numbers for the whole envelope."""

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from fddbench.metrics.detectable import SHARE
from fddbench.metrics.smallest import ABOUT, ABOVE, AT_MOST, LEAST
from fddbench.reporting.figures import label
from fddbench.reporting.formats import DASH, count, interval, percent, present, rate
from fddbench.reporting.pictures import INK, MUTED, colour, to_png
from fddbench.reporting.tables import Cell
from fddbench.units import suffix_of_name, unit_of_name

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap, Normalize
    from matplotlib.figure import Figure

Line = dict[Any, Any]

__all__ = ["MAP_HEADS", "detectability_lines", "detectability_pictures", "quantity"]

MAP_HEADS = (
    "scenario", "detector", "smallest found", "found of larger", "smallest in cells", "in sight", "false alarms", "per hour",
)  # fmt: skip
_SIGN = {AT_MOST: "≤ ", ABOVE: "> "}
_MAP = ("site", "size", "times", "scenario")
"""What tells one map from another."""
_HATCH, _NOBODY = "////", "#d9dee4"


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


def detectability_pictures(maps: pd.DataFrame, alarms: pd.DataFrame) -> list[dict[str, Any]]:
    """By map and scenario its title, its picture (PNG in base64), and what is hatched; pictures that cannot be are left out."""
    cells = _without_nulls(maps[maps["x_low"].notna().to_numpy(dtype=bool)])
    false_alarms = {line["detector"]: line for line in alarms.to_dict("records")}
    found = []
    for _, own in cells.groupby(list(_MAP), sort=False):
        png = _picture(own, false_alarms)
        first = own.iloc[0]
        if png is not None:
            what = quantity(first["size"], first["times"])
            found.append({"scenario": first["scenario"], "site": first["site"], "quantity": what, "png": png})
    return found


def _picture(own: pd.DataFrame, alarms: dict[str, Line]) -> str | None:
    """Panels of one scenario, a detector each, with one scale of colours."""
    import matplotlib as mpl

    detectors = list(own["detector"].unique())
    columns = min(3, max(2, len(detectors)))
    n_rows = -(-len(detectors) // columns)
    known = own["smallest"].to_numpy(dtype=float, na_value=np.nan)
    largest = float(np.max(known, where=np.isfinite(known), initial=0.0))
    norm = mpl.colors.Normalize(0.0, largest or 1.0)
    colours = mpl.colormaps["viridis_r"]

    def draw(figure: "Figure") -> None:
        panels = figure.subplots(n_rows, columns, squeeze=False).ravel()
        for i, (axes, detector) in enumerate(zip(panels, detectors, strict=False)):
            _panel(axes, own[(own["detector"] == detector).to_numpy(dtype=bool)], norm, colours)
            axes.set_title(detector, color=colour(i), pad=16)
            axes.annotate(_beside(alarms[detector]), (0.0, 1.015), xycoords="axes fraction", color=MUTED, size=7.5)
        for axes in panels[len(detectors) :]:
            axes.set_visible(False)
        first = own.iloc[0]
        if largest:  # else no cell has a colour
            bar = figure.colorbar(mpl.cm.ScalarMappable(norm, colours), ax=panels.tolist(), shrink=0.9, pad=0.01)
            bar.set_label(f"{quantity(first['size'], first['times'])} found in {100 * SHARE:g} %")
        _legend(figure, own)

    return to_png(draw, width_in=11.4, height_in=0.5 + 3.6 * n_rows)


def _beside(line: Line) -> str:
    """False alarms of a detector, in words."""
    hourly = f", {rate(line['false_alarm_per_hour'])} per h" if present(line["false_alarm_per_hour"]) else ""
    return f"false alarms: {count(line['alarms'])} of {count(line['distinct_flights'])} flights{hourly}"


def _panel(axes: "Axes", cells: pd.DataFrame, norm: "Normalize", colours: "Colormap") -> None:
    """Map of one detector."""
    from matplotlib.patches import Rectangle

    axes.grid(visible=False)
    for line in cells.to_dict("records"):
        if not line["flights"]:
            continue
        corner, sides = (line["x_low"], line["y_low"]), (line["x_high"] - line["x_low"], line["y_high"] - line["y_low"])
        told = present(line["relation"])
        tone: Any = (
            colours(norm(line["smallest"])) if told and line["relation"] != ABOVE else _NOBODY if told else "white"
        )
        axes.add_patch(Rectangle(corner, *sides, facecolor=tone, edgecolor="white", linewidth=1.0))
        if line["small"]:
            axes.add_patch(Rectangle(corner, *sides, fill=False, hatch=_HATCH, edgecolor=MUTED, linewidth=0.0))
        box = {"boxstyle": "square,pad=0.15", "facecolor": tone, "edgecolor": "none"} if line["small"] else None
        middle = corner[0] + 0.5 * sides[0], corner[1] + 0.5 * sides[1]
        text = f"{_number(line)}\nn {line['flights']}" if told else f"n {line['flights']}"
        axes.text(*middle, text, ha="center", va="center", size=7.5, color=_ink(tone), bbox=box)
    ends = {axis: (cells[f"{axis}_low"].min(), cells[f"{axis}_high"].max()) for axis in "xy"}
    axes.set(xlim=ends["x"], ylim=ends["y"], xlabel=label(cells["x"].iloc[0]), ylabel=label(cells["y"].iloc[0]))


def _ink(tone: Any) -> str:
    """Colour of text that can be read on this one."""
    from matplotlib.colors import to_rgb

    red, green, blue = to_rgb(tone)
    return "white" if 0.299 * red + 0.587 * green + 0.114 * blue < 0.5 else INK


def _legend(figure: "Figure", own: pd.DataFrame) -> None:
    """What the looks of a cell mean, of those that there are."""
    from matplotlib.patches import Patch

    small = own["small"].to_numpy(dtype=bool)
    above = (own["relation"] == ABOVE).to_numpy(dtype=bool, na_value=False)
    few = own["relation"].isna().to_numpy(dtype=bool) & (own["flights"] > 0).to_numpy(dtype=bool)
    looks = []
    if above.any():
        looks.append(Patch(facecolor=_NOBODY, edgecolor=MUTED, label="> : not even the largest flown"))
    if few.any():
        looks.append(Patch(facecolor="white", edgecolor=MUTED, label=f"not enough flights (fewer than {LEAST})"))
    if small.any():
        times = own["times"].iloc[0]
        name = label(times).partition(" [")[0]
        looks.append(Patch(facecolor="white", edgecolor=MUTED, hatch=_HATCH, label=f"small {name}"))
    if looks:
        figure.legend(handles=looks, loc="outside upper left", ncols=len(looks))
