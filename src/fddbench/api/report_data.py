"""Gathers from a folder of results what its page shows; the signals are flown again from the frozen campaign."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from fddbench.api.bounds import bounds_of
from fddbench.api.detectability import detectable_of
from fddbench.campaign.meaning import Campaign
from fddbench.reporting.bands import names_in
from fddbench.reporting.page import ReportData
from fddbench.reporting.published import iterations_for, published_for
from fddbench.reporting.reasons import reason_table
from fddbench.results.folder import provenance_of
from fddbench.results.table import read_events, read_rows
from fddbench.results.whole import holdings
from fddbench.runner.assembling import assemble
from fddbench.runner.banded import bands_of
from fddbench.runner.fingerprint import frozen, other_program
from fddbench.runner.load import detector_load, in_words
from fddbench.runner.replay import replay_campaign, sampled_cases

__all__ = ["report_data"]

_SETTINGS = ("name", "about", "benchmark", "purpose", "seed", "sample_s", "substeps")
_AFTER_S, _LEAST_S = 3.0, 5.0


def report_data(folder: Path) -> ReportData:
    """Everything the page of a folder of results shows.

    Raises
    ------
    FddbenchError
        No folder of results, or one that is damaged.
    """
    provenance, rows, found = provenance_of(folder), read_rows(folder), holdings(folder)
    campaign = frozen(folder)
    content: dict[str, Any] = {name: getattr(campaign, name) for name in _SETTINGS} | dict(campaign.choices)
    content |= yaml.safe_load(campaign.text)
    assembly, bench, shown = assemble(campaign), campaign.bench, campaign.shown
    loads = {
        name: in_words(detector_load(detector, assembly.loop.bus, timed=False))
        for name, detector in assembly.detectors.items()
    }
    pictured = _pictured(rows, content)
    chosen = sampled_cases(pictured, seed=campaign.seed)
    return ReportData(
        campaign=content,
        rows=rows,
        events=read_events(folder),
        provenance=_flat(provenance) | _replayed(folder, campaign),
        designs=[
            {
                "name": d.name,
                "kind": d.kind.name,
                "source": d.source,
                "about": d.about,
                "sha256": d.sha256,
                "load": loads[d.name],
                "sees": assembly.detectors[d.name].sees,
                "gamma": d.gamma,
            }
            for d in campaign.designs
        ],
        recordings=list(
            replay_campaign(
                campaign,
                chosen,
                seconds=_seconds(rows),
                signals=shown,
                scenarios=list(pictured["scenario"].unique()),
            )
        ),
        **_bands(campaign, pictured, content),
        folder=folder.as_posix(),
        reasons=reason_table(campaign.name, campaign.sha256),
        published=published_for(content, getattr(bench, "published", "")),
        iterations=iterations_for(getattr(bench, "iterations", "")),
        envelope_axes=getattr(bench, "envelope_axes", ()),
        choices=tuple(campaign.choices),
        in_sample=campaign.in_sample,
        limits_from=bench.limits_from,
        partial=found.sentence if found.partial else "",
        detectable=detectable_of(rows, campaign),
        bounds=bounds_of(campaign),
        consequences=assembly.consequences.announced,
    )


def _replayed(folder: Path, campaign: Campaign) -> dict[str, str]:
    """Line that says by which other program the pictures were flown."""
    other = other_program(folder, campaign)
    return {"signals flown again by another program": other} if other else {}


def _pictured(rows: pd.DataFrame, content: Mapping[str, Any]) -> pd.DataFrame:
    """Rows of the scenarios whose signals are shown."""
    named = (content.get("report") or {}).get("scenarios")
    return rows[np.asarray(rows["scenario"].isin(named), dtype=bool)] if named else rows


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
    """Provenance as text, nested entries by dotted names; of the source its fingerprint is enough."""
    flat: dict[str, str] = {}
    for name, value in provenance.items():
        if isinstance(value, Mapping) and name != "source":
            flat |= {f"{name}.{inner}": str(entry) for inner, entry in value.items()}
        elif name != "source":
            flat[name] = str(value)
    return flat
