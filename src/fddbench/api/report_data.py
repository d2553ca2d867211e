"""Gathers from a folder of results what its page shows; the signals are flown again from the frozen campaign."""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from fddbench.api.bounds import bounds_of
from fddbench.api.curves import operating_of
from fddbench.api.detectability import detectable_of
from fddbench.api.findings import swept_columns
from fddbench.api.requiring import judgements
from fddbench.api.rows_alone import rows_alone
from fddbench.api.tables import overview
from fddbench.campaign.meaning import Campaign
from fddbench.errors import ResultsWarning, UntrustedError, warn
from fddbench.reporting.bands import names_in
from fddbench.reporting.page.columns import FAILED, NEEDS
from fddbench.reporting.page.data import ReportData
from fddbench.reporting.page.promises import lost_reference, promise_of
from fddbench.reporting.page.traces import MOST_SCENARIOS
from fddbench.reporting.published import iterations_for, published_for
from fddbench.reporting.reasons import reason_table
from fddbench.results.folder import provenance_of
from fddbench.results.kept import kept_of
from fddbench.results.schema import rows_schema
from fddbench.results.table import column_names, read_events, read_rows
from fddbench.results.whole import holdings
from fddbench.runner.assembling import assemble
from fddbench.runner.assembly import Assembly
from fddbench.runner.banded import bands_of
from fddbench.runner.fingerprint import frozen, other_program
from fddbench.runner.load import detector_load
from fddbench.runner.replay import replay_campaign, sampled_cases

__all__ = ["report_data"]

_OF_EVENTS = (
    *(
        "scenario",
        "event",
        "detector",
        "fault",
        "sites",
        "onset_s",
        "end_s",
        "run",
        "status",
        "outcome",
        "detection_time_s",
    ),
)
_SETTINGS = ("name", "about", "benchmark", "purpose", "seed", "sample_s", "substeps")
_AFTER_S, _LEAST_S = 3.0, 5.0
_NO_REPLAY = "Not drawn: nothing was flown again for this page (--no-replay)."


def report_data(folder: Path, *, replay: bool = True) -> ReportData:
    """Everything the page of a folder of results shows; without replay neither signals nor bands nor the bound.

    Of a folder whose plug-ins may not run here it is what rows and frozen texts tell, and why there is no more.

    Warns
    -----
    ResultsWarning
        Its plug-ins are not run.

    Raises
    ------
    FddbenchError
        No folder of results, or one that is damaged.
    """
    provenance = provenance_of(folder)
    try:
        campaign = frozen(folder)
    except UntrustedError as error:
        rows, events = read_rows(folder, _columns(folder), fair=True), read_events(folder, _OF_EVENTS, fair=True)
        page = rows_alone(folder, rows, events, provenance=_flat(provenance), why=f"{_WITHOUT_CODE}: {error}.")
        warn(f"{error}. Its page is written from the rows alone", ResultsWarning)
        return page
    return _with_code(folder, campaign, provenance, replay=replay)


_WITHOUT_CODE = "Not drawn, and neither requirements, operating curves, maps nor consequences are told"


def _with_code(folder: Path, campaign: Campaign, provenance: Mapping[str, Any], *, replay: bool) -> ReportData:
    """Page of a folder whose campaign can be built and flown."""
    found, kept = holdings(folder), kept_of(folder)
    content: dict[str, Any] = {name: getattr(campaign, name) for name in _SETTINGS} | dict(campaign.choices)
    content |= yaml.safe_load(campaign.text)
    assembly, bench = assemble(campaign), campaign.bench
    rows = read_rows(folder, _columns(folder), fair=True)
    return ReportData(
        campaign=content,
        rows=rows,
        events=read_events(folder, _OF_EVENTS, fair=True),
        provenance=_flat(provenance) | _replayed(folder, campaign),
        designs=_designs(campaign, assembly, provenance),
        **(_flown_again(campaign, rows, content) if replay else {"recordings": [], "unflown": _NO_REPLAY}),
        folder=folder.as_posix(),
        reasons=reason_table(campaign.name, campaign.sha256),
        published=published_for(content, getattr(bench, "published", "")),
        iterations=iterations_for(getattr(bench, "iterations", "")),
        envelope_axes=getattr(bench, "envelope_axes", ()),
        choices=tuple(campaign.choices),
        in_sample=campaign.in_sample,
        limits_from=bench.limits_from,
        partial=found.sentence if found.partial else "",
        kept=kept.first if kept else "",
        counted=overview(folder)[0] if kept else None,
        detectable=detectable_of(rows, campaign),
        consequences=assembly.consequences.announced,
        swept=swept_columns(rows, campaign),
        requirements=[asdict(each) for each in judgements(folder, campaign, rows)],
        operating=operating_of(rows, campaign),
    )


