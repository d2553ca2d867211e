"""Writes the report: one HTML file that needs nothing beside it and no network."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from fddbench.interfaces import Bands, Consequence, Recording, Response
from fddbench.metrics.alarms import summarize_alarms
from fddbench.metrics.bound import breaches, with_bounds
from fddbench.metrics.summary import summarize
from fddbench.reporting import detectability, failures, figures, headlines, infeasible, signals, tables
from fddbench.reporting.bands import band_pictures
from fddbench.reporting.beside import beside
from fddbench.reporting.bounds import HEADS, bound_lines
from fddbench.reporting.consequences import consequence_heads, consequence_lines
from fddbench.reporting.guarantees import guarantee_lines
from fddbench.reporting.published import Iterations, Published
from fddbench.reporting.reasons import REASONS

__all__ = ["ReportData", "page_html", "write_page"]

_MOST_REASONS = 60


@dataclass(frozen=True, kw_only=True)
class ReportData:
    """Everything that a page shows.

    Attributes
    ----------
    campaign : mapping
        Effective content of the campaign: name, about, seed, benchmark, what was chosen, purpose, sample_s, scenarios,
        detectors, and reconfigure where the aircraft acts on one of them.
    rows, events : DataFrame
        Tables as ``fddbench.load`` gives them.
    provenance : mapping of str to str
        Versions, machine, date, wall time, hashes: shown as it is.
    designs : sequence of mapping
        Per detector name, kind, source, about, load (of a step, in words), sees ("sensors" or "voted"), sha256.
    recordings : sequence of Recording
        Re-flown cases, one recording per scenario.
    published : sequence of Published
        Printed tables to stand beside ours.
    iterations : Iterations or None
        Printed course of an optimisation, and ours.
    limits_from : str
        Where the benchmark's detection time limits come from.
    choices : sequence of str
        Keys of what the campaign chose on the benchmark.
    envelope_axes : sequence of pairs of str
        Parameters that belong on the two axes of a picture of the envelope.
    in_sample : sequence of str
        Detectors that were tuned on these flights.
    partial : str
        How many flights of how many the folder holds, "" when all.
    detectable : DataFrame or None
        Maps of detectability, lines of `fddbench.metrics.detectable.DETECTABLE`.
    consequences : sequence of Consequence
        What the loop says of what faults do to the aircraft.
    bounds : DataFrame or None
        What the ideal test finds, lines of `fddbench.metrics.bound.BOUNDS`.
    bands : sequence of Bands
        All flights of scenarios as quantiles over time, where the campaign asks for them.
    responses, shown : sequences
        Panels of healthy flights, as the plant says, and signals of the others, as the benchmark does.
    folder : str
        The folder of results as a reader would write it.
    reasons : sequence of lines of cells
        What was found behind the failures of a shipped campaign.
    """

    campaign: Mapping[str, Any]
    rows: pd.DataFrame
    events: pd.DataFrame
    provenance: Mapping[str, str]
    designs: Sequence[Mapping[str, Any]]
    recordings: Sequence[Recording]
    published: Sequence[Published] = ()
    iterations: Iterations | None = None
    limits_from: str = ""
    choices: Sequence[str] = ()
    envelope_axes: Sequence[tuple[str, str]] = ()
    in_sample: Sequence[str] = ()
    partial: str = ""
    detectable: pd.DataFrame | None = None
    bounds: pd.DataFrame | None = None
    consequences: Sequence[Consequence] = ()
    bands: Sequence[Bands] = ()
    responses: Sequence[Response] = ()
    shown: Sequence[str] = ()
    folder: str = "results"
    reasons: Sequence[Sequence[tables.Cell]] = ()


def write_page(report: ReportData, output: Path) -> None:
    """Write the page of `report` to the file `output`; its folder is made."""
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(page_html(report), encoding="utf-8")


def page_html(report: ReportData) -> str:
    """Text of the page; the same bytes for the same report and the same versions of the libraries."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("fddbench.reporting"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    style, _, _ = environment.loader.get_source(environment, "style.css")  # type: ignore[union-attr]
    return environment.get_template("page.html.j2").render(style=style, **_content(report))


