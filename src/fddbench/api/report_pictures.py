"""The pictures of the page one by one, for notebooks and papers: SVG, PDF and PNG."""

from pathlib import Path

import pandas as pd

from fddbench.api.curves import operating_curve
from fddbench.api.findings import swept_columns
from fddbench.api.tables import in_sample
from fddbench.errors import FddbenchError, did_you_mean
from fddbench.metrics.alarms import summarize_alarms
from fddbench.metrics.summary import summarize
from fddbench.reporting.labels import label
from fddbench.reporting.page.cells import Cell, cells, with_curve
from fddbench.reporting.page.columns import FAILED, Columns
from fddbench.reporting.page.envelope import envelope_pairs, failed_map
from fddbench.reporting.page.matrix import matrix_scene
from fddbench.reporting.page.operating import MEASURES, operating_scene
from fddbench.reporting.page.payload import fitted_of, parted_of
from fddbench.reporting.page.ranking import ranking
from fddbench.reporting.svg.charts import incidence_scene, parts_scene
from fddbench.reporting.svg.picture import Picture
from fddbench.reporting.svg.size import size_scene
from fddbench.results.table import load
from fddbench.runner.fingerprint import frozen

__all__ = ["envelope", "failures", "incidence", "operating_curve_picture", "outcome_matrix", "size_curve"]


def outcome_matrix(folder: str | Path) -> Picture:
    """Outcomes of every scenario with every detector as stacked bars, the interval of right below.

    Raises
    ------
    FddbenchError
        No folder of results.
    """
    columns, own = _cells(folder)
    return Picture(matrix_scene(columns, own))


def incidence(folder: str | Path, detector: str = "", scenario: str = "") -> Picture:
    """Share of all flights found right by each time, with 95 % bands, the limit, and healthy sites declared meanwhile.

    Parameters
    ----------
    folder : str or Path
        Folder of results.
    detector : str
        This one alone, with its healthy sites declared; by default all.
    scenario : str
        By default the faulty one in which most flights fail.

    Raises
    ------
    FddbenchError
        No folder of results, no such detector or scenario, or no fault in it.
    """
    columns, own = _cells(folder)
    s = _scenario(columns, own, scenario)
    chosen = [_place(columns.detectors, detector, "detector")] if detector else range(len(columns.detectors))
    curves = {
        columns.detectors[d]: (d, cell.incidence)
        for d in chosen
        if (cell := own.get((s, d))) is not None and cell.incidence is not None
    }
    if not curves:
        raise FddbenchError(f"{folder}: no flight with a fault was flown in {columns.scenarios[s]}")
    limit = own[s, chosen[0]].line["detection_time_limit_s"]
    limit_s: float = float("nan") if pd.isna(limit) else float(limit)
    return Picture(incidence_scene(curves, limit_s, scenario=columns.scenarios[s], wrong_of=detector))


def failures(folder: str | Path, detector: str, scenario: str, parameter: str = "") -> Picture:
    """Failed share over the parts of a parameter, with intervals and counts; by default of what goes with failure most.

    Raises
    ------
    FddbenchError
        No folder of results, no such detector, scenario or parameter, or nothing that goes with failure.
    """
    columns, own = _cells(folder)
    s, d = _scenario(columns, own, scenario), _place(columns.detectors, detector, "detector")
    found = {each.name: each for each in own[s, d].associations}
    if not found:
        raise FddbenchError(f"{folder}: nothing that varies goes with failure of {detector} in {columns.scenarios[s]}")
    name = parameter or next(iter(found))
    chosen = found[_known(list(found), name, "parameter among those that go with failure")]
    title = f"Failed share of {detector} in {columns.scenarios[s]} over {label(chosen.name)}"
    return Picture(parts_scene(parted_of(chosen), name=label(chosen.name), label=title, number=d))


def size_curve(folder: str | Path, detector: str, scenario: str) -> Picture:
    """Share found in time over the size of the fault, where a scenario varies one, with the curve of `fddbench.pod`.

    Raises
    ------
    FddbenchError
        No folder of results, no such detector or scenario, or no size that varies in it.
    """
    columns, own = _cells(folder)
    s, d = _scenario(columns, own, scenario), _place(columns.detectors, detector, "detector")
    size = with_curve(columns, own[s, d]).size
    if size is None:
        raise FddbenchError(f"{folder}: no size of a fault varies in {columns.scenarios[s]}")
    title = f"Share found of {detector} in {columns.scenarios[s]} over {label(size.name)}"
    fitted = fitted_of(size)
    if fitted is not None:
        return Picture(
            size_scene(parted_of(size), fitted, name=label(size.name), label=f"{title}: {size.said}", number=d)
        )
    return Picture(parts_scene(parted_of(size), name=label(size.name), label=title, number=d, what="right [%]"))


