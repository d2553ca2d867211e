"""The shipped laws are what their recipes give and do what their files say; no synthesis needed but for the H∞ recipe."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from fddbench.benchmarks.b747_longitudinal.laws import law_file
from fddbench.benchmarks.b747_longitudinal.laws.law_file import read_law
from fddbench.cli import main
from fddbench.design.norms import hinf_norm
from fddbench.design.recipe import cook
from fddbench.design.tracking import making
from fddbench.design.tracking.aircraft import FlightPoint, linear_aircraft
from fddbench.design.tracking.closed_loop import actuated, disk_margin, gains_at
from fddbench.design.tracking.findings import SAMPLE_S, slowest_decays_1_s, step_responses
from fddbench.design.tracking.hinf import controller_of
from fddbench.design.tracking.interconnection import generalised_plant
from fddbench.design.tracking.law_entries import WeightsEntry
from fddbench.design.tracking.scheduled import envelope_points
from fddbench.systems import lower_lft

DATA = Path(law_file.__file__).parents[1] / "data"
DESIGN = FlightPoint(altitude_m=7000.0, v_tas_m_s=241.0)
NAMES = ("hinf", "lqi", "scheduled")


def path(name):
    return DATA / f"law_{name}.yaml"


def found(name):
    return yaml.safe_load(path(name).read_text())["recipe"]["found"]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.slow
def test_the_recipe_gives_the_law_of_the_file(name, tmp_path, monkeypatch):
    if name == "hinf":
        pytest.importorskip("slycot", reason="H∞ synthesis needs the extra 'synthesis', whose slycot is GPL")
    monkeypatch.setattr(making, "findings", lambda *_: {})  # the flights take seconds
    cooked = cook(path(name))
    for key, value in cooked.found.items():
        assert value == pytest.approx(found(name)[key], rel=1e-3)
    (tmp_path / "again.yaml").write_text(cooked.text)
    again, law = read_law(tmp_path / "again.yaml"), read_law(path(name))
    # the states of another synthesis may be others, its response is not
    for w in (0.01, 0.3, 3.0, 30.0):
        np.testing.assert_allclose(gains_at(again, 17e3).at(w), gains_at(law, 17e3).at(w), rtol=1e-3, atol=1e-4)


def test_a_law_has_no_thresholds_to_tune(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(making, "findings", lambda *_: {"slowest_decay_1_s": 0.0})
    assert main(["design", str(path("lqi")), "--output", str(tmp_path / "mine.yaml")]) == 0
    told = capsys.readouterr().err
    assert "slowest_decay_1_s: 0.0 (the file says 0.0333334)" in told
    assert "tune" not in told


def test_the_closed_loop_of_the_hinf_file_has_the_norm_that_it_says():
    weights = WeightsEntry(**yaml.safe_load(path("hinf").read_text())["recipe"]["weights"]).weights()
    plant = generalised_plant(linear_aircraft(DESIGN), weights)
    law = gains_at(read_law(path("hinf")), DESIGN.dynamic_pressure_pa)
    closed = lower_lft(plant, controller_of(law))
    assert closed.stable()
    assert hinf_norm(closed, tolerance=1e-6).value == pytest.approx(found("hinf")["gamma"], rel=1e-4)
    # every part of a controller can fly: RK4 takes |lambda| dt < 2.78, Tustin's rule bends nothing below 1 / dt
    assert np.abs(law.poles()).max() * SAMPLE_S < 1.0


def test_steps_settle_in_15_and_45_s_on_the_nonlinear_aircraft_without_drift_or_coupling():
    seen = step_responses(read_law(path("hinf")), DESIGN)  # the benchmark's tests fly the others
    assert seen["flight_path_settling_s"] == pytest.approx(15.0, rel=0.1)
    assert seen["speed_settling_s"] == pytest.approx(45.0, rel=0.1)
    assert abs(seen["flight_path_left_deg"]) < 0.01  # the trim of a climb moves
    assert abs(seen["speed_left_m_s"]) < 0.002
    assert seen["speed_by_flight_path_m_s"] < 0.2
    assert seen["flight_path_by_speed_deg"] < 0.05
    assert seen == pytest.approx(found("hinf")["nonlinear"], rel=0.05, abs=1e-4)


@pytest.mark.parametrize("name", NAMES)
def test_margins_are_those_of_the_file_with_the_elevator_and_with_the_stabiliser(name):
    law, flying = read_law(path(name)), linear_aircraft(DESIGN)
    gains = gains_at(law, DESIGN.dynamic_pressure_pa)
    for key, plant in (
        ("disk_margin", actuated(flying)),
        ("disk_margin_stabiliser", actuated(flying, law.handover)),
    ):
        for order, least in (("elevator_deg", 0.6), ("thrust_n", 0.9)):
            margin = disk_margin(plant, gains, order, delay_s=1.5 * SAMPLE_S)
            assert margin == pytest.approx(found(name)[key][order], rel=1e-3)
            assert margin > least


@pytest.mark.slow
def test_the_scheduled_law_is_stable_all_over_the_envelope():
    points = envelope_points([150.0, 200.0, 280.0], [1000.0, 6000.0, 11000.0])
    assert len(points) == 8
    by_elevator, by_stabiliser = slowest_decays_1_s(read_law(path("scheduled")), *points)
    assert by_elevator > 0.03  # that of the filter of speed
    assert by_stabiliser > 0.03