def _content(report: ReportData) -> dict[str, Any]:
    rows = report.rows
    summary = _with_sight(summarize(rows, in_sample=report.in_sample), report.designs)
    if report.bounds is not None:
        summary = with_bounds(summary, report.bounds)
    alarms = summarize_alarms(rows, in_sample=report.in_sample)
    compared = [found for table in report.published if (found := beside(summary, table)) is not None]
    reasons = tables.reason_lines(rows)
    return {
        "campaign": report.campaign,
        "settings": _settings(report.campaign, report.choices),
        "campaign_text": _as_yaml(report.campaign),
        "partial": report.partial,
        "flown": headlines.flown_sentence(rows),
        "findings": headlines.findings(rows, alarms, report.in_sample),
        "in_sample": report.in_sample,
        "result_heads": tables.RESULTS,
        "quality_heads": tables.QUALITY,
        "quality": tables.quality_lines(summary),
        "results": tables.result_lines(summary),
        "guarantees": guarantee_lines(rows, report.events, report.designs),
        "iterations": report.iterations,
        "limits_from": report.limits_from,
        **_bounds(summary, report.bounds),
        "consequence_heads": consequence_heads(report.consequences),
        "consequences": consequence_lines(rows, report.consequences),
        "compared": compared,
        "curves": figures.detection_curves(rows),
        "pictures": [p for r in report.recordings if r.cases for p in [_picture(r, rows)] if p["png"] is not None],
        **_detectability(report.detectable, alarms),
        "bands": band_pictures(report.bands, report.responses, report.shown),
        "failures": failures.failure_tables(rows, report.envelope_axes),
        "reason_heads": REASONS,
        "found_behind": report.reasons,
        "worst_heads": failures.WORST,
        "worst": failures.worst_lines(rows, report.envelope_axes, report.folder),
        "infeasible_map": infeasible.infeasible_map(rows, report.envelope_axes),
        "infeasible_heads": infeasible.INFEASIBLE,
        "infeasible": infeasible.infeasible_lines(rows, report.envelope_axes),
        "envelope": figures.envelope(rows, report.envelope_axes),
        "reasons": reasons[:_MOST_REASONS],
        "more_reasons": max(len(reasons) - _MOST_REASONS, 0),
        "events": tables.event_lines(report.events) if len(report.events) else [],
        "provenance": report.provenance,
        "designs": report.designs,
    }


def _with_sight(summary: pd.DataFrame, designs: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """A summary with what each detector sees, as its column ``sees``."""
    sight = {design["name"]: design.get("sees", "sensors") for design in designs}
    return summary.assign(sees=[sight.get(name, "sensors") for name in summary["detector"]])


def _bounds(summary: pd.DataFrame, stated: pd.DataFrame | None) -> dict[str, Any]:
    """What the ideal test finds, and the scores that are better than that; empty without a faulty scenario."""
    if stated is None or stated.empty:
        return {"bounds": [], "bound_heads": (), "breaches": []}
    return {"bounds": bound_lines(stated), "bound_heads": HEADS, "breaches": breaches(summary, stated)}


def _detectability(maps: pd.DataFrame | None, alarms: pd.DataFrame) -> dict[str, Any]:
    """Maps of detectability and their table; none where the benchmark asks for none."""
    if maps is None or maps.empty:
        return {"maps": [], "map_lines": [], "map_heads": ()}
    pictures = detectability.detectability_pictures(maps, alarms)
    lines = detectability.detectability_lines(maps, alarms)
    return {"maps": pictures, "map_lines": lines, "map_heads": detectability.MAP_HEADS}


def _settings(campaign: Mapping[str, Any], choices: Sequence[str]) -> dict[str, Any]:
    names = ("benchmark", *choices, "reconfigure", "purpose", "seed", "sample_s")
    return {name: campaign[name] for name in names if campaign.get(name) not in (None, "")}


def _picture(recording: Recording, rows: pd.DataFrame) -> dict[str, Any]:
    detectors = list(recording.detectors)
    worst = [recording.cases[signals.worst_case(recording, rows, name)] for name in detectors if recording.cases]
    here = rows[np.asarray(rows["scenario"] == recording.scenario, dtype=bool)]
    return {
        "scenario": recording.scenario,
        "onset_s": _onsets(recording),
        "shown": len(recording.cases),
        "cases": here["case"].nunique(),
        "worst": ", ".join(f"{name} {case}" for name, case in zip(detectors, worst, strict=False)),
        "png": signals.recording_picture(recording, rows),
    }


def _onsets(recording: Recording) -> str | None:
    """When the faults begin, in words; None in healthy flights."""
    if recording.onset_s is None:
        return None
    first, last = float(np.min(recording.onset_s)), float(np.max(recording.onset_s))
    return f"{first:g} s" if first == last else f"{first:g} to {last:g} s"


def _as_yaml(content: Mapping[str, Any]) -> str:
    import yaml

    return yaml.safe_dump(dict(content), sort_keys=False, allow_unicode=True, width=110, default_flow_style=None)
