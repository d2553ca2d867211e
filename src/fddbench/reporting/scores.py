"""Scores of a campaign as a small text file, to keep under version control and to compare with a later run."""

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd
import yaml

__all__ = ["detectable", "false_alarms", "scores", "scores_text"]

_COLUMNS = (
    "in_sample", "pools", "flights", "flown", "infeasible", "failed", "departed", "wrong_site", "right", "late", "missed",
    "undecided", "false_alarm", "quiet", "isolated", "over_declared", "detections", "detection_time_median_s",
    "detection_time_p95_s", "detection_time_max_s", "changes_max", "estimate_bias_median", "estimate_rms_median",
    "margin_healthy_max",
)  # fmt: skip
_DETECTABLE = (
    "scenario", "detector", "site", "size", "times", "flights", "found", "smallest", "relation", "large", "large_found_percent",
    "large_found_low_percent", "large_found_high_percent",
)  # fmt: skip
_ALARMS = ("detector", "in_sample", "pools", "distinct_flights", "alarms", "exposure_h")


def scores(summary: pd.DataFrame) -> list[dict[str, Any]]:
    """Counts and times by scenario and detector, plain Python values; nulls are left out, and what is not in sample."""
    return _lines(summary, ("scenario", "detector", *_COLUMNS))


def false_alarms(alarms: pd.DataFrame) -> list[dict[str, Any]]:
    """False alarms of distinct flights by detector, and the hours in which they were watched."""
    return _lines(alarms, _ALARMS)


def _lines(table: pd.DataFrame, columns: Sequence[str]) -> list[dict[str, Any]]:
    found = []
    for line in table.to_dict("records"):
        named = {name: _plain(line[name]) for name in columns}
        found.append({name: value for name, value in named.items() if value is not None and value is not False})
    return found


def detectable(maps: pd.DataFrame) -> list[dict[str, Any]]:
    """Smallest faults found over the whole envelope, by map, scenario and detector."""
    return _lines(maps[maps["x_low"].isna().to_numpy(dtype=bool)], _DETECTABLE)


def scores_text(
    summary: pd.DataFrame,
    alarms: pd.DataFrame,
    provenance: Mapping[str, object],
    maps: pd.DataFrame | None = None,
) -> str:
    """YAML text: where the scores come from, one line per scenario and detector, and one per detector of false alarms.

    `summary` and `alarms` are lines of `fddbench.metrics.summary.SUMMARY` and of `fddbench.metrics.alarms.ALARMS`. With `maps`,
    lines of `fddbench.metrics.detectable.DETECTABLE`, the smallest faults found stand below.
    """
    kept = ("campaign", "campaign_sha256", "designs_sha256", "seed", "schema_version", "fddbench")
    said = {name: provenance.get(name) for name in kept} | {k: provenance[k] for k in ("kept",) if k in provenance}
    head = yaml.safe_dump({"provenance": said}, sort_keys=False)
    parts = {"scores": scores(summary), "false_alarms": false_alarms(alarms)}
    if maps is not None and not maps.empty:
        parts["detectable"] = detectable(maps)
    return head + "".join(f"{name}:\n{''.join(map(_as_line, lines))}" for name, lines in parts.items())


def _as_line(line: Mapping[str, Any]) -> str:
    text = yaml.safe_dump(dict(line), sort_keys=False, default_flow_style=True, width=10_000).strip()
    return f"  - {text}\n"


def _plain(value: Any) -> Any:
    """Python value of a cell: whole numbers as such, floats to nine digits; None for null."""
    if value is None or value is pd.NA:
        return None
    if isinstance(value, float):
        return round(value, 9)
    return value if isinstance(value, str | bool) else int(value)
