"""Scores of a campaign as a small text file, to keep under version control and to compare with a later run."""

from collections.abc import Mapping
from typing import Any

import pandas as pd
import yaml

from fddbench.metrics.summary import summarize

__all__ = ["scores", "scores_text"]

_COLUMNS = (
    "flights", "flown", "infeasible", "failed", "true_detection", "over_declared", "false_alarm", "missed", "censored",
    "isolated", "detections", "detection_time_median_s", "detection_time_p95_s", "detection_time_max_s",
    "margin_healthy_max",
)  # fmt: skip


def scores(rows: pd.DataFrame) -> list[dict[str, Any]]:
    """Counts and times by scenario and detector, plain Python values; nulls are left out."""
    found = []
    for line in summarize(rows).to_dict("records"):
        named = {name: _plain(line[name]) for name in ("scenario", "detector", *_COLUMNS)}
        found.append({name: value for name, value in named.items() if value is not None})
    return found


def scores_text(rows: pd.DataFrame, provenance: Mapping[str, object]) -> str:
    """YAML text: where the scores come from, then one line per scenario and detector."""
    kept = ("campaign", "campaign_sha256", "designs_sha256", "seed", "schema_version", "fddbench")
    head = yaml.safe_dump({"provenance": {name: provenance.get(name) for name in kept}}, sort_keys=False)
    lines = [
        yaml.safe_dump(line, sort_keys=False, default_flow_style=True, width=10_000).strip() for line in scores(rows)
    ]
    return f"{head}scores:\n" + "".join(f"  - {line}\n" for line in lines)


def _plain(value: Any) -> Any:
    """Python value of a cell: whole numbers as such, floats to nine digits; None for null."""
    if value is None or value is pd.NA:
        return None
    if isinstance(value, float):
        return round(value, 9)
    return value if isinstance(value, str) else int(value)
