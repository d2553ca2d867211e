"""Labelled flights for those who train detectors."""

import math
import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import plan as planned
from fddbench.errors import FddbenchError, ResultsError
from fddbench.reporting.data_card import card_text, card_yaml
from fddbench.results.dataset_files import SPLITS, SplitFiles, listed
from fddbench.results.provenance import version_of
from fddbench.runner.fingerprint import fingerprint_of
from fddbench.runner.labelled import Labelled, Signals, labelled_flights
from fddbench.runner.supervised.trial import read_safely
from fddbench.units import unit_of_name

__all__ = ["dataset"]

_LONGEST_S = 86_400.0
_LEAST_RUNS, _VALIDATION = 5, 4
"""Runs that can be split; of five the last is for validation."""
_TYPES = {"float32": pa.float32(), "float64": pa.float64()}


def dataset(
    campaign: Campaign | str | Path,
    output: str | Path,
    *,
    rate_hz: float,
    dtype: str = "float32",
    progress: Callable[[int, int], None] | None = None,
) -> Path:
    """Write labelled signals of all flights of a campaign, split by aircraft, with a card; the folder.

    Parameters
    ----------
    campaign : Campaign, str or Path
        A campaign, its file or name.
    output : str or Path
        New or empty folder.
    rate_hz : float
        Samples a second; the clock of the campaign is a multiple of it.
    dtype : {"float32", "float64"}
        Of the signals.
    progress : callable, optional
        Called with flights written and flights in all.

    Raises
    ------
    FddbenchError
        The rate does not fit the clock, the campaign has too few aircraft to be split, or the folder holds something.
    """
    own = campaign if isinstance(campaign, Campaign) else read_safely(Path(campaign))
    if dtype not in _TYPES:
        raise FddbenchError(f"dtype = {dtype!r}; allowed: {', '.join(_TYPES)}")
    every, out = _every(own, rate_hz), Path(output)
    _require_aircraft(own)
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise ResultsError(f"{out} is there and not empty; name a new folder with --output")
    aside = out.with_name(f".{out.name}.writing")
    shutil.rmtree(aside, ignore_errors=True)
    aside.mkdir(parents=True)
    try:
        _write(own, aside, every, dtype, progress)
        if out.exists():
            out.rmdir()
        aside.rename(out)
    finally:  # a full disk, Ctrl-C: nothing half written stays
        shutil.rmtree(aside, ignore_errors=True)
    return out


def _every(campaign: Campaign, rate_hz: float) -> int:
    """How many samples of the clock there are to one of the data set."""
    clock_hz = 1.0 / campaign.sample_s
    if not math.isfinite(rate_hz) or not 0.0 < rate_hz <= clock_hz * (1 + 1e-12):
        raise FddbenchError(
            f"rate = {rate_hz:g} Hz; the clock of the campaign has {clock_hz:g} Hz, so 0 < rate <= {clock_hz:g}"
        )
    exact = clock_hz / rate_hz
    if exact > _LONGEST_S * clock_hz:
        raise FddbenchError(f"rate = {rate_hz:g} Hz is less than one sample a day; e.g. --rate {clock_hz / 10:g}")
    every = round(exact)
    if abs(exact - every) > 1e-9 * exact:
        near = sorted({clock_hz / n for n in (math.floor(exact), math.ceil(exact))}, reverse=True)
        raise FddbenchError(
            f"rate = {rate_hz:g} Hz is no whole part of the clock of {clock_hz:g} Hz; the nearest that are: "
            + ", ".join(f"{each:.12g}" for each in near)
        )
    return every


def _require_aircraft(campaign: Campaign) -> None:
    runs = min(scenario.n_runs for scenario in planned(campaign).scenarios)
    if runs < _LEAST_RUNS:
        raise FddbenchError(
            f"a scenario of {campaign.name!r} has {runs} Monte-Carlo run{'s' * (runs != 1)}: aircraft are split into train and "
            f"validation by run, which needs {_LEAST_RUNS} at least; e.g. --set dispersions.monte_carlo.runs=50"
        )


def _write(
    campaign: Campaign, folder: Path, every: int, dtype: str, progress: Callable[[int, int], None] | None
) -> None:
    splits = {name: SplitFiles(folder, name) for name in SPLITS}
    cases: list[pa.Table] = []
    counts = {"done": 0, "all": 2 * planned(campaign).n_cases, "faulty": 0, "infeasible": 0, "departed": 0}
    signals = Signals(measured=(), truth=(), sites=())
    try:
        for purpose in ("tuning", "evaluation"):
            signals, parts = labelled_flights(replace(campaign, purpose=purpose), every=every)
            for part in parts:
                _add(part, purpose, splits, cases, counts, dtype)
                if progress is not None:
                    progress(counts["done"], counts["all"])
    finally:
        for files in splits.values():
            files.close()
    pq.write_table(pa.concat_tables(cases), folder / "cases.parquet", compression="zstd")
    for name, content in campaign.files().items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    card = _card(campaign, signals, splits, pa.concat_tables(cases), counts, every, dtype) | {
        "files": list(listed(folder))
    }
    (folder / "card.yaml").write_text(card_yaml(card), encoding="utf-8")
    (folder / "README.md").write_text(card_text(card), encoding="utf-8")


