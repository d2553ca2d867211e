"""Large tables at once: what many flights of many scenarios leave behind, without flying them."""

import numpy as np
import pandas as pd
import pyarrow as pa

from fddbench.blocks.accounting import Cost
from fddbench.results.schema import rows_schema
from fddbench.results.table import named

PARAMETERS = {
    "mass_kg": (18e4, 22e4),
    "x_cg_ratio": (0.27, 0.33),
    "altitude_ft": (15e3, 25e3),
    "v_cas_kt": (260.0, 320.0),
}
_OUTCOMES = ("right", "late", "missed", "wrong_site", "undecided", "false_alarm")


def many_designs(detectors):
    """Designs of these rows, flown as exported C: their texts as long as those of shipped ones are on average."""
    counted = {"mul": 5210, "add": 4820, "div": 48, "sqrt": 16, "sin": 12, "exp": 4}
    cost = Cost(
        operations=counted, flops=12_345, multiply_adds=4_096, state_bytes=1_384, table_bytes=21_392, by_block={}
    )
    by = "gcc (Debian 12.2.0-14+deb12u1) 12.2.0, -std=c99 -O2 -ffp-contract=off -fno-tree-slp-vectorize"
    measured = {
        "code_bytes": 111_340,
        "table_bytes": 21_392,
        "state_bytes": 1_384,
        "stack_bytes": 2_208,
        "ticks": 16_652,
    }
    return [
        {
            "name": f"detector_of_some_length_{i}", "kind": "kind_of_it", "about": "a word " * 13, "source": "a word " * 20,
            "sha256": f"{i:02}" * 32, "cost": cost, "every": 4, "opaque": "", "in_c": measured | {"by": by},
        }
        for i in range(detectors)
    ]  # fmt: skip


def many_rows(detectors, scenarios, runs, seed=3):
    """Rows of so many detectors, scenarios (the first healthy) and runs; every outcome happens in every faulty cell."""
    rng = np.random.default_rng(seed)
    names = np.array([each["name"] for each in many_designs(detectors)])
    s, run, d = (each.ravel() for each in np.meshgrid(*map(np.arange, (scenarios, runs, detectors)), indexing="ij"))
    n, faulty = len(s), s > 0
    kind = rng.choice(6, n, p=[0.7, 0.08, 0.08, 0.08, 0.03, 0.03])
    outcome = np.where(faulty, np.array(_OUTCOMES)[kind], np.where(kind == 5, "false_alarm", "quiet"))
    time_s = np.round(rng.gamma(2.0, 0.4, n) + 0.05, 2)
    found = faulty & np.isin(outcome, ["right", "late"])
    drawn = {name: rng.uniform(*ends, runs) for name, ends in PARAMETERS.items()}
    columns = {
        "scenario": np.array([f"scenario_with_a_name_{i}" for i in range(scenarios)])[s],
        "manoeuvre": np.full(n, "cruise"),
        "run": run,
        "point": np.zeros(n, dtype=np.int64),
        "level": np.zeros(n, dtype=np.int64),
        "detector": names[d],
        "status": np.full(n, "ok"),
        "flight_s": np.full(n, 60.0),
        "outcome": outcome,
        "n_faulty": faulty.astype(np.int64),
        "faulty_sites": np.where(faulty, "r1", None),
        "onset_s": np.where(faulty, 5.0, np.nan),
        "declared_sites": np.where(found, "r1", np.where(outcome == "wrong_site", "r2+r3", None)),
        "detection_time_s": np.where(found, time_s, np.nan),
        "wrong_site_time_s": np.where(outcome == "wrong_site", time_s, np.nan),
        "false_alarm_time_s": np.where(outcome == "false_alarm", 1.0, np.nan),
        "detection_time_limit_s": np.where(faulty, 2.0, np.nan),
        "normalized_detection_time": np.where(found, time_s / 2.0, np.nan),
        "changes": np.where(faulty, 1.0, np.nan),
        "margin_healthy": rng.uniform(0.1, 0.8, n),
        **{f"p_{name}": values[run] for name, values in drawn.items()},
    }
    schema = rows_schema(tuple(PARAMETERS))
    arrays = [_column(columns, field, n) for field in schema]
    return named(pa.table(arrays, schema=schema)).to_pandas(types_mapper=pd.ArrowDtype)


def _column(columns, field, n):
    if field.name not in columns:
        return pa.nulls(n, field.type)
    return pa.array(columns[field.name], from_pandas=True).cast(field.type)
