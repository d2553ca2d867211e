"""Gathers from a folder of results what its page shows; the signals are flown again from the frozen campaign."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from fddbench.reporting.page import ReportData
from fddbench.reporting.published import iterations_for, published_for
from fddbench.results.folder import provenance_of
from fddbench.results.table import load, load_events
from fddbench.runner.assembling import assemble
from fddbench.runner.load import detector_load, in_words
from fddbench.runner.replay import replay, sampled_cases
from fddbench.runner.work import frozen

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
    provenance, rows = provenance_of(folder), load(folder)
    campaign = frozen(folder, provenance["campaign_sha256"])
    content: dict[str, Any] = {name: getattr(campaign, name) for name in _SETTINGS} | dict(campaign.choices)
    content |= yaml.safe_load(campaign.text)
    assembly, bench = assemble(campaign), campaign.bench
    loads = {
        name: in_words(detector_load(detector, assembly.loop.bus, timed=False))
        for name, detector in assembly.detectors.items()
    }
    chosen = sampled_cases(rows, seed=campaign.seed)
    return ReportData(
        campaign=content,
        rows=rows,
        events=load_events(folder),
        provenance=_flat(provenance),
        designs=[
            {
                "name": d.name,
                "kind": d.kind.name,
                "source": d.source,
                "about": d.about,
                "sha256": d.sha256,
                "load": loads[d.name],
                "gamma": d.gamma,
            }
            for d in campaign.designs
        ],
        recordings=list(replay(folder, chosen, seconds=_seconds(rows), signals=bench.shown)),
        published=published_for(content, getattr(bench, "published", "")),
        iterations=iterations_for(getattr(bench, "iterations", "")),
        envelope_axes=getattr(bench, "envelope_axes", ()),
        choices=tuple(campaign.choices),
        in_sample=campaign.in_sample,
        limits_from=bench.limits_from,
    )


def _seconds(rows: pd.DataFrame) -> dict[str, float]:
    """By scenario, how long after the onset there is something to see: a little longer than the slowest detection."""
    slowest = rows.groupby("scenario")["detection_time_s"].max()
    times = slowest.to_numpy(dtype=float, na_value=np.nan)
    return {
        str(name): max(_LEAST_S, time_s + _AFTER_S) if np.isfinite(time_s) else _LEAST_S
        for name, time_s in zip(slowest.index, times, strict=True)
    }


def _flat(provenance: Mapping[str, object]) -> dict[str, str]:
    """Provenance as text, nested entries by dotted names."""
    flat: dict[str, str] = {}
    for name, value in provenance.items():
        if isinstance(value, Mapping):
            flat |= {f"{name}.{inner}": str(entry) for inner, entry in value.items()}
        else:
            flat[name] = str(value)
    return flat