def operating_curve_picture(
    folder: str | Path,
    scenario: str = "",
    *,
    design: str | None = None,
    gain: str | None = None,
    measure: str = "missed",
) -> Picture:
    """False alarms per hour against what is missed or late, or against delay, for every value of a swept gain.

    Parameters
    ----------
    folder : str or Path
        Folder of results of a campaign that sweeps a gain of a detector.
    scenario : str
        One with a fault; by default the first.
    design, gain : str, optional
        Which curve; by default the first.
    measure : {"missed", "delay"}

    Raises
    ------
    FddbenchError
        Nothing is swept there, no such curve, scenario or measure, or no point can be placed.
    """
    curves = operating_curve(folder, design=design, gain=gain)
    first = curves.iloc[0]
    own = curves[((curves["design"] == first["design"]) & (curves["gain"] == first["gain"])).to_numpy(dtype=bool)]
    names = [str(name) for name in own["scenario"].unique()]
    scene = operating_scene(
        own, names[_place(names, scenario, "scenario with a fault")] if scenario else names[0],
        _known(list(MEASURES), measure, "measure"),
    )  # fmt: skip
    if scene is None:
        raise FddbenchError(f"{folder}: no point of this curve can be placed: nothing decided, or no healthy hour")
    return Picture(scene)


def envelope(folder: str | Path, detector: str, x: str = "", y: str = "") -> Picture:
    """Failed share over two parameters as a map, with n in each cell.

    Parameters
    ----------
    folder : str or Path
        Folder of results.
    detector : str
    x, y : str
        Columns of parameters, ``"p_v_cas_kt"``; by default those that the benchmark or the grid of the campaign names.

    Raises
    ------
    FddbenchError
        No folder of results, no such detector or column, or nothing to map over.
    """
    rows = load(folder, fair=True)
    columns = Columns(rows)
    d = _place(columns.detectors, detector, "detector")
    if not (x and y):
        campaign = frozen(Path(folder))
        pairs = envelope_pairs(columns, getattr(campaign.bench, "envelope_axes", ()), swept_columns(rows, campaign))
        if not pairs:
            raise FddbenchError(f"{folder}: no two parameters of the envelope vary; name two columns, x and y")
        x, y = pairs[0]
    for name in (x, y):
        _known([str(each) for each in rows.columns if str(each).startswith("p_")], name, "parameter")
    scene = failed_map(columns, d, x, y)
    if scene is None:
        raise FddbenchError(f"{folder}: {x} and {y} do not vary, or no flight with a fault is decided")
    return Picture(scene)


def _cells(folder: str | Path) -> tuple[Columns, dict[tuple[int, int], Cell]]:
    rows = load(folder, fair=True)
    columns, own = Columns(rows), in_sample(folder)
    ranks = ranking(columns, summarize_alarms(rows, in_sample=own), in_sample=own)
    best = ranks[0].number if ranks and ranks[0].decided else None
    return columns, cells(columns, summarize(rows, in_sample=own), best)


def _known(names: list[str], name: str, what: str) -> str:
    if name not in names:
        hint = did_you_mean(name, names)
        raise FddbenchError(
            " ".join(filter(None, [f"there is no {what} {name!r}.", hint, f"Known: {', '.join(names)}"]))
        )
    return name


def _place(names: tuple[str, ...] | list[str], name: str, what: str) -> int:
    return list(names).index(_known(list(names), name, what))


def _scenario(columns: Columns, own: dict[tuple[int, int], Cell], name: str) -> int:
    """Place of a scenario; without a name the faulty one in which most flights fail."""
    if name:
        return _place(columns.scenarios, name, "scenario")
    failed = {s: 0.0 for (s, _), cell in own.items() if cell.incidence is not None}
    if not failed:
        raise FddbenchError("no flight with a fault was flown")
    for (s, _), cell in own.items():
        if s in failed:
            failed[s] += sum(cell.line[key] or 0 for key in FAILED)
    return max(failed, key=lambda s: failed[s])
