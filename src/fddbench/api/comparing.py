"""Two folders of results, or two detectors of one, compared flight by flight."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa

from fddbench.errors import FddbenchError
from fddbench.metrics.paired import holm, paired_shares, paired_times
from fddbench.metrics.shares import column
from fddbench.reporting.labels import of_a_fault
from fddbench.results.folder import provenance_of
from fddbench.results.table import load

__all__ = ["COMPARISON", "MEASURES", "compare", "got_worse"]

MEASURES = {"right": 1, "wrong_site": -1, "false_alarm": -1, "detection_time": -1}
"""What is compared, and whether more of it is better (1) or worse (-1)."""

COMPARISON = pa.schema(
    [
        column("scenario", pa.string(), "name of the scenario"),
        column("detector_a", pa.string(), "name of the design in the first folder"),
        column("detector_b", pa.string(), "name of the design in the second folder"),
        column(
            "measure",
            pa.string(),
            "right, wrong_site, false_alarm (shares of flights [%]) or detection_time (median [s])",
        ),
        column("pairs", pa.int64(), "flights that both have decided; for detection_time those that both have found"),
        column("runs", pa.int64(), "independent runs that they come from"),
        column("a", pa.float64(), "share or median of the first"),
        column("b", pa.float64(), "share or median of the second"),
        column("only_a", pa.int64(), "flights that count for the first alone; null: a time"),
        column("only_b", pa.int64(), "flights that count for the second alone; null: a time"),
        column("difference", pa.float64(), "second less first [%], of times the median difference of a run [s]"),
        column("low", pa.float64(), "lower end of its 95 % interval; null: too few runs"),
        column("high", pa.float64(), "upper end"),
        column("p_value", pa.float64(), "exact sign test by run, two-sided; with one flight a run McNemar's"),
        column("p_holm", pa.float64(), "the same, adjusted for all lines of the table"),
        column("verdict", pa.string(), "better, worse, or null where chance may explain it (p_holm 0.05 or more)"),
    ]
)

Stated = tuple[str, tuple[str, ...], tuple[str, ...]]
"""A measure, and the scenarios and detectors of which a campaign requires it."""

_NEEDS = ("scenario", "point", "level", "run", "detector", "status", "outcome", "n_faulty", "detection_time_s")
_LEVEL = 0.05


def compare(
    a: str | Path, b: str | Path | None = None, detectors: Sequence[str] | tuple[str, str] = ()
) -> pd.DataFrame:
    """Table of `COMPARISON` columns: what differs between two folders on the flights that both hold.

    Parameters
    ----------
    a, b : str or Path
        Folders of results; one alone to compare two of its detectors.
    detectors : sequence of str
        Two names, the detector of `a` and that of `b`; by default every one that both folders have, with itself.

    Raises
    ------
    FddbenchError
        No folders of results, no such detector, or no flight that both hold: the same scenario, run, parameters and faults.
    """
    own = b is None
    first = load(a, fair=True)
    second = first if b is None else load(b, fair=True)
    seeds = [provenance_of(Path(folder))["seed"] for folder in (a, a if b is None else b)]
    if seeds[0] != seeds[1]:
        raise FddbenchError(
            f"{a} and {b} have no flight in common: their seeds are {seeds[0]} and {seeds[1]}, so no aircraft and no air is "
            "the same; fly one of them with the seed of the other"
        )
    pairs = _pairs(first, second, detectors, own=own)
    keys = _keys(first, second)
    lines: list[dict[str, Any]] = []
    for one, other in pairs:
        both = _matched(first, second, one, other, keys)
        names = {"detector_a": one, "detector_b": other}
        for scenario, group in both.groupby("scenario", sort=False):
            lines += [{"scenario": scenario, **names, **line} for line in _measured(group)]
    if not lines:
        raise FddbenchError(
            f"{a} and {b or a} have no flight in common: scenarios, runs, parameters and faults must be the same (the same "
            "seed, and dispersions of the same distributions)"
        )
    adjusted = holm([np.nan if line["p_value"] is None else line["p_value"] for line in lines])
    for line, p in zip(lines, adjusted, strict=True):
        line["p_holm"] = None if np.isnan(p) else float(p)
        line["verdict"] = _verdict(line)
    table: pd.DataFrame = pa.Table.from_pylist(lines, schema=COMPARISON).to_pandas(types_mapper=pd.ArrowDtype)
    return table


def got_worse(table: pd.DataFrame, measures: Sequence[str], stated: Sequence[Stated] = ()) -> pd.DataFrame:
    """Lines of a comparison in which one of these measures got worse.

    Parameters
    ----------
    table : DataFrame
        As `compare` gives it.
    measures : sequence of str
        Names of `MEASURES`, of every scenario and detector.
    stated : sequence of (measure, scenarios, detectors)
        Measures of some scenarios and detectors only, as of `fddbench.api.requiring.stated`.

    Raises
    ------
    FddbenchError
        There is no such measure.
    """
    unknown = [name for name in measures if name not in MEASURES]
    if unknown:
        raise FddbenchError(f"nothing is measured as {unknown[0]!r}; known: {', '.join(MEASURES)}")
    chosen = table["measure"].isin(list(measures))
    for measure, scenarios, detectors in stated:
        named = table["scenario"].isin(list(scenarios)) & table["detector_b"].isin(list(detectors))
        chosen |= (table["measure"] == measure) & named
    chosen &= table["verdict"] == "worse"
    return table[np.asarray(chosen.fillna(False), dtype=bool)]


def _pairs(first: pd.DataFrame, second: pd.DataFrame, wanted: Sequence[str], *, own: bool) -> list[tuple[str, str]]:
    known = [[str(name) for name in rows["detector"].unique()] for rows in (first, second)]
    if not wanted:
        if own:
            raise FddbenchError(f"name two detectors of one folder: {', '.join(known[0])}; or give a second folder")
        both = [(name, name) for name in known[0] if name in known[1]]
        if not both:
            raise FddbenchError(
                f"the folders have no detector in common: {', '.join(known[0])} and {', '.join(known[1])}; name one of each"
            )
        return both
    if len(wanted) != 2:
        raise FddbenchError(f"compare two detectors, got {len(wanted)}: {', '.join(wanted)}")
    if own and wanted[0] == wanted[1]:
        raise FddbenchError(f"{wanted[0]} is the same as itself; name two detectors, or give a second folder")
    for name, names in zip(wanted, known, strict=True):
        if name not in names:
            raise FddbenchError(f"no detector is called {name!r} there; known: {', '.join(names)}")
    return [(wanted[0], wanted[1])]


def _keys(first: pd.DataFrame, second: pd.DataFrame) -> list[str]:
    """Columns that make a flight the same one: scenario, run, parameters, and what was drawn or swept of the faults."""
    varied = [name for name in first.columns if name.startswith("p_") or of_a_fault(name)]
    return ["scenario", "run", *(name for name in varied if name in second.columns)]


def _matched(first: pd.DataFrame, second: pd.DataFrame, one: str, other: str, keys: list[str]) -> pd.DataFrame:
    """Flights that both have flown, in the order of the first, with suffixes _a and _b."""
    sides = []
    for rows, name in ((first, one), (second, other)):
        chosen = rows[np.asarray((rows["detector"] == name) & (rows["status"] == "ok"), dtype=bool)]
        own = chosen[[*keys, "outcome", "n_faulty", "detection_time_s"]].copy()
        # points that differ in nothing but their number are told apart by it
        own["twin"] = own.groupby(keys, sort=False, dropna=False).cumcount()
        sides.append(own)
    return sides[0].merge(sides[1], on=[*keys, "twin"], suffixes=("_a", "_b"))


def _measured(group: pd.DataFrame) -> Iterator[dict[str, Any]]:
    outcomes = [np.asarray(group[f"outcome_{side}"], dtype=object) for side in "ab"]
    sure = np.array([bool(one != "undecided" and other != "undecided") for one, other in zip(*outcomes, strict=True)])
    runs = group["run"].to_numpy()
    faulty = bool((group["n_faulty_a"] > 0).any())
    for name in ("right", "wrong_site", "false_alarm") if faulty else ("false_alarm",):
        hits = [np.array([one == name for one in outcome])[sure] for outcome in outcomes]
        of = paired_shares(hits[0], hits[1], runs[sure])
        if of.pairs:
            yield {
                "measure": name, "pairs": of.pairs, "runs": of.runs, "only_a": of.only_a, "only_b": of.only_b,
                "a": 100.0 * float(hits[0].mean()), "b": 100.0 * float(hits[1].mean()), "p_value": of.p_value,
                **{key: None if value is None else 100.0 * value for key, value in _interval(of).items()},
            }  # fmt: skip
    times = [group[f"detection_time_s_{side}"].to_numpy(dtype=float, na_value=np.nan) for side in "ab"]
    differ = paired_times(times[0], times[1], runs)
    if differ.pairs:
        found = ~np.isnan(times[0] + times[1])
        yield {
            "measure": "detection_time", "pairs": differ.pairs, "runs": len(np.unique(runs[found])),
            "only_a": None, "only_b": None, "a": float(np.median(times[0][found])), "b": float(np.median(times[1][found])),
            "difference": differ.median_s, "low": differ.low_s, "high": differ.high_s, "p_value": differ.p_value,
        }  # fmt: skip


def _interval(of: Any) -> dict[str, float | None]:
    return {"difference": of.difference, "low": of.low, "high": of.high}


def _verdict(line: dict[str, Any]) -> str | None:
    p, difference = line["p_holm"], line["difference"]
    if p is None or p >= _LEVEL or not difference:
        return None
    return "better" if difference * MEASURES[line["measure"]] > 0 else "worse"
