"""Cells as short lists of numbers: what the script of the page draws a chosen cell from. No row of the table is in it."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from fddbench.interfaces import Floats
from fddbench.metrics.association import Association
from fddbench.metrics.paired import PairedShares
from fddbench.reporting.formats import DASH, count, interval, percent, present, rate, seconds
from fddbench.reporting.labels import label
from fddbench.reporting.page.cells import Cell
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.sizes import SizeCurve
from fddbench.reporting.svg.axes import ticks_texts
from fddbench.reporting.svg.charts import Parted
from fddbench.reporting.svg.size import Fitted

__all__ = ["ORDER", "counts_of", "fitted_of", "part_names", "parted_of", "payload"]

ORDER = ("right", "late", "undecided", "missed", "wrong_site", "false_alarm")
"""Outcomes of a cell in the payload; of a healthy one the first is quiet."""

Data = dict[str, Any]


def counts_of(line: Mapping[Any, Any]) -> dict[str, int]:
    """Flights of a cell by outcome, those that it has; a scenario of logs may have quiet flights beside faulty ones."""
    names = ("quiet", "false_alarm") if line["healthy"] else (*ORDER, "quiet")
    return {name: int(line[name]) for name in names if present(line[name])}


def payload(columns: Columns, cells: Mapping[tuple[int, int], Cell], folder: str) -> Data:
    """Everything for the script: detectors, scenarios with the names of their parts, cells row by row."""
    n_detectors = len(columns.detectors)
    scenarios = []
    for s, name in enumerate(columns.scenarios):
        own = [cells[s, d] for d in range(n_detectors) if (s, d) in cells]
        line = own[0].line if own else None
        said: Data = {"n": name, "h": int(bool(line is not None and line["healthy"])), "l": None, "m": ""}
        if line is not None:
            said |= {"l": _plain(line["detection_time_limit_s"]), "m": line["pools"] if present(line["pools"]) else ""}
        # parts are the same for all detectors
        said["p"] = {a.name: (label(a.name), part_names(a.lower, a.upper)) for cell in own for a in cell.associations}
        scenarios.append(said)
    rows = [
        [_cell(cells[s, d]) if (s, d) in cells else 0 for d in range(n_detectors)]
        for s in range(len(columns.scenarios))
    ]
    return {"d": list(columns.detectors), "f": folder, "s": scenarios, "c": rows}


def part_names(low: Floats, high: Floats) -> list[str]:
    """What parts are called: their value, of a range its middle."""
    return ticks_texts([0.5 * (a + b) for a, b in zip(low.tolist(), high.tolist(), strict=True)])


def parted_of(own: Association | SizeCurve) -> Parted:
    """What parts are called, hits, flights and interval of each, as pictures take them."""
    if isinstance(own, SizeCurve):
        names, hits, low, high = part_names(own.low, own.high), own.right, own.share_low, own.share_high
    else:
        names, hits, low, high = part_names(own.lower, own.upper), own.failed.astype(np.float64), own.low, own.high
    columns = (hits.astype(int).tolist(), own.flights.astype(int).tolist(), low.tolist(), high.tolist())
    return list(zip(names, *columns, strict=True))


def _cell(cell: Cell) -> Data:
    line = cell.line
    counts = counts_of(line)
    names = ("quiet", *ORDER[1:]) if line["healthy"] else ORDER
    found: Data = {"o": [counts.get(name, 0) for name in names], "n": int(line["flown"])}
    if not line["healthy"]:
        found["o"][0] += counts.get("quiet", 0)  # what went well, as in the bar
    lost = [int(line[name]) for name in ("infeasible", "failed", "departed")]
    if any(lost):
        found["z"] = lost
    right = [percent(line["right_percent"]), interval(line["right_low_percent"], line["right_high_percent"])]
    found["r"] = right if present(line["right_percent"]) else []
    if cell.incidence is not None and cell.incidence.flights:
        own = cell.incidence
        found["i"] = [
            [_short(t) for t in own.time_s.tolist()], own.found.tolist(), own.wrong.tolist(), _mille(own.low), _mille(own.high),
            own.alarmed, _short(own.end_s),
        ]  # fmt: skip
    if cell.declared:
        found["q"] = [[true, said, n] for true, said, n in cell.declared]
    if cell.associations:
        found["a"] = [_association(each) for each in cell.associations]
    if cell.worst:
        found["w"] = list(cell.worst)
    if cell.paired is not None:
        found["b"] = _paired(cell.paired, cell.p_holm)
    if cell.size is not None:
        found["k"] = _size(cell.size)
    found["x"] = _quality(line)
    return found


def _quality(line: Mapping[Any, Any]) -> list[str | int]:
    """Median, 95 % and largest time, over the limit, isolated, changes, bias, rms, healthy margin, bound; 0: none."""
    times = [seconds(line[f"detection_time_{name}_s"]) for name in ("median", "p95", "max")]
    rest = [rate(line[name]) for name in ("normalized_detection_time_max",)]
    rest += [count(line["isolated"])]
    rest += [
        rate(line[f"{name}"])
        for name in ("changes_max", "estimate_bias_median", "estimate_rms_median", "margin_healthy_max")
    ]
    return [0 if each == DASH else each for each in (*times, *rest, percent(line.get("bound_percent")))]


def _association(each: Association) -> list[Any]:
    return [
        each.name,
        round(each.v, 2),
        each.failed.tolist(),
        each.flights.tolist(),
        _hundred(each.low),
        _hundred(each.high),
    ]


def _paired(own: PairedShares, p_holm: float | None) -> list[Any]:
    ends = [_percent(end) for end in (own.difference, own.low, own.high)]
    return [*ends, None if p_holm is None else float(f"{p_holm:.2g}"), own.only_a, own.only_b, own.pairs]


def _size(own: SizeCurve) -> list[Any]:
    names, fitted = part_names(own.low, own.high), fitted_of(own)
    said = f"{own.said[:1].upper()}{own.said[1:]}."
    drawn: Any = 0
    if fitted is not None:
        shares = [round(1000.0 * each) for each in fitted.shares]
        drawn = [*([_short(each) for each in some] for some in (fitted.middles, fitted.sizes)), shares]
        drawn += [None if each is None else _short(each) for each in (fitted.size_90, fitted.size_90_95)]
    return [label(own.name), names, own.right.astype(int).tolist(), own.flights.astype(int).tolist(), _hundred(own.share_low),
            _hundred(own.share_high), said, drawn]  # fmt: skip


def fitted_of(own: SizeCurve) -> Fitted | None:
    """The fitted curve over the sizes flown, as pictures take it; None without one."""
    if own.curve is None:
        return None
    sizes = np.geomspace(max(float(own.low[0]), 1e-12), float(own.high[-1]), _POINTS)
    near = [
        None if end is None or end > _DRAWN_TO * sizes[-1] else end for end in (own.curve.size_90, own.curve.size_90_95)
    ]
    return Fitted(
        middles=own.middle.tolist(), sizes=sizes.tolist(), shares=own.curve.share(sizes).tolist(), size_90=near[0],
        size_90_95=near[1],
    )  # fmt: skip


_POINTS, _DRAWN_TO = 25, 1.5
"""Points of a drawn curve; how far beyond the largest size flown its end may be drawn."""


def _short(value: float) -> float | None:
    return float(f"{value:.4g}") if np.isfinite(value) else None


def _mille(values: "np.ndarray[Any, Any]") -> list[int | None]:
    return [None if np.isnan(v) else round(1000.0 * v) for v in values.tolist()]


def _hundred(values: "np.ndarray[Any, Any]") -> list[int | None]:
    return [None if np.isnan(v) else round(100.0 * v) for v in values.tolist()]


def _percent(value: float | None) -> float | None:
    return None if value is None else round(100.0 * value, 1)


def _plain(value: Any) -> float | None:
    return float(value) if present(value) else None
