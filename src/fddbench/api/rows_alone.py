"""What the page shows of results whose code may not run here: their rows and frozen texts, and nothing that is flown again."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from fddbench.api.as_written import (
    benchmark_as_written,
    campaign_as_written,
    designs_as_written,
    in_sample_as_written,
    voted_as_written,
)
from fddbench.api.findings import swept_columns
from fddbench.api.tables import overview
from fddbench.campaign.rules.model import CampaignFile
from fddbench.reporting.page.data import ReportData
from fddbench.reporting.published import iterations_for, published_for
from fddbench.results.folder import provenance_of
from fddbench.results.kept import kept_of
from fddbench.results.whole import holdings

__all__ = ["rows_alone"]


_SETTINGS = ("about", "purpose", "sample_s")


def rows_alone(
    folder: Path, rows: pd.DataFrame, events: pd.DataFrame, *, provenance: Mapping[str, str], why: str
) -> ReportData:
    """Page of a folder whose plug-ins are not run.

    Parameters
    ----------
    folder : Path
        Folder of results.
    rows, events : DataFrame
        Its tables.
    provenance : mapping of str to str
        As the page shows it.
    why : str
        Said in the place of the pictures.

    Raises
    ------
    FddbenchError
        No folder of results, a damaged one, or frozen files that are no campaign and no designs.
    """
    written, bench, found = campaign_as_written(folder), benchmark_as_written(folder), holdings(folder)
    kept = kept_of(folder)
    content = {name: getattr(written, name) for name in _SETTINGS} | written.model_dump(mode="json", exclude_unset=True)
    return ReportData(
        campaign=content, rows=rows, events=events, provenance=provenance, designs=_designs(folder),
        recordings=[], unflown=why, folder=folder.as_posix(), in_sample=in_sample_as_written(folder),
        choices=tuple(name for name in content if name not in CampaignFile.model_fields),
        published=published_for(content, getattr(bench, "published", "")),
        iterations=iterations_for(getattr(bench, "iterations", "")),
        envelope_axes=getattr(bench, "envelope_axes", ()),
        limits_from=bench.limits_from if bench is not None else "",
        partial=found.sentence if found.partial else "",
        swept=swept_columns(rows, written),
        kept=kept.first if kept else "", counted=overview(folder)[0] if kept else None,
    )  # fmt: skip


def _designs(folder: Path) -> list[dict[str, Any]]:
    """What is said of each design by its file; what a step costs nobody knows who does not build it."""
    provenance, voted = provenance_of(folder), voted_as_written(folder)
    digests, measured = provenance["designs_sha256"], provenance.get("load_in_c", {})
    return [
        {
            "name": name, "kind": own.kind, "source": own.source, "about": own.about, "sha256": str(digests[name]),
            "gamma": own.gamma, "sees": "voted" if name in voted else "sensors", "in_c": measured.get(name),
        }
        for name, own in designs_as_written(folder).items()
    ]  # fmt: skip