def _add(
    part: Labelled,
    purpose: str,
    splits: dict[str, SplitFiles],
    cases: list[pa.Table],
    counts: dict[str, int],
    dtype: str,
) -> None:
    """Write some flights into their splits."""
    validation = part.run % _LEAST_RUNS == _VALIDATION
    which = np.where(validation, "validation", "train") if purpose == "tuning" else np.full(len(part.run), "test")
    for name in dict.fromkeys(which.tolist()):
        flights = np.flatnonzero(which == name)
        able = [int(i) for i in flights if part.there[:, i].any()]
        if able:
            splits[name].add(_tables(part, able, dtype), len(able))
            if name == "train":
                any_site = np.logical_or.reduce(list(part.faulty.values()))
                counts["faulty"] += int((any_site & part.there)[:, able].sum())
    counts["done"] += len(part.run)
    counts["infeasible"] += sum(reason != "" for reason in part.reasons)
    counts["departed"] += int(part.departed.sum())
    cases.append(_static(part, which, purpose))


def _tables(part: Labelled, flights: list[int], dtype: str) -> dict[str, pa.Table]:
    """Rows of flights, one flight after the other: what is measured with the labels, and the truth."""
    chosen = part.there[:, flights].T.ravel()
    number = np.repeat(np.arange(len(flights), dtype=np.int32), part.there.shape[0])[chosen]

    def column(values: Any) -> Any:
        return values[:, flights].T.ravel()[chosen]

    shared = {
        "case": pa.DictionaryArray.from_arrays(pa.array(number), pa.array([part.cases[i] for i in flights])),
        "time_s": pa.array(np.tile(part.time_s, len(flights))[chosen]),
    }
    labels = {
        "fault": pa.array(column(part.fault), pa.string()).dictionary_encode(),
        "faulty": pa.array(column(np.logical_or.reduce(list(part.faulty.values()))).astype(np.uint8)),
    }
    labels |= {f"faulty_{site}": pa.array(column(on).astype(np.uint8)) for site, on in part.faulty.items()}
    kind = _TYPES[dtype]
    measured = {name: pa.array(column(values)).cast(kind) for name, values in part.measured.items()}
    truth = {name: pa.array(column(values)).cast(kind) for name, values in part.truth.items()}
    return {"measured": pa.table(shared | labels | measured), "truth": pa.table(shared | truth)}


def _static(part: Labelled, which: Any, purpose: str) -> pa.Table:
    """A row a flight; null for not-a-number."""
    point, level, run = (np.array([int(case.split("/")[k]) for case in part.cases]) for k in (1, 2, 3))
    planned_ = part.scenario
    columns: dict[str, Any] = {
        "split": which.tolist(), "purpose": [purpose] * len(run), "case": list(part.cases),
        "scenario": [planned_.name] * len(run), "manoeuvre": [planned_.manoeuvre] * len(run),
        "fault": ["+".join(fault.kind for fault in planned_.faults) or None] * len(run),
        "faulty_sites": ["+".join(planned_.faulty_sites) or None] * len(run), "point": point, "level": level, "run": run,
        "status": ["ok" if reason == "" else "infeasible" for reason in part.reasons],
        "reason": [reason or None for reason in part.reasons], "samples": part.there.sum(axis=0),
    }  # fmt: skip
    texts = {name: pa.array(columns[name], pa.string()) for name in ("fault", "faulty_sites", "reason")}
    numbers = {name: pa.array(values, mask=np.isnan(values)) for name, values in part.static.items()}
    return pa.table({**columns, **texts, **numbers})


def _card(
    campaign: Campaign, signals: Signals, splits: dict[str, SplitFiles], cases: pa.Table, counts: dict[str, int], every: int,
    dtype: str,
) -> dict[str, Any]:  # fmt: skip
    frame = cases.select(["split", "run"]).to_pandas()
    rows = {
        name: {
            "purpose": "evaluation" if name == "test" else "tuning",
            "aircraft": int(frame.loc[frame["split"] == name, "run"].nunique()),
            "flights": files.flights,
            "samples": files.samples,
        }
        for name, files in splits.items()
    }
    names = [*signals.measured, *signals.truth]
    return {
        "campaign": campaign.name, "about": campaign.about, "benchmark": campaign.benchmark, "seed": campaign.seed,
        "campaign_sha256": campaign.sha256, "fingerprint": fingerprint_of(campaign).sha256, "fddbench": version_of("fddbench"),
        "sample_s": campaign.sample_s, "rate_hz": 1.0 / (every * campaign.sample_s), "every": every, "dtype": dtype,
        "splits": rows, "faulty_share": counts["faulty"] / max(splits["train"].samples, 1),
        "infeasible": counts["infeasible"], "departed": counts["departed"], "sites": list(signals.sites),
        "measured": list(signals.measured), "truth": list(signals.truth),
        "units": {name: unit_of_name(re.sub(r"_[0-9]+$", "", name)) for name in names},
    }  # fmt: skip
