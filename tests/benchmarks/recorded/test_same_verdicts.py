"""Law: on the log of a flight detectors decide as they did in flight."""

import pandas as pd
import pytest
from tests.benchmarks.recorded import logging

from fddbench import gallery
from fddbench.campaign.load import read_campaign
from fddbench.designs.design import read_design
from fddbench.errors import FddbenchError
from fddbench.runner.assembling import assemble

JAM = {"kind": "jam", "sites": ["r2"], "onset_s": 1.0, "amplitude_deg_s": 2.0}
NOISE = {"kind": "noise", "sites": ["r1"], "onset_s": 0.5, "end_s": 2.5, "variance_deg2_s2": 9.0}
SCENARIOS = [
    {"name": "healthy", "manoeuvre": "turn_coordination_1", "duration_s": 4.0},
    {"name": "jam", "manoeuvre": "cruise", "faults": [JAM], "duration_s": 4.0},
    {"name": "two", "manoeuvre": "cruise", "faults": [NOISE, {**JAM, "sites": ["r3"]}], "duration_s": 3.0},
]
LABELS = "log,sites,onset_s,end_s\njam,r2,1.0,\ntwo,r1,0.5,2.5\ntwo,r3,1.0,\n"
# nobody knows what a fault that is in a log adds, so no estimate is scored
NOT_OF_THE_VERDICT = ("scenario", "manoeuvre", "fault", "point", "level", "run", "estimate_bias", "estimate_rms")


def recorded(folder, ending, **content):
    """Rows in flight and rows on its logs, scenario by scenario and log by log."""
    flown = logging.in_flight(folder, scenarios=SCENARIOS, **content)
    for entry in SCENARIOS:
        logging.log(flown, f"{entry['name']}/0/0/0", folder / f"{entry['name']}{ending}")
    (folder / "labels.csv").write_text(LABELS, encoding="utf-8")
    logging.mapping(folder, {e["name"]: f"{e['name']}{ending}" for e in SCENARIOS}, faults="labels.csv")
    logged = logging.on_logs(
        folder,
        scenarios=[{"name": "as_recorded", "manoeuvre": "recorded"}],
        dispersions={"grid": {"log": [1, 2, 3]}},
        **content,
    )
    return flown, logged


def same(flown, logged, **options):
    (ours, events), (theirs, their_events) = logging.rows_of(logged, **options), logging.rows_of(flown)
    dropped = [name for name in theirs.columns if name in NOT_OF_THE_VERDICT or name.startswith(("p_", "c_"))]
    kept = [name for name in theirs.columns if name not in dropped and name in ours.columns]
    pd.testing.assert_frame_equal(ours[kept], theirs[kept])
    assert set(ours["status"]) == {"ok"}
    assert ours["declared_sites"].notna().any()
    assert ours["fault"].tolist()[-1] == "in_log+in_log"
    two = their_events[their_events["scenario"] == "two"]
    shared = ["detector", "sites", "onset_s", "end_s", "outcome", "detection_time_s", "detection_time_limit_s"]
    mine = events[events["point"] == 2]
    pd.testing.assert_frame_equal(
        mine[shared].sort_values(shared[:2]).reset_index(drop=True),
        two[shared].sort_values(shared[:2]).reset_index(drop=True),
    )


@pytest.mark.parametrize(("ending", "backend"), [(".csv", "auto"), (".parquet", "numpy")])
def test_rows_of_a_log_are_those_of_its_flight(tmp_path, ending, backend):
    same(*recorded(tmp_path, ending), backend=backend)


def fitting(bus):
    """A design of every kind that can be built for a bus."""
    found = {}
    for path in sorted(gallery.folder("detectors").glob("*.yaml")):
        try:
            design = read_design(path)
            design.build(bus)
        except FddbenchError:
            continue
        found.setdefault(design.kind.name, path.stem)
    return found


@pytest.mark.slow
def test_every_kind_of_detector_decides_on_a_log_as_in_flight(tmp_path):
    flown, _ = recorded(tmp_path, ".parquet")
    kinds = fitting(assemble(read_campaign(flown)).loop.bus)
    assert len(kinds) > 12
    same(*recorded(tmp_path, ".parquet", detectors=sorted(kinds.values())))


def test_a_fault_injected_into_a_healthy_log_is_that_in_flight_where_no_loop_answers(tmp_path):
    # the law flies on the median: a first small fault of one sensor moves it, so the fault comes at the last sample but few
    healthy = {"name": "f", "manoeuvre": "cruise", "duration_s": 2.0}
    jam = {**JAM, "onset_s": 1.95, "amplitude_deg_s": {"uniform": [1.0, 9.0]}}
    flown = logging.in_flight(tmp_path, scenarios=[healthy])
    logging.log(flown, "f/0/0/0", tmp_path / "f.csv")
    logging.mapping(tmp_path, {"f": "f.csv"}, signals={**logging.MAPPED, "r_voted_deg_s": {"vote": "r_deg_s"}})
    scenario = {"name": "f", "faults": [jam], "duration_s": 2.0, "detection_time_limit_s": 0.05}
    logged = logging.on_logs(tmp_path, scenarios=[{**scenario, "manoeuvre": "recorded"}])
    flown = logging.in_flight(tmp_path, scenarios=[{**scenario, "manoeuvre": "cruise"}])
    (ours, _), (theirs, _) = logging.rows_of(logged), logging.rows_of(flown)
    kept = ["f1_amplitude_deg_s", "outcome", "alarm_time_s", "margin_healthy", "declared_sites"]
    pd.testing.assert_frame_equal(ours[kept], theirs[kept])
    assert (ours["margin_faulty"] > 1.0).all()
