"""Contract: a row depends on campaign, seed and case number only."""

import hashlib
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from tests.runner.conftest import TEXT, write

from fddbench import load
from fddbench.campaign.load import read_campaign
from fddbench.results.table import load_events
from fddbench.runner.assembling import assemble
from fddbench.runner.flight import Flyer
from fddbench.runner.rows import rows_and_events
from fddbench.runner.run import run_campaign


def bits(frame: pd.DataFrame) -> str:
    """Fingerprint of every bit of a table, order included."""
    text = "\n".join(
        ",".join(value.hex() if isinstance(value, float) else str(value) for value in row)
        for row in frame.astype(object).itertuples(index=False)
    )
    return hashlib.sha256(text.encode()).hexdigest()


def flown(campaign, folder: Path, **options) -> tuple[pd.DataFrame, pd.DataFrame]:
    run_campaign(campaign, folder, **options)
    return load(folder), load_events(folder)


@pytest.fixture(scope="module")
def reference(everything, tmp_path_factory):
    return flown(everything, tmp_path_factory.mktemp("reference"), jobs=1)


@pytest.mark.parametrize(
    "options",
    [
        {"jobs": 2},
        {"jobs": 1, "chunk": 1},
        {"jobs": 2, "chunk": 7},
        {"jobs": 1, "chunk": 64},
        {"jobs": 2, "chunk": 1000},
        {"jobs": 1, "backend": "numpy"},
        {"jobs": 2, "backend": "numpy", "chunk": 9},
    ],
)
def test_jobs_and_chunks_change_no_bit(everything, reference, tmp_path, options):
    rows, events = flown(everything, tmp_path / "other", **options)
    assert bits(rows) == bits(reference[0])
    assert bits(events) == bits(reference[1])


def test_the_fixture_has_what_it_claims(reference):
    rows, events = reference
    assert {"ok", "infeasible"} <= set(rows["status"])
    assert {"right", "wrong_site", "missed"} <= set(rows["outcome"].dropna())
    assert rows["estimate_rms"].notna().any()
    assert len(events) == 2 * 2 * 8


def _rows(text: str, folder: Path) -> list[dict]:
    folder.mkdir()
    assembly = assemble(read_campaign(write(folder, text)))
    return rows_and_events(Flyer(assembly), np.arange(assembly.plan.n_cases))[0].to_pylist()


def _same(a: list[dict], b: list[dict]) -> bool:
    """Equal rows to the last bit, whatever their order."""

    def key(row):
        return row["scenario"], row["point"], row["level"], row["run"], row["detector"]

    return sorted(a, key=key) == sorted(b, key=key)


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    return _rows(TEXT, tmp_path_factory.mktemp("plain") / "x")


def test_other_detectors_change_no_row_of_a_detector(plain, tmp_path):
    for names in ("[voting_monitor, sliding_mode_published]", "[sliding_mode_published]", "[voting_monitor]"):
        other = _rows(TEXT.replace("[sliding_mode_published, voting_monitor]", names), tmp_path / names.strip("[]"))
        assert _same(other, [row for row in plain if row["detector"] in names])


def test_another_scenario_inserted_changes_no_other_row(plain, tmp_path):
    inserted = TEXT.replace("scenarios:\n", "scenarios:\n  - {name: new, manoeuvre: yaw_angle_mode, runs: 3}\n")
    other = _rows(inserted, tmp_path / "inserted")
    assert _same([row for row in other if row["scenario"] != "new"], plain)


def test_another_seed_changes_rows(plain, tmp_path):
    assert not _same(_rows(TEXT.replace("seed: 77", "seed: 78"), tmp_path / "seed"), plain)


def test_tuning_and_evaluation_share_no_flight(plain, tmp_path):
    other = _rows(TEXT.replace("seed: 77", "seed: 77\npurpose: tuning"), tmp_path / "tuning")
    assert not {row["p_mass_kg"] for row in other} & {row["p_mass_kg"] for row in plain}


def test_zero_size_faults_fly_as_healthy_flights_do(tmp_path):
    zero = (
        "  - {name: jam, manoeuvre: cruise, faults: [{kind: jam, sites: [r1, r2], onset_s: 1.0, amplitude_deg_s: 0}]}\n"
        "  - {name: run, manoeuvre: cruise, faults: [{kind: runaway, sites: [r1], onset_s: 1.0, rate_deg_s2: 0}]}\n"
        "  - {name: nrz, manoeuvre: cruise, faults: [{kind: nrz, sites: [r1], onset_s: 1.0, amplitude_deg_s: 0}]}\n"
        "  - {name: noisy, manoeuvre: cruise, faults: [{kind: noise, sites: [r1], onset_s: 1.0, variance_deg2_s2: 0}]}\n"
        "  - {name: sine, manoeuvre: cruise, faults: [{kind: oscillatory, sites: [r1], onset_s: 1.0, amplitude_deg_s: 0,"
        " frequency_hz: 1}]}\n"
    )
    head = TEXT[: TEXT.index("scenarios:")]
    (tmp_path / "zero").mkdir()
    text = head + "scenarios:\n  - {name: healthy, manoeuvre: cruise}\n" + zero
    assembly = assemble(read_campaign(write(tmp_path / "zero", text)))
    outcome = Flyer(assembly).fly(assembly.batch(np.arange(assembly.plan.n_cases)))
    for detector, score in outcome.scores.items():
        named = assembly.scoring.states.unpack(score)
        margins = np.maximum(named.margin_healthy, named.margin_faulty).reshape(6, -1)
        for other in margins[1:]:
            np.testing.assert_array_equal(other, margins[0], err_msg=detector)
