"""Flights of the yaw-rate benchmark as logs, and campaigns on logs."""

import numpy as np
import yaml

from fddbench.api import replaying
from fddbench.campaign.load import read_campaign
from fddbench.runner.assembling import assemble
from fddbench.runner.flight import Flyer
from fddbench.runner.rows import rows_and_events

SURFACES = [f"surface_deg_{j + 1}" for j in range(13)]
SINGLE = ("phi_deg", "beta_deg", "p_deg_s", "v_tas_m_s", "mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt")
MAPPED = {name: {"from": name} for name in SINGLE} | {
    "r_deg_s": {"from": ["r_deg_s_1", "r_deg_s_2", "r_deg_s_3"]},
    "r_voted_deg_s": {"from": "r_voted_deg_s"},
    "surface_deg": {"from": SURFACES},
}
SITES = [
    {
        "signal": "r_deg_s",
        "names": ["r1", "r2", "r3"],
        "admissible_deg_s": 40,
        "stops_deg_s": [-128, 128],
        "limits_s": [120, 0.36],
    }
]
BASE = {"seed": 5, "detectors": ["voting_monitor", "fixed_threshold", "coast"]}


def write(path, content):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")
    return path


def mapping(folder, logs, **more):
    """Mapping of logs of our flights, `logs` by name of the log its file."""
    named = logs if isinstance(logs, list) else [{"name": name, "file": file} for name, file in logs.items()]
    content = {"logs": named, "largest_gap_s": 0.02, "signals": MAPPED, "sites": SITES, **more}
    return write(folder / "logs.yaml", content)


def on_logs(folder, **content):
    """Campaign on the logs of a mapping."""
    base = {"name": "logged", "benchmark": "recorded", "logs": "logs.yaml", **BASE}
    return write(folder / "logged.yaml", {**base, **content})


def in_flight(folder, **content):
    """Campaign on the yaw-rate benchmark."""
    return write(folder / "flown.yaml", {"name": "flown", "benchmark": "yaw_rate", **BASE, **content})


def rows_of(path, backend="auto"):
    """Rows and events of a campaign."""
    assembly = assemble(read_campaign(path))
    flyer, cases = Flyer(assembly, backend), list(range(assembly.plan.n_cases))
    rows, events = rows_and_events(flyer, np.array(cases))
    return rows.to_pandas(), events.to_pandas()


def log(campaign, case, path):
    """Write a flight as a log."""
    replaying.write_table(replaying.replay(campaign, case), path)
    return path
