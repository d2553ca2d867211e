"""The bound of each scenario under each model as a table: how often the ideal test finds its faults."""

from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa

from fddbench.interfaces import Floats
from fddbench.metrics.bound.ideal_test import MOST_D
from fddbench.metrics.bound.power import power
from fddbench.metrics.shares import column

__all__ = ["BOUNDS", "bound_line", "bounds_table"]

BOUNDS = pa.schema(
    [
        column("scenario", pa.string(), "name of the scenario"),
        column("model", pa.string(), "what the ideal test supposes, by name; null: no bound is stated"),
        column("about", pa.string(), "the same in words, or why no bound is stated"),
        column("p_fa", pa.float64(), "probability of a false alarm of its one decision [-]"),
        column("window_s", pa.float64(), "time that it may use, from the first faulty sample [s]: the limit of the scenario"),
        column("flights", pa.int64(), "flights whose faults were looked at"),
        column("d", pa.float64(), f"median distance from health or mirrored fault, the nearer one [-]; at most {MOST_D:g}"),
        column("d_least", pa.float64(), "smallest of these flights [-]"),
        column("p_d", pa.float64(), "mean probability that the faulty sites are found [-]: the bound of right flights"),
        column("d_health", pa.float64(), "median distance from health alone [-]"),
        column("p_detect", pa.float64(), "mean probability that an alarm is raised [-]: for detectors that only detect"),
    ]
)  # fmt: skip


def bound_line(d_health: Floats, d: Floats, p_fa: float) -> dict[str, Any]:
    """Columns of a scenario under a model, of the distances of its flights, (n_cases,) each."""
    return {
        "p_fa": p_fa,
        "flights": len(d),
        "d": float(np.median(d)),
        "d_least": float(d.min()),
        "p_d": float(power(d, p_fa).mean()),
        "d_health": float(np.median(d_health)),
        "p_detect": float(power(d_health, p_fa).mean()),
    }


def bounds_table(lines: list[dict[str, Any]]) -> pd.DataFrame:
    """Table of `BOUNDS` columns, Arrow-backed."""
    found: pd.DataFrame = pa.Table.from_pylist(lines, schema=BOUNDS).to_pandas(types_mapper=pd.ArrowDtype)
    return found
