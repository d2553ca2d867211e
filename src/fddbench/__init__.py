"""Open Monte-Carlo benchmark campaigns for aerospace fault detection and diagnosis.

>>> import fddbench
>>> rows = fddbench.load("results/smoke")  # doctest: +SKIP
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fddbench.api.bounds import bounds
    from fddbench.api.campaigns import plan, read, run
    from fddbench.api.compacting import compact
    from fddbench.api.comparing import compare
    from fddbench.api.curves import operating_curve
    from fddbench.api.databases import duckdb
    from fddbench.api.datasets import dataset
    from fddbench.api.deciding import run_until_decided
    from fddbench.api.designs import tune
    from fddbench.api.detection_curves import pod
    from fddbench.api.exporting import export
    from fddbench.api.extending import extend
    from fddbench.api.findings import finding
    from fddbench.api.flights import score, signals
    from fddbench.api.merging import merge
    from fddbench.api.pages import report
    from fddbench.api.pictures import reconstruction_picture, tradeoff_picture
    from fddbench.api.replaying import table_of
    from fddbench.api.schemas import schema
    from fddbench.api.sharding import fly_shard, plan_shards, slurm_job
    from fddbench.api.summaries import summary
    from fddbench.api.tables import alarms, columns, detectable, load, load_events
    from fddbench.api.tradeoffs import tradeoff
    from fddbench.api.trusting import trust
    from fddbench.api.verifying import verify
    from fddbench.api.worst import worst

__all__ = [
    "__version__",
    "alarms",
    "bounds",
    "columns",
    "compact",
    "compare",
    "dataset",
    "detectable",
    "duckdb",
    "export",
    "extend",
    "finding",
    "fly_shard",
    "load",
    "load_events",
    "merge",
    "operating_curve",
    "plan",
    "plan_shards",
    "pod",
    "read",
    "reconstruction_picture",
    "report",
    "requirements",
    "run",
    "run_until_decided",
    "schema",
    "score",
    "signals",
    "slurm_job",
    "summary",
    "table_of",
    "tradeoff",
    "tradeoff_picture",
    "trust",
    "tune",
    "verify",
    "worst",
]
__version__ = "0.1.0"

_ROOMS = {
    **dict.fromkeys(("plan", "read", "run"), "campaigns"),
    **dict.fromkeys(("alarms", "columns", "detectable", "load", "load_events"), "tables"),
    **dict.fromkeys(("score", "signals"), "flights"),
    **dict.fromkeys(("reconstruction_picture", "tradeoff_picture"), "pictures"),
    **dict.fromkeys(("fly_shard", "plan_shards", "slurm_job"), "sharding"),
    "compact": "compacting",
    "compare": "comparing",
    "bounds": "bounds",
    "dataset": "datasets",
    "duckdb": "databases",
    "extend": "extending",
    "merge": "merging",
    "export": "exporting",
    "finding": "findings",
    "pod": "detection_curves",
    "schema": "schemas",
    "summary": "summaries",
    "report": "pages",
    "requirements": "requiring",
    "run_until_decided": "deciding",
    "table_of": "replaying",
    "tradeoff": "tradeoffs",
    "operating_curve": "curves",
    "trust": "trusting",
    "tune": "designs",
    "verify": "verifying",
    "worst": "worst",
}


def __getattr__(name: str) -> Any:
    """Functions of `fddbench.api`; what they stand on is heavy and is imported by those who ask."""
    if name not in _ROOMS:
        raise AttributeError(f"module 'fddbench' has no attribute {name!r}")
    return getattr(import_module(f"fddbench.api.{_ROOMS[name]}"), name)


def __dir__() -> list[str]:
    """All there is, imported or not."""
    return sorted({*globals(), *__all__})
