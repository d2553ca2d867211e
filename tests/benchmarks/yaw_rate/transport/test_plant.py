"""The plant and its loop: trim, what is measured, feasibility, sites on other signals, and the same bits everywhere."""

from dataclasses import replace

import numpy as np
import pytest

from fddbench.benchmarks.yaw_rate.plant import PLANT_NEEDS, SITES
from fddbench.benchmarks.yaw_rate.plants.lateral_lpv import LateralLpvPlant
from fddbench.benchmarks.yaw_rate.plants.transport_6dof import Transport6Dof
from fddbench.blocks.block import program
from fddbench.blocks.flown import Addresses
from fddbench.blocks.kernel import build
from fddbench.blocks.philox import normals
from fddbench.errors import FddbenchError
from fddbench.faults.bias import Bias
from fddbench.interfaces import Site

CENTRE = np.array([[200e3], [0.30], [20e3], [290.0]])


def test_has_what_a_plant_needs():
    assert [name for name in PLANT_NEEDS if not hasattr(Transport6Dof, name)] == []


def test_calm_cruise_with_ideal_sensors_stays_in_trim(six):
    reasons, signals = six.fly(six.loop(sensors="ideal"), six.table_5[:, ::7], "cruise", seconds=20.0)
    signals = {name: rows[:, reasons == ""] for name, rows in signals.items()}
    for name in ("phi_true_deg", "theta_true_deg", "beta_true_deg", "n_z_true_g", "v_cas_true_kt"):
        assert np.abs(signals[name] - signals[name][0]).max() < 1e-9, name
    assert np.abs(signals["altitude_true_ft"] - signals["altitude_true_ft"][0]).max() < 1e-7


def test_27_points_of_table_5_are_infeasible_and_more_where_a_manoeuvre_needs_more(six):
    loop = six.loop()
    reasons = {name: np.array(six.prepared(loop, six.table_5, name)[0]) for name in ("cruise", "turn_coordination_2")}
    kinds = [reason.split(":")[0] for reason in reasons["cruise"] if reason]
    found = {kind: kinds.count(kind) for kind in dict.fromkeys(kinds)}
    assert found == {"buffet": 15, "above M_MO": 9, "thrust": 3}
    more = [new for old, new in zip(*reasons.values(), strict=True) if new and not old]
    assert len(more) == 12
    assert all(reason.startswith("turn_coordination_2: ") and "at load factor 1.19" in reason for reason in more)
    assert "105 kN available" in six.prepared(loop, np.array([[233e3], [0.3], [38e3], [220.0]]), "cruise")[0][0]


def test_flights_of_the_papers_figures_are_feasible(six):
    condition = np.array([[210e3, 185e3], [0.32, 0.28], [23e3, 37e3], [300.0, 267.0]])
    assert six.prepared(six.loop(), condition, ["turn_coordination_2", "cruise"])[0] == ("", "")


@pytest.fixture(scope="module")
def stepped(six):
    """What is seen of a cruise at the centre at the last of some samples, in plain NumPy."""

    def run(loop, *, samples=1, **more):
        _, constants, state = six.prepared(loop, CENTRE, "cruise", **more)
        for k in range(samples):
            state, seen = loop.step(state, constants, loop.draws.unpack(np.zeros((loop.draws.size, 1))), float(k))
        return seen

    return run


def test_errors_reach_the_bus_and_not_the_truth(six, stepped):
    errors = {
        "mass_error_percent": 10.0,
        "x_cg_error_percent": -10.0,
        "altitude_error_percent": 5.0,
        "v_cas_error_percent": -5.0,
    }
    seen = stepped(six.loop(), **errors)
    bus = seen.measured
    assert (bus.mass_kg[0], bus.x_cg_ratio[0]) == (pytest.approx(220e3), pytest.approx(0.27))
    assert (bus.altitude_ft[0], bus.v_cas_kt[0]) == (pytest.approx(21e3), pytest.approx(275.5))
    assert (seen.truth["altitude_true_ft"][0], seen.truth["v_cas_true_kt"][0]) == (
        pytest.approx(20e3),
        pytest.approx(290.0),
    )
    assert bus.v_tas_m_s[0] == pytest.approx(192.74, abs=0.3)


