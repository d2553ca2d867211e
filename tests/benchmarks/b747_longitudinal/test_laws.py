"""The closed loop: settling times, coupling, both faults, gusts, and pitch by the stabiliser."""

from dataclasses import replace

import numpy as np
import pytest

from fddbench.benchmarks.b747_longitudinal.laws.tracking import Hinf, Scheduled
from fddbench.faults.disconnection import Disconnection
from fddbench.faults.effectiveness import Effectiveness

LAWS = ("hinf", "lqi", "scheduled")
SAMPLE_S = 0.04


def settled_s(response, step, *, from_s=10.0):
    """Time after a step at `from_s` from which on the response stays within 5 % of it [s]."""
    outside = np.flatnonzero(np.abs(response - step) > 0.05 * abs(step))
    return (outside[-1] + 1) * SAMPLE_S - from_s


@pytest.mark.parametrize("law", LAWS)
def test_settling_times_and_coupling_of_the_nonlinear_aircraft(bench, law):
    """Asked: 15 s and 45 s within 10 %, no drift. Found: 15.2 to 15.6 s, 43.3 to 45.4 s."""
    loop = bench.loop(law=law)
    path = bench.fly(loop, 1, 120.0, manoeuvre="gamma_step")
    speed = bench.fly(loop, 1, 200.0, manoeuvre="speed_step")
    gamma_deg, v_m_s = path["gamma_true_deg"][:, 0], speed["v_tas_true_m_s"][:, 0] - 241.0
    assert settled_s(gamma_deg, 2.0) == pytest.approx(15.0, rel=0.1)
    assert settled_s(v_m_s, 5.0) == pytest.approx(45.0, rel=0.1)
    # what is left after two minutes of climb: the air gets thinner, so the trim moves
    assert abs(gamma_deg[-1] - 2.0) < 0.02
    assert abs(v_m_s[-1] - 5.0) < 0.002
    # coupling, in m/s of 2 deg and in deg of 5 m/s; found 0.15 and 0.04 with H∞, 0.04 and 0.001 with the others
    assert np.abs(path["v_tas_true_m_s"] - 241.0).max() < 0.2
    assert np.abs(speed["gamma_true_deg"]).max() < 0.05


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("plant", ["nonlinear", "lpv_fold", "lpv_approx"])
def test_commands_are_reached_despite_both_faults(bench, law, plant):
    """Figs. 4 and 6 with our sizes: 30 % of the elevator 45-75 s, 20 % of the thrust 60-115 s."""
    elevator = {"kind": "effectiveness", "sites": ("elevator",), "onset_s": 45.0, "end_s": 75.0, "loss_percent": 30.0}
    thrust = {"kind": "effectiveness", "sites": ("thrust",), "onset_s": 60.0, "end_s": 115.0, "loss_percent": 20.0}
    faults = [[Effectiveness.in_unit("deg")(**elevator), Effectiveness.in_unit("N")(**thrust)]]
    now = bench.fly(bench.loop(law=law, plant=plant, faults=faults), 1, 150.0, manoeuvre="figures", faults=faults)
    gamma_deg, v_m_s = now["gamma_true_deg"][:, 0], now["v_tas_true_m_s"][:, 0] - 241.0
    at = {time_s: round(time_s / SAMPLE_S) for time_s in (59, 74, 99, 150)}
    assert gamma_deg[[at[59], at[74], at[99]]] == pytest.approx(2.0, abs=0.03)
    assert gamma_deg[at[150]] == pytest.approx(0.0, abs=0.01)
    assert v_m_s[[at[99], at[150]]] == pytest.approx(5.0, abs=0.25)  # the band of settling
    # the end of the climb meets the loss, and the loss ends: found 0.9 m/s at most
    assert np.abs(v_m_s[at[99] :] - 5.0).max() < 1.2
    # and the faults were there: the elevator order is a third larger while 30 % are lost
    assert now["elevator_deg"][at[59], 0] * 0.7 == pytest.approx(now["elevator_true_deg"][at[59], 0])
    assert now["elevator_deg"][at[59], 0] > 1.3 * now["elevator_deg"][at[99], 0]


