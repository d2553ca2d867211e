"""Synthetic campaigns: what a run would hand to the report."""

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest

from fddbench.interfaces import Recording
from fddbench.reporting.page.data import ReportData
from fddbench.reporting.published import published
from fddbench.results.schema import EVENTS, rows_schema
from fddbench.results.table import named

FAULTS = {  # scenario: (faulty sites, limit s, median s, spread s)
    "oscill_a": (1, 120.0, 4.10, 0.10),
    "oscill_b": (2, 0.36, 0.10, 0.008),
    "jam_a": (1, 120.0, 1.00, 0.008),
    "jam_b": (2, 0.36, 0.10, 0.004),
    "runaway_a": (2, 1.5, 0.41, 0.01),
    "runaway_b": (2, 0.36, 0.12, 0.004),
    "nrz_a": (1, 120.0, 1.00, 0.004),
    "nrz_b": (2, 0.36, 0.10, 0.004),
    "noise_a": (1, 120.0, 1.02, 0.05),
    "noise_b": (2, 0.36, 0.12, 0.012),
}
AXES = (("v_cas_kt", "altitude_ft"), ("x_cg_ratio", "mass_kg"))
PARAMETERS = ("mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt", "delta_c_y_percent")
FAULTY_FIELDS = {  # scores of a faulty flight in which nothing was declared
    **{"outcome": "missed", "n_declared": 0, "isolated": False, "over_declared": False, "changes": 0, "watched": True},
}


def frame(rows, schema=None):
    """Arrow-backed pandas, as `fddbench.load` returns it."""
    table = pa.Table.from_pylist(rows, schema=schema or rows_schema(PARAMETERS))
    return named(table).to_pandas(types_mapper=pd.ArrowDtype)


def scores(scenario, detector, rng):
    """Scores of one flown flight."""
    if scenario not in FAULTS:
        quiet = {"n_faulty": 0, "flight_s": 60.0, "n_declared": 0, "outcome": "quiet"}
        return quiet | {"margin_healthy": rng.uniform(0.1, 0.8)}
    n, limit, median, spread = FAULTS[scenario]
    row = FAULTY_FIELDS | {"n_faulty": n, "onset_s": 2.0, "detection_time_limit_s": limit, "flight_s": 7.0 + limit}
    row |= {"faulty_sites": "r1" if n == 1 else "r1+r2", "margin_healthy": 0.4, "margin_faulty": 6.0}
    time_s = round(max(median + spread * rng.standard_normal(), 0.01), 2)
    wrong = {"outcome": "wrong_site", "wrong_site_time_s": time_s, "alarm_time_s": time_s, "changes": 1}
    if detector == "voting_monitor" and n == 2:
        return row | wrong | {"n_declared": 1, "declared_sites": "r3"}
    if scenario == "noise_a" and detector == "sliding_mode" and rng.random() < 0.04:
        return row | wrong | {"n_declared": 2, "declared_sites": "r1+r2", "over_declared": True}
    row |= {"detection_time_s": time_s, "alarm_time_s": time_s, "normalized_detection_time": time_s / limit}
    row |= {"outcome": "right" if time_s <= limit else "late", "isolated": True, "changes": 1}
    if detector == "sliding_mode" and n == 2:
        row |= {"estimate_bias": -0.04, "estimate_rms": 0.05}
    return row | {"n_declared": n, "declared_sites": row["faulty_sites"]}


def synthetic_rows(scenarios, detectors, flights, lost=None):
    """Rows of flights; `lost` maps a run number to (status, reason)."""
    rows = []
    for s, scenario in enumerate(scenarios):
        for run in range(flights):
            drawn = np.random.default_rng(run)
            box = ((180e3, 220e3), (0.27, 0.33), (15e3, 25e3), (260.0, 320.0))
            sizes = [drawn.uniform(low, high) for low, high in box]
            who = {"scenario": scenario, "manoeuvre": "cruise", "run": run, "status": "ok"}
            who |= {"point": 0, "level": 0}
            who |= {f"p_{name}": value for name, value in zip(PARAMETERS, (*sizes, 0.0), strict=True)}
            who["fault"] = scenario.partition("_")[0] if scenario in FAULTS else None
            for d, detector in enumerate(detectors):
                row = who | {"detector": detector} | scores(scenario, detector, np.random.default_rng((s, run, d)))
                if lost and run in lost:
                    status, reason = lost[run]
                    row = who | {"detector": detector, "n_faulty": row["n_faulty"], "status": status, "reason": reason}
                rows.append(row)
    return frame(rows)