def test_the_bus_has_all_that_the_lateral_model_has(six, stepped):
    lateral, whole = six.loop(plant=LateralLpvPlant), six.loop()
    assert set(lateral.bus.signals) < set(whole.bus.signals)
    assert all(whole.bus.signals[name] == rows for name, rows in lateral.bus.signals.items())
    assert set(lateral.truth) < set(whole.truth)
    seen = stepped(whole)
    for name, rows in whole.bus.signals.items():
        assert np.shape(getattr(seen.measured, name)) == ((rows, 1) if rows else (1,)), name


class MoreSites(Transport6Dof):
    sites = (
        *SITES,
        Site(name="alpha2", signal="alpha_deg", row=1, unit_name="deg", admissible=30.0, limits_s=(1.0,)),
        Site(
            name="left_elevator",
            kind="actuator",
            signal="elevator_deg",
            unit_name="deg",
            admissible=30.0,
            limits_s=(1.0,),
        ),
        Site(
            name="inboard",
            kind="actuator",
            signal="surface_deg",
            row=3,
            unit_name="deg",
            admissible=25.0,
            limits_s=(1.0,),
        ),
        Site(name="trim", kind="actuator", signal="stabiliser_deg", unit_name="deg", admissible=5.0, limits_s=(1.0,)),
        Site(name="n1", signal="n_z_g", unit_name="g", admissible=2.0, limits_s=(1.0,)),
    )


@pytest.mark.parametrize(
    ("site", "unit", "signal", "row"),
    [
        ("alpha2", "deg", "alpha_deg", 1),
        ("left_elevator", "deg", "elevator_deg", 0),
        ("inboard", "deg", "surface_deg", 3),
        ("trim", "deg", "stabiliser_deg", None),
        ("n1", "g", "n_z_g", 0),
    ],
)
def test_faults_sit_on_single_sensors_and_surfaces(six, stepped, site, unit, signal, row):
    fault = Bias.in_unit(unit)(kind="bias", sites=[site], onset_s=0.0, **{f"amplitude_{unit}": 0.5})
    loop = six.loop(plant=MoreSites, faults=([fault],))
    broken = stepped(loop, faults=[[fault]])
    healthy = stepped(six.loop())
    moved = getattr(broken.measured, signal) - getattr(healthy.measured, signal)
    moved = moved if row is None else moved[row]
    assert moved[0] == pytest.approx(0.5)
    place = [each.name for each in MoreSites.sites].index(site)
    added = broken.added[:, 0]
    assert added[place] == pytest.approx(0.5)
    assert np.flatnonzero(added).tolist() == [place]


def test_one_elevator_alone_rolls_the_aircraft(six, stepped):
    fault = Bias.in_unit("deg")(kind="bias", sites=["left_elevator"], onset_s=0.0, amplitude_deg=5.0)
    loop = six.loop(plant=MoreSites, faults=([fault],))
    seen = stepped(loop, samples=5, faults=[[fault]])
    assert seen.truth["p_true_deg_s"][0] > 0.01  # lift on the left


def test_a_site_on_an_unknown_signal_is_refused(six):
    class Wrong(Transport6Dof):
        sites = (*SITES, replace(SITES[0], name="q1", signal="q_deg_s"))

    with pytest.raises(FddbenchError, match="fault sites q1 on q_deg_s: this plant has sites on r_deg_s, alpha_deg"):
        six.loop(plant=Wrong)


