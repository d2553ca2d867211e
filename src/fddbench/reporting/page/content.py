"""What stands in each section of the page."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pandas as pd

from fddbench.metrics.alarms import summarize_alarms
from fddbench.metrics.bound import breaches, with_bounds
from fddbench.metrics.summary import summarize
from fddbench.reporting import detectability, headlines, infeasible, tables
from fddbench.reporting.bands import band_sections
from fddbench.reporting.beside import Beside, beside
from fddbench.reporting.bounds import HEADS, bound_lines
from fddbench.reporting.consequences import consequence_heads, consequence_lines
from fddbench.reporting.guarantees import guarantee_lines
from fddbench.reporting.labels import OUTCOMES
from fddbench.reporting.loads import load_heads, load_lines, measured_by
from fddbench.reporting.page.alarms_said import Said
from fddbench.reporting.page.answer import answer
from fddbench.reporting.page.asked import asked, asks_of_what_varies
from fddbench.reporting.page.cells import Cell, cells
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.convergence import convergence_scene
from fddbench.reporting.page.counted import COUNTED_HEADS, counted_lines
from fddbench.reporting.page.courses import courses, found_at, loudest, worst_value
from fddbench.reporting.page.data import ReportData
from fddbench.reporting.page.envelope import envelope_maps, envelope_pairs, infeasible_map
from fddbench.reporting.page.led_by import of_envelope, of_points, of_print, of_quiet
from fddbench.reporting.page.matrix import matrix_lines
from fddbench.reporting.page.operating import operating_scenes
from fddbench.reporting.page.payload import payload
from fddbench.reporting.page.ranking import Rank, ranking, second_beside_best
from fddbench.reporting.page.ranks import rank_lines, silence
from fddbench.reporting.page.requirements import requirement_lines, requirement_sentence
from fddbench.reporting.page.traces import signal_sections
from fddbench.reporting.reasons import REASONS
from fddbench.reporting.references import bibliography

__all__ = ["content"]

_MOST_REASONS = 30


def content(report: ReportData) -> dict[str, Any]:
    """Everything that the template of the page fills in."""
    rows = report.rows
    columns = Columns(rows)
    summary = summarize(rows, in_sample=report.in_sample)
    if report.bounds is not None:
        summary = with_bounds(summary, report.bounds)
    alarms = summarize_alarms(rows, in_sample=report.in_sample)
    voted = {str(d["name"]) for d in report.designs if d.get("sees") == "voted"}
    ranks = ranking(columns, alarms, in_sample=report.in_sample, voted=voted)
    best = ranks[0].number if ranks and ranks[0].decided else None
    own = cells(columns, summary, best)
    compared = [found for table in report.published if (found := beside(summary, table, report.campaign)) is not None]
    return {
        **_head(report, ranks, columns, compared),
        "payload": payload(columns, own, report.folder),
        "ranks": rank_lines(ranks),
        "silence": silence(ranks),
        "best": ranks[0].detector if best is not None else "",
        "detectors": list(columns.detectors),
        "matrix": matrix_lines(columns, own),
        "outcomes": [(look, OUTCOMES[name]) for name, look in _LEGEND.items()],
        **_pictures(report, columns, ranks, alarms),
        **_more(report, summary, compared),
        "converging": [scene for line in ranks if (scene := convergence_scene(columns, line)) is not None],
        "references": bibliography(_methods(own.values()) | ({"monotone"} if _has_maps(report) else set())),
    }


def _has_maps(report: ReportData) -> bool:
    return report.detectable is not None and not report.detectable.empty


def _methods(own: Iterable[Cell]) -> set[str]:
    """Methods that the numbers of a page stand on."""
    found = {"share", "pooled", "rate", "colours"}
    for cell in own:
        told = {
            "incidence": cell.incidence,
            "association": cell.associations,
            "paired": cell.paired,
            "curve": cell.size is not None and cell.size.curve is not None,
        }
        found |= {name for name, what in told.items() if what}
    return found


_LEGEND = {"right": "o0", "late": "o1", "missed": "o3", "wrong_site": "o4", "false_alarm": "o5", "undecided": "o2"}


def _head(report: ReportData, ranks: Sequence[Rank], columns: Columns, compared: Sequence[Beside]) -> dict[str, Any]:
    """The first screen."""
    names = ("benchmark", *report.choices, "reconfigure", "purpose", "seed", "sample_s")
    return {
        "campaign": report.campaign,
        "settings": {n: report.campaign[n] for n in names if report.campaign.get(n) not in (None, "")},
        "partial": report.partial,
        "kept": report.kept,
        "counted": counted_lines(report.counted),
        "counted_heads": COUNTED_HEADS,
        "flown": headlines.flown_sentence(report.rows),
        "answer": _answer(report, ranks, columns, compared),
        "in_sample": report.in_sample,
        "requirements": requirement_lines(report.requirements),
        "required": requirement_sentence(report.requirements),
    }


def _answer(report: ReportData, ranks: Sequence[Rank], columns: Columns, compared: Sequence[Beside]) -> Said:
    """What the campaign asks comes first, then which detector, where it fails, how sure that is."""
    about = " ".join(str(report.campaign.get("about") or "").split())
    drawn, loud = [each.scenario for each in report.recordings if each.cases], loudest(columns, ranks)
    varied = (report.campaign.get("dispersions") or {}).get("sequence") or {}
    first = asked(
        about, report.rows, report.consequences, drawn, commander=str(report.campaign.get("reconfigure") or "")
    )
    first += of_quiet(about, loud, healthy=bool((columns.ok & ~columns.faulty).any()))
    first += of_points(about, columns, [f"p_{name}" for name in varied if f"p_{name}" in report.rows])
    best = ranks[0].number if ranks and ranks[0].decided else None
    first += of_envelope(about, columns, report.envelope_axes, report.swept, best)
    first += of_print(about, compared, ranks[0].detector if ranks else "")
    first += worst_value(about, columns, report.swept, ranks)
    where = found_at(about, columns, report.swept, ranks)
    second = second_beside_best(columns, ranks)
    along = report.operating is None and asks_of_what_varies(about)
    course = [] if where else courses(columns, report.swept)
    return first + where + answer(ranks, second, courses=course, loudest=loud, along_first=along)


_MOST_MAPS = 6
"""Maps of the envelope that are drawn, of the best detectors."""


def _pictures(report: ReportData, columns: Columns, ranks: Sequence[Rank], alarms: pd.DataFrame) -> dict[str, Any]:
    """What is drawn below the matrix."""
    pairs = envelope_pairs(columns, report.envelope_axes, report.swept)
    most = _MOST_MAPS // max(len(pairs), 1)
    chosen = [line.number for line in ranks[:most]]
    maps = [scene for x, y in pairs if (scene := infeasible_map(columns, x, y)) is not None]
    promises = {str(d["name"]): d["promise"] for d in report.designs if d.get("promise") is not None}
    own = report.detectable if _has_maps(report) else None
    return {
        "folder": report.folder,
        "operating": operating_scenes(report.operating) if report.operating is not None else [],
        "envelopes": envelope_maps(columns, pairs, chosen),
        "more_detectors": max(len(ranks) - most, 0),
        "infeasible_maps": maps,
        "infeasible_heads": infeasible.INFEASIBLE,
        "infeasible": infeasible.infeasible_lines(report.rows, report.envelope_axes),
        "maps": detectability.detectability_scenes(own, alarms) if own is not None else [],
        "map_lines": detectability.detectability_lines(own, alarms) if own is not None else [],
        "map_heads": detectability.MAP_HEADS,
        "bands": band_sections(report.bands, report.responses, report.shown),
        "signals": signal_sections(report.recordings, report.rows, [line.detector for line in ranks], promises),
        "promised": bool(promises),
        "unpromised": [str(d["name"]) for d in report.designs if d.get("lost_reference")],
        "unflown": report.unflown,
    }


def _more(report: ReportData, summary: pd.DataFrame, compared: Sequence[Beside]) -> dict[str, Any]:
    """What is folded away."""
    rows = report.rows
    reasons = tables.reason_lines(rows)
    return {
        "compared": compared,
        "guarantees": guarantee_lines(rows, report.events, report.designs),
        "iterations": report.iterations,
        "limits_from": report.limits_from,
        **_bounds(summary, report.bounds),
        "consequence_heads": consequence_heads(report.consequences),
        "consequences": consequence_lines(rows, report.consequences),
        "reason_heads": REASONS,
        "found_behind": report.reasons,
        "reasons": reasons[:_MOST_REASONS],
        "more_reasons": max(len(reasons) - _MOST_REASONS, 0),
        "events": tables.event_lines(report.events) if len(report.events) else [],
        "provenance": report.provenance,
        "designs": report.designs,
        "loads": load_lines(report.designs),
        "load_heads": load_heads(report.designs),
        "load_by": measured_by(report.designs),
        "campaign_text": _as_yaml(report.campaign),
    }


def _bounds(summary: pd.DataFrame, stated: pd.DataFrame | None) -> dict[str, Any]:
    """What the ideal test finds, and the scores that are better than that; where no scenario has a bound, why."""
    found: dict[str, Any] = {"bounds": [], "bound_heads": HEADS, "unbounded": [], "breaches": []}
    if stated is None or stated.empty:
        return found
    if stated["model"].isna().all():
        return found | {"unbounded": list(stated["about"].unique())}
    return found | {"bounds": bound_lines(stated), "breaches": breaches(summary, stated)}


def _as_yaml(content: Mapping[str, Any]) -> str:
    import yaml

    return yaml.safe_dump(dict(content), sort_keys=False, allow_unicode=True, width=110, default_flow_style=None)