def test_the_scheduled_law_flies_over_the_envelope(bench):
    altitude_m, v_tas_m_s = (g.ravel() for g in np.meshgrid([2e3, 5e3, 8e3, 10.5e3], [170.0, 210.0, 260.0]))
    now = bench.fly(
        bench.loop(law="scheduled"), 12, 220.0, manoeuvre="figures", altitude_m=altitude_m, v_tas_m_s=v_tas_m_s
    )
    assert not now["departed"].any()
    assert np.abs(now["gamma_true_deg"][-1]).max() < 0.01
    assert np.abs(now["v_tas_true_m_s"][-1] - v_tas_m_s - 5.0).max() < 0.05


@pytest.mark.parametrize("own", [Hinf, Scheduled])
def test_integrals_do_not_wind_up_where_engines_give_no_more(bench, own):
    """Climb at 10,500 m, 260 m/s, which 5 m/s are lost in: afterwards 5.5 m/s at most; 9 m/s without E."""

    class Wound(own):
        """The same law, whose integrals do not know of stops."""

        law = replace(own.law, E=0.0 * own.law.E)

    def highest_m_s(law):
        flown = bench.fly(bench.loop(law=law), 1, 250.0, manoeuvre="figures", altitude_m=[10500.0], v_tas_m_s=[260.0])
        return float(flown["v_tas_true_m_s"].max()) - 260.0

    assert highest_m_s(own) < 5.7
    assert highest_m_s(Wound) > 8.0


@pytest.mark.parametrize("law", LAWS)
def test_gusts_move_the_flight_path_less_than_in_open_loop(bench, law):
    """Moderate turbulence, 100 s of eight flights. Found: 0.95 deg rms in open loop, 0.3 deg with a law.

    Engines do not chase every gust: their thrust moves by 12 kN rms; it would go from stop to stop if a law took airspeed
    as it is.
    """

    def rms_deg(loop):
        flown = bench.fly(loop, 8, 100.0)
        assert np.std(flown["thrust_n"]) < 14e3
        return float(np.sqrt(np.mean(flown["gamma_true_deg"] ** 2)))

    assert rms_deg(bench.loop(law=law, wind="moderate")) < 0.5 * rms_deg(bench.loop(wind="moderate"))


@pytest.mark.parametrize("law", LAWS)
def test_a_declared_elevator_hands_the_pitch_to_the_stabiliser(bench, law):
    """Loose from 45 s on. Declared a second later the commands are reached; never declared, the aircraft is lost."""
    loose = [[Disconnection.in_unit("deg")(kind="disconnection", sites=("elevator",), onset_s=45.0)]]
    loop = bench.loop(law=law, faults=loose)
    saved = bench.fly(loop, 1, 150.0, manoeuvre="figures", faults=loose, declared_from_s=46.0)
    lost = bench.fly(loop, 1, 150.0, manoeuvre="figures", faults=loose)
    assert not saved["departed"].any()
    assert saved["gamma_true_deg"][round(99 / SAMPLE_S), 0] == pytest.approx(2.0, abs=0.05)
    assert saved["gamma_true_deg"][-1, 0] == pytest.approx(0.0, abs=0.05)
    assert np.ptp(saved["elevator_deg"][round(47 / SAMPLE_S) :]) < 1e-3
    assert np.ptp(saved["stabiliser_deg"]) > 1.0
    assert lost["departed"].any()


def test_a_finer_clock_flies_the_same(bench):
    """Orders come a sample late, whatever the clock; 10 ms against 40 ms moves the flight path by less than 0.05 deg."""
    coarse, fine = (
        bench.fly(bench.loop(law="hinf", sample_s=sample_s), 1, 40.0, manoeuvre="gamma_step")["gamma_true_deg"][:, 0]
        for sample_s in (0.04, 0.01)
    )
    assert np.abs(coarse - fine[::4]).max() < 0.05