def test_compiled_interpreted_and_plain_flights_have_the_same_bits(six):
    fault = Bias.in_unit("deg/s")(kind="bias", sites=["r1"], onset_s=0.1, amplitude_deg_s=0.5)
    loop = six.loop(wind="moderate", faults=([fault],))
    condition = six.table_5[:, 30:33]
    manoeuvres = ["turn_coordination_2", "n_z_limitation_1", "speed_change"]
    _, constants, state = six.prepared(loop, condition, manoeuvres, faults=[[fault]] * 3)
    made = program(loop)
    begun, fixed = loop.states.pack(state, 3), loop.constants.pack(constants, 3)
    addresses = Addresses(key=3, run=np.arange(3), flight=np.zeros(3), scenario=np.ones(3))
    ends = {}
    for backend in ("auto", "numpy"):
        kernel = build(made, streams=loop.draws.streams, backend=backend)
        # the first input comes at 5 s: begin there
        flown = kernel.fly(begun, fixed, np.full(3, 540), addresses, first=490, end=540)
        ends[backend] = flown.state
    assert ends["auto"].tobytes() == ends["numpy"].tobytes()
    x = state
    for k in range(490, 540):
        words = {"flight": addresses.flight, "scenario": addresses.scenario}
        drawn = [normals((k, consumer, addresses.run, words[stream]), 3) for consumer, stream in loop.draws.streams]
        rows = np.concatenate([np.broadcast_to(each, (4, 3)) for each in drawn])
        x, _ = loop.step(x, constants, loop.draws.unpack(rows), float(k))
    assert loop.states.pack(x, 3).tobytes() == ends["numpy"].tobytes()


def test_finer_integration_changes_next_to_nothing(six):
    """Half the step: 1e-8 deg/s after a roll doublet."""
    condition = six.table_5[:, [30, 45]]
    ends = [
        six.fly(six.loop(sensors="ideal", substeps=n), condition, "dpm", seconds=12.0)[1]["r_true_deg_s"]
        for n in (1, 2)
    ]
    assert 0.0 < np.abs(ends[0] - ends[1]).max() < 1e-6


def test_a_gust_from_the_left_is_met_at_5_s_with_its_gradient(six):
    condition = np.repeat(CENTRE, 3, axis=1)
    gradients = {"gust_gradient_m": [30.0, 60.0, 107.0]}
    _, signals = six.fly(
        six.loop(wind="one_minus_cosine", sensors="ideal"), condition, "cruise", seconds=20.0, **gradients
    )
    beta = signals["beta_true_deg"]
    assert np.abs(beta[:500]).max() < 1e-9
    # met from the left the air comes from the left: negative sideslip, within the gust's own time
    assert (beta.min(0) < -1.5).all()
    assert (np.diff(np.argmin(beta, axis=0)) > 0).all()
    assert (np.abs(beta[-1]) < 0.1).all()


def test_turbulence_of_the_lateral_wind_comes_in_six_components(six):
    condition = np.repeat(CENTRE, 16, axis=1)
    _, signals = six.fly(six.loop(wind="light", sensors="ideal"), condition, "cruise", seconds=30.0)
    assert not signals["departed"].any()
    assert 0.03 < (signals["n_z_true_g"] - 1.0).std() < 0.15
    assert 0.1 < signals["beta_true_deg"].std() < 1.0


def test_a_steady_wind_carries_the_aircraft_along_and_is_held_against(six):
    condition = np.repeat(CENTRE, 3, axis=1)
    winds = {"cross_wind_kt": [0.0, 40.0, 40.0], "tail_wind_kt": [0.0, 0.0, -80.0]}
    _, signals = six.fly(six.loop(sensors="ideal"), condition, "cruise", seconds=30.0, **winds)
    assert signals["y_m"][-1] == pytest.approx([0.0, 617.3, 617.3], abs=0.5)
    assert np.abs(signals["phi_true_deg"]).max() < 1e-6  # what is held is the track that the wind makes
    assert np.abs(signals["v_cas_true_kt"] - 290.0).max() < 1e-6
    _, signals = six.fly(six.loop(sensors="ideal"), condition, "yaw_angle_mode", seconds=30.0, **winds)
    assert (np.abs(signals["psi_deg"][-1] - 10.0) < 4.0).all()