def _designs(campaign: Campaign, assembly: Assembly, provenance: Mapping[str, Any]) -> list[dict[str, Any]]:
    """What is said of each design."""
    return [
        {
            "name": d.name, "kind": d.kind.name, "source": d.source, "about": d.about, "sha256": d.sha256, "gamma": d.gamma,
            **_load(assembly, d.name), "in_c": provenance.get("load_in_c", {}).get(d.name),
            "sees": assembly.detectors[d.name].sees,
            "promise": promise_of(text := yaml.safe_load(d.text) or {}), "lost_reference": lost_reference(text),
        }
        for d in campaign.designs
    ]  # fmt: skip


def _load(assembly: Assembly, name: str) -> dict[str, Any]:
    """What a step of a detector costs, counted; or why it cannot be."""
    load = detector_load(assembly.detectors[name], assembly.loop.bus, timed=False)
    return {"cost": load.cost, "every": load.every, "opaque": load.opaque}


def _columns(folder: Path) -> list[str]:
    """Columns that the page reads: those of every row, parameters, sizes of faults, gains, and consequences."""
    scores = {field.name for field in rows_schema(())}
    return [name for name in column_names(folder) if name in NEEDS or name not in scores]


def _replayed(folder: Path, campaign: Campaign) -> dict[str, str]:
    """Line that says by which other program the pictures were flown."""
    other = other_program(folder, campaign)
    return {"signals flown again by another program": other} if other else {}


def _pictured(rows: pd.DataFrame, content: Mapping[str, Any]) -> pd.DataFrame:
    """Rows of the scenarios whose signals are shown: those that the campaign names, else those that go worst."""
    named = (content.get("report") or {}).get("scenarios") or _worst_scenarios(rows)
    return rows[np.asarray(rows["scenario"].isin(named), dtype=bool)]


def _worst_scenarios(rows: pd.DataFrame) -> list[str]:
    """So many scenarios as a page shows, those with the largest share of failed rows; in the order of the campaign."""
    failed = rows["outcome"].isin(list(FAILED)).astype("float64")
    shares = failed.groupby(rows["scenario"], sort=False).mean().sort_values(ascending=False, kind="stable")
    chosen = set(shares.index[:MOST_SCENARIOS])
    return [str(name) for name in rows["scenario"].unique() if name in chosen]


def _flown_again(campaign: Campaign, rows: pd.DataFrame, content: Mapping[str, Any]) -> dict[str, Any]:
    """Recordings, bands and the bound: what needs flights."""
    pictured = _pictured(rows, content)
    chosen = sampled_cases(pictured, seed=campaign.seed)
    recordings = replay_campaign(
        campaign, chosen, seconds=_seconds(rows), signals=campaign.shown, scenarios=list(chosen)
    )
    return {"recordings": list(recordings), "bounds": bounds_of(campaign)} | _bands(campaign, pictured, content)


def _bands(campaign: Campaign, rows: pd.DataFrame, content: Mapping[str, Any]) -> dict[str, Any]:
    """Bands of all flights, where the campaign asks for them, and what goes on their pictures."""
    shown, responses = campaign.shown, tuple(getattr(campaign.plant, "responses", ()))
    found: dict[str, Any] = {"responses": responses, "shown": shown}
    if (content.get("report") or {}).get("bands"):
        names = names_in(responses, shown)
        found["bands"] = list(bands_of(campaign, rows, signals=names, seconds=_seconds(rows)))
    return found


def _seconds(rows: pd.DataFrame) -> dict[str, float]:
    """By scenario, how long after the onset there is something to see: a little longer than the slowest detection."""
    slowest = rows.groupby("scenario")["detection_time_s"].max()
    times = slowest.to_numpy(dtype=float, na_value=np.nan)
    return {
        str(name): max(_LEAST_S, time_s + _AFTER_S) if np.isfinite(time_s) else _LEAST_S
        for name, time_s in zip(slowest.index, times, strict=True)
    }


def _flat(provenance: Mapping[str, object]) -> dict[str, str]:
    """Provenance as text, nested entries by dotted names; of the source its fingerprint is enough, loads have a table."""
    flat: dict[str, str] = {}
    for name, value in provenance.items():
        if isinstance(value, Mapping) and name == "flights":  # one a scenario: a line each would fill a sheet
            flat[name] = ", ".join(f"{scenario} {n}" for scenario, n in value.items())
        elif isinstance(value, Mapping) and name not in _NOT_FLAT:
            flat |= {f"{name}.{inner}": str(entry) for inner, entry in value.items()}
        elif name not in _NOT_FLAT:
            flat[name] = str(value)
    return flat


_NOT_FLAT = {"source", "load_in_c"}
