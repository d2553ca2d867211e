"""The second benchmark through the runner: same bits compiled or not, alone or together; overlapping faults as events."""

import numpy as np
import pytest

from fddbench import gallery
from fddbench.benchmarks.jet_engine.benchmark import JetEngine
from fddbench.blocks import llvm
from fddbench.blocks.layout import leaves
from fddbench.campaign.load import read_campaign
from fddbench.reporting.published import iterations_for
from fddbench.results.table import load, load_events
from fddbench.runner.assembling import assemble
from fddbench.runner.flight import Flyer
from fddbench.runner.run import run_campaign


@pytest.fixture(scope="module")
def campaign():
    path = gallery.folder("campaigns") / "jet_engine_monte_carlo.yaml"
    return read_campaign(path, ["dispersions.monte_carlo.runs=6"])


@pytest.fixture(scope="module")
def folder(campaign, tmp_path_factory):
    folder = tmp_path_factory.mktemp("results") / "jet"
    assert run_campaign(campaign, folder, jobs=1).failed_rows == 0
    return folder


@pytest.mark.skipif(not llvm.available(), reason="needs llvmlite")
@pytest.mark.slow
def test_compiled_and_not_compiled_flights_have_the_same_bits(campaign):
    assembly = assemble(campaign)
    batch = assembly.batch(np.array([0, 13, 25, 60], dtype=np.int64))
    kept = ("measured:y", "measured:u", "hinf_identity:mean_1")
    one, other = (Flyer(assembly, backend).fly(batch, kept) for backend in ("llvm", "numpy"))
    for name in one.scores:
        np.testing.assert_array_equal(one.scores[name], other.scores[name])
    for name in kept:
        np.testing.assert_array_equal(one.recorded[name], other.recorded[name])


def test_a_flight_alone_is_the_flight_in_company(campaign):
    assembly = assemble(campaign)
    flyer = Flyer(assembly)
    whole = flyer.fly(assembly.batch(np.arange(18, 30, dtype=np.int64)))
    alone = flyer.fly(assembly.batch(np.array([23], dtype=np.int64)))
    for name, scores in whole.scores.items():
        np.testing.assert_array_equal(scores[:, [5]], alone.scores[name])


def test_run_seven_of_every_scenario_is_the_same_engine(campaign):
    assembly = assemble(campaign)
    batch = assembly.batch(np.array([3, 9, 21], dtype=np.int64))
    engine = assembly.loop.constants.unpack(batch.constants).engine
    for _, rows in leaves(engine):
        np.testing.assert_array_equal(rows[:, 0], rows[:, 1])
        np.testing.assert_array_equal(rows[:, 0], rows[:, 2])


def test_overlapping_faults_are_events_with_their_own_limits(folder):
    rows, events = load(folder), load_events(folder)
    assert set(events["scenario"]) == {"faults_idle", "faults_half_steps", "faults_steps"}
    assert len(events) == 3 * 6 * 3 * 6
    assert set(events["sites"]) == {"f1", "f2", "f3"}
    assert set(events["detection_time_limit_s"]) == {5.0}
    assert set(rows[rows["scenario"] == "faults_steps"]["detection_time_limit_s"]) == {11.0}
    third = events[events["sites"] == "f3"]
    assert (third["onset_s"] == 20.0).all()
    assert (third["detection_time_s"].dropna() > 0.0).all()


def test_healthy_engines_are_quiet_and_unit_faults_are_found(folder):
    rows = load(folder)
    healthy = rows[rows["n_faulty"] == 0]
    assert (healthy["outcome"] == "false_alarm").mean() < 0.1
    assert (rows[rows["scenario"] == "faults_idle"]["outcome"] == "right").mean() > 0.8


def test_a_campaign_of_healthy_flights_alone_can_be_flown():
    path = gallery.folder("campaigns") / "jet_engine_tuning.yaml"
    assembly = assemble(read_campaign(path, ["dispersions.monte_carlo.runs=2"]))
    batch = assembly.batch(np.arange(2, dtype=np.int64))
    assert np.isfinite(Flyer(assembly).fly(batch).scores["hinf_identity"]).all()


def test_shipped_designs_were_tuned_on_the_tuning_campaign_only(campaign):
    for design in campaign.designs:
        assert [(entry.campaign, entry.seed) for entry in design.tuned_on] == [("jet_engine_tuning", 4101)]
    assert campaign.seed != 4101


def test_table_1_is_printed_beside_our_iterations():
    table = iterations_for(JetEngine.iterations)
    assert list(table.runs["printed"].values()) == [0.6273, 0.6248, 0.5791, 0.5476, 0.5253, 0.4739, 0.4641, 0.4641]
    assert list(table.runs["ours"].values()) == [0.63446, 0.34963, 0.334001]
    assert iterations_for("") is None
