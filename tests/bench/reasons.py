"""Why the published scheme does not hold on the twin-jet: each reason switched off, on the same flights, as YAML.

``python -m tests.bench.reasons > reports/fes_monte_carlo/reasons.yaml``; a minute. The flights are those of the shipped
campaigns fes_turbulence and fes_maturation, with more runs.
"""

import sys
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from fddbench import gallery
from fddbench.campaign.load import read_campaign
from fddbench.metrics.shares import decided, share
from fddbench.results.table import load
from fddbench.runner.run import run_campaign

__all__ = ["main"]

PUBLISHED, NO_EQ38, EQ19 = "sliding_mode_published", "sliding_mode_without_eq38", "sliding_mode_equation_19"
HIGH_FLOOR = "floor_2_5_deg_s"
ONE_IN_TURN = tuple(f"{name}_a_in_turn_coordination_2" for name in ("oscill", "jam", "nrz", "noise"))
TWO_IN_YAW = tuple(
    f"{name}_in_yaw_angle_mode" for name in ("oscill_b", "jam_b", "runaway_a", "runaway_b", "nrz_b", "noise_b")
)
BOX = {"mass_kg": [180000, 220000], "x_cg_ratio": [0.27, 0.33], "altitude_ft": [15000, 25000], "v_cas_kt": [260, 300]}
_HEAD = """# Why the published scheme does not hold on transport_6dof: each reason switched off.
# Made by python -m tests.bench.reasons; not_right: decided flights that are wrong, late or missed; 95 % intervals by run.
"""


@dataclass(frozen=True, kw_only=True)
class Side:
    """Flights of one side of a comparison: in words, of which folder, by which detector, which of its rows."""

    what: str
    folder: str
    detector: str = PUBLISHED
    gust: float | None = None
    n_faulty: int


ONE, TWO = "one faulty sensor", "two faulty sensors"
LINES: tuple[tuple[str, str, Side, Side], ...] = (
    ("gusts", f"{ONE}, cruise", Side(what="light turbulence", folder="air", gust=0.25, n_faulty=1),
     Side(what="calm", folder="air", gust=0.0, n_faulty=1)),
    ("floor of 0.25 deg/s", f"{ONE}, cruise in light turbulence", Side(what="0.25 deg/s", folder="air", gust=0.25, n_faulty=1),
     Side(what="2.5 deg/s", folder="air", detector=HIGH_FLOOR, gust=0.25, n_faulty=1)),
    ("and what a higher floor costs", f"{TWO}, cruise in calm air", Side(what="0.25 deg/s", folder="air", gust=0.0, n_faulty=2),
     Side(what="2.5 deg/s", folder="air", detector=HIGH_FLOOR, gust=0.0, n_faulty=2)),
    ("eq (38)", f"{TWO}, rolling into yaw angle mode", Side(what="as published", folder="drawn", n_faulty=2),
     Side(what="without eq (38)", folder="drawn", detector=NO_EQ38, n_faulty=2)),
    ("eq (38) at low speed, where surfaces move more", f"{TWO}, rolling into yaw angle mode",
     Side(what="whole envelope", folder="drawn", n_faulty=2), Side(what="published box", folder="box", n_faulty=2)),
    ("and what eq (38) is for", f"{ONE}, in a turn of 33 deg", Side(what="as published", folder="drawn", n_faulty=1),
     Side(what="without eq (38)", folder="drawn", detector=NO_EQ38, n_faulty=1)),
    ("errors of mass, X_cg, altitude, airspeed", f"{ONE}, in a turn of 33 deg", Side(what="10 %", folder="drawn", n_faulty=1),
     Side(what="none", folder="known", n_faulty=1)),
    ("printed gain, -2 L instead of -L", f"{ONE}, in a turn of 33 deg", Side(what="as printed", folder="drawn", n_faulty=1),
     Side(what="as eq (19)", folder="drawn", detector=EQ19, n_faulty=1)),
    ("extrapolated rho, bare of eq (38) and errors", f"{ONE}, in a turn of 33 deg",
     Side(what="whole envelope", folder="nominal", detector=NO_EQ38, n_faulty=1),
     Side(what="published box", folder="nominal_box", detector=NO_EQ38, n_faulty=1)),
)  # fmt: skip