def synthetic_recording(rows, scenario, detectors, n_cases=50):
    """Re-flown flights of a scenario, plausible to the eye."""
    cases = tuple(str(case) for case in rows[rows["scenario"] == scenario]["case"].unique()[:n_cases])
    n, _, median, spread = FAULTS.get(scenario, (0, None, np.inf, 0.0))
    rng = np.random.default_rng(1)
    time_s = np.arange(0.0, 12.0, 0.01)
    shape = (len(time_s), len(cases))
    on = (time_s >= 2.0)[:, None] & (n > 0)
    fault = np.where(
        on, (0.5 if n == 1 else 2.0) * (1.0 if "jam" in scenario else np.sin(3.0 * (time_s[:, None] - 2.0))), 0.0
    )
    sensors = {
        f"r_deg_s_{i + 1}": 0.2 * np.sin(time_s)[:, None] + 0.01 * rng.standard_normal(shape) + fault * (i < n)
        for i in range(3)
    }
    reconstruction = 0.03 * rng.standard_normal(shape) + (0.8 * fault if n == 2 else 0.0)
    at = 2.0 + median + spread * rng.standard_normal(len(cases)) if n else np.full(len(cases), np.inf)
    verdict = np.where(time_s[:, None] >= at, float(n), 0.0)
    full = {"residual": np.abs(reconstruction) / 0.25, "n_declared": verdict, "reconstruction_deg_s": reconstruction}
    full["threshold_deg_s"] = np.full(shape, 0.25)
    full["deviation_deg_s"] = np.abs(fault + 0.02 * rng.standard_normal(shape))
    plain = {
        "residual": np.abs(fault + 0.02 * rng.standard_normal(shape)) / 0.3,
        "n_declared": np.minimum(verdict, 1.0),
    }
    return Recording(
        scenario=scenario,
        cases=cases,
        time_s=time_s,
        onset_s=np.full(len(cases), 2.0) if n else None,
        signals={"v_y_m_s": np.zeros(shape), **sensors},
        detectors={name: full if name == "sliding_mode" else plain for name in detectors},
    )


def synthetic_report(
    scenarios=(*FAULTS, "healthy_cruise"), detectors=("sliding_mode", "voting_monitor"), flights=100, **changes
):
    """Report of a campaign; `changes` go to the fields of `ReportData`."""
    rows = synthetic_rows(scenarios, detectors, flights, changes.pop("lost", None))
    campaign = {"name": "demo", "about": "Which faults does each detector see, and how soon?", "benchmark": "yaw_rate"}
    campaign |= {"plant": "lateral_lpv", "voter": "median", "sensors": "white", "wind": "none", "purpose": "evaluation"}
    campaign |= {"seed": 20240611, "sample_s": 0.01, "scenarios": [{"name": name} for name in scenarios]}
    campaign |= {"detectors": list(detectors)}
    known = {
        "campaign": campaign,
        "rows": rows,
        "events": frame([], EVENTS),
        "provenance": {
            "fddbench": "0.1.0",
            "numpy": "2.4.6",
            "machine": "x86_64",
            "wall time": "94 s",
            "campaign": "9f" * 32,
        },
        "designs": [
            {"name": d, "kind": d, "source": "a paper", "about": "a design", "sha256": "ab" * 32} for d in detectors
        ],
        "recordings": [synthetic_recording(rows, name, detectors) for name in scenarios if flights],
        "published": (published("table8"),),
        "choices": ("plant", "voter", "sensors", "wind"),
        "envelope_axes": AXES,
    }
    return ReportData(**(known | changes))


@pytest.fixture
def make_report():
    return synthetic_report


@pytest.fixture
def make_rows():
    return synthetic_rows


@pytest.fixture
def make_events():
    return lambda events: frame(events, EVENTS)