def main() -> None:
    """Fly everything and print the lines."""
    with tempfile.TemporaryDirectory() as name:
        rows = {folder: _ok(rows) for folder, rows in _flown(Path(name))}
    text = _HEAD
    sha = read_campaign(gallery.folder("campaigns") / "fes_monte_carlo.yaml").sha256
    text += f"campaign_sha256: {sha}\nlines:\n"
    for reason, flights, first, second in LINES:
        line = {
            "reason": reason,
            "flights": flights,
            "as_it_is": _share(rows, first),
            "otherwise": _share(rows, second),
        }
        text += f"  - {yaml.safe_dump(line, sort_keys=False, default_flow_style=True, width=10_000).strip()}\n"
    sys.stdout.write(text)


def _flown(folder: Path) -> Iterator[tuple[str, pd.DataFrame]]:
    """Rows of each set of flights by its name."""
    campaigns, detectors = gallery.folder("campaigns"), folder / "detectors"
    detectors.mkdir()
    design = yaml.safe_load((gallery.folder("detectors") / f"{PUBLISHED}.yaml").read_text(encoding="utf-8"))
    design["gains"]["threshold_floor_deg_s"] = 2.5
    (detectors / f"{HIGH_FLOOR}.yaml").write_text(yaml.safe_dump(design), encoding="utf-8")
    air = yaml.safe_load((campaigns / "fes_turbulence.yaml").read_text(encoding="utf-8"))
    air["detectors"] = [PUBLISHED, HIGH_FLOOR]
    air["dispersions"]["grid"]["gust_scale_ratio"] = [0.0, 0.25]
    air["dispersions"]["monte_carlo"]["runs"] = 100
    yield "air", _rows(folder, "air", air)
    drawn = yaml.safe_load((campaigns / "fes_maturation.yaml").read_text(encoding="utf-8"))
    drawn["scenarios"] = [of for of in drawn["scenarios"] if of["name"] in (*ONE_IN_TURN, *TWO_IN_YAW)]
    del drawn["report"]  # it names scenarios that are not flown here
    drawn["detectors"] = [PUBLISHED, NO_EQ38, EQ19]
    all_of = drawn["dispersions"]["monte_carlo"] | {"runs": 200}
    box = {name: {"uniform": ends} for name, ends in BOX.items()}
    known = {name: of for name, of in all_of.items() if "error" not in name}
    nominal = {name: of for name, of in known.items() if "delta" not in name}
    sets = {"drawn": all_of, "box": all_of | box, "known": known, "nominal": nominal, "nominal_box": nominal | box}
    for name, monte_carlo in sets.items():
        yield name, _rows(folder, name, drawn | {"dispersions": {"monte_carlo": monte_carlo}})


def _rows(folder: Path, name: str, content: Mapping[str, Any]) -> pd.DataFrame:
    path = folder / f"{name}.yaml"
    path.write_text(yaml.safe_dump(dict(content), sort_keys=False), encoding="utf-8")
    run_campaign(read_campaign(path), folder / f"rows_{name}", jobs=2)
    return load(folder / f"rows_{name}")


def _ok(rows: pd.DataFrame) -> pd.DataFrame:
    return rows[np.asarray((rows["status"] == "ok") & (rows["n_faulty"] > 0), dtype=bool)]


def _share(rows: Mapping[str, pd.DataFrame], side: Side) -> dict[str, Any]:
    """Counts of one side and the interval of its share."""
    own = rows[side.folder]
    own = own[np.asarray((own["detector"] == side.detector) & (own["n_faulty"] == side.n_faulty), dtype=bool)]
    if side.gust is not None:
        own = own[np.asarray(own["p_gust_scale_ratio"] == side.gust, dtype=bool)]
    own = own[decided(own)]
    outcome = np.asarray(own["outcome"], dtype=object)
    found = share("x", outcome != "right", own["run"])
    counts = {name: int(np.sum(outcome == name)) for name in ("wrong_site", "late", "missed")}
    ends = {f"{end}_percent": round(float(found[f"x_{end}_percent"] or 0.0), 2) for end in ("low", "high")}
    return {"what": side.what, "not_right": int(np.sum(outcome != "right")), "of": len(own)} | counts | ends


if __name__ == "__main__":
    main()
