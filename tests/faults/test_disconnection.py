"""A surface that comes loose: the exact step response of a lag, from the last reading to where the air puts it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.signal import cont2discrete

from fddbench.errors import FddbenchError
from fddbench.faults.bias import Bias
from fddbench.faults.disconnection import Disconnection
from fddbench.faults.injection import SignalFaults
from fddbench.faults.jam import Jam
from fddbench.interfaces import FlightFaults, Site

N, ONSET = 60, 20
SITES = tuple(
    Site(
        name=name,
        kind="actuator",
        signal="s",
        row=row,
        unit_name="deg",
        admissible=20.0,
        stops=(-23.0, 17.0),
        floats=True,
    )
    for row, name in enumerate(("left", "right"))
)


def loose(sample_s=0.01, onset=ONSET, **more):
    model = Disconnection.in_unit("deg")
    return model(kind="disconnection", sites=more.pop("sites", ("left",)), onset_s=onset * sample_s, **more)


def fly(faults, healthy, free, sample_s=0.01):
    """Readings, (n_time, 2), of (n_time, 2) healthy and floating positions."""
    block = SignalFaults(SITES, "s", [faults], sample_s)
    c = block.prepare(FlightFaults(lists=[faults], which=np.zeros(1, dtype=int), uniform=np.full((4, 2, 1), 0.5)))
    x, found = block.states.spread(block.start(c), 1), []
    for k in range(len(healthy)):
        drawn = block.draws.unpack(np.zeros((0, 1)))
        x, shown = block.step(x, c, drawn, healthy[k][:, None], np.float64(k), free=free[k][:, None])
        found.append(shown[:, 0])
    return np.array(found)


def still(value):
    return np.full((N, 2), float(value))


@settings(max_examples=20)
@given(st.floats(-10.0, 10.0), st.floats(-10.0, 10.0), st.floats(0.02, 2.0), st.sampled_from([0.005, 0.01, 0.05]))
def test_the_way_to_a_constant_floating_position_is_the_exponential(position, to, lag_s, sample_s):
    found = fly([loose(sample_s, lag_s=lag_s)], still(position), still(to), sample_s)
    time_s = np.maximum(np.arange(N) - (ONSET - 1), 0) * sample_s  # since the last sample at which it was held
    expected = to + (position - to) * np.exp(-time_s / lag_s)
    np.testing.assert_allclose(found[:, 0], expected, rtol=1e-12, atol=1e-12)
    assert found[:, 1].tolist() == [position] * N


@settings(max_examples=10)
@given(st.integers(0, 100), st.floats(0.02, 2.0))
def test_a_moving_floating_position_is_followed_as_a_held_input_of_the_lag(seed, lag_s):
    rng = np.random.default_rng(seed)
    healthy, free = rng.uniform(-10.0, 10.0, (N, 2)), rng.uniform(-10.0, 10.0, (N, 2))
    found = fly([loose(lag_s=lag_s)], healthy, free)[:, 0]
    lag = tuple(np.array([[value]]) for value in (-1.0 / lag_s, 1.0 / lag_s, 1.0, 0.0))
    a, b = (float(matrix[0, 0]) for matrix in cont2discrete(lag, 0.01)[:2])
    y = healthy[ONSET - 1, 0]
    for k in range(ONSET, N):
        y = a * y + b * free[k, 0]
        assert found[k] == pytest.approx(y, rel=1e-12, abs=1e-12)
    assert found[:ONSET].tobytes() == healthy[:ONSET, 0].tobytes()


def test_the_step_does_not_change_the_way():
    coarse, fine = (fly([loose(s, onset=0)], still(8.0), still(-2.0), s)[:, 0] for s in (0.02, 0.01))
    np.testing.assert_allclose(coarse[:20], fine[1:41:2], rtol=1e-12)


def test_it_is_healthy_again_after_its_end_and_comes_loose_on_each_site_at_its_own_time():
    healthy = np.random.default_rng(3).normal(size=(N, 2))
    found = fly([loose(sites=("right", "left"), delay_s=0.1, end_s=0.4)], healthy, still(-5.0))
    changed = found != healthy
    assert [np.flatnonzero(changed[:, j])[[0, -1]].tolist() for j in (0, 1)] == [[30, 39], [20, 39]]


def test_a_later_jam_holds_where_it_has_floated_to_and_a_bias_adds_to_it():
    stuck = Jam.in_unit("deg")(kind="jam", mode="replace", freeze=True, sites=("left",), onset_s=0.4)
    offset = Bias.in_unit("deg")(kind="bias", sites=("left",), onset_s=0.2, amplitude_deg=1.0)
    alone = fly([loose()], still(6.0), still(-2.0))[:, 0]
    jammed = fly([stuck, loose()], still(6.0), still(-2.0))[:, 0]
    assert jammed[:40].tobytes() == alone[:40].tobytes()
    assert jammed[40:].tolist() == [alone[39]] * 20
    assert fly([offset, loose()], still(6.0), still(-2.0))[20:, 0].tolist() == (alone[20:] + 1.0).tolist()


def test_a_jammed_surface_that_comes_loose_starts_where_it_was_jammed():
    stuck = Jam.in_unit("deg")(kind="jam", mode="replace", sites=("left",), onset_s=0.1, hold_value_deg=3.0)
    found = fly([loose(), stuck], still(6.0), still(-2.0))[:, 0]
    assert found[10:20].tolist() == [3.0] * 10
    np.testing.assert_allclose(found[20:], -2.0 + 5.0 * np.exp(-np.arange(1, 41) * 0.1), rtol=1e-12)


def test_the_stops_hold_what_floats():
    assert fly([loose()], still(6.0), still(-60.0))[-1, 0] == -23.0


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"lag_s": 0.0}, "greater than 0"),
        ({"mode": "add"}, "'replace'"),
        ({"freeze": False}, "True"),
        ({"hold_value_deg_s": 1.0}, "give one of freeze, hold_value"),
        ({"correlation": "opposite"}, "'identical' or 'independent'"),
    ],
)
def test_what_is_refused_and_why(keys, message):
    with pytest.raises(ValidationError, match=message):
        Disconnection(kind="disconnection", sites=("left",), onset_s=1.0, **keys)


def test_only_what_floats_comes_loose_and_its_loop_must_say_where_to():
    sensor = Site(name="r1", signal="r", unit_name="deg/s", admissible=40.0)
    assert loose().unfit_on(sensor) == "it does not float"
    assert loose().unfit_on(SITES[0]) == ""
    block = SignalFaults(SITES, "s", [[loose()]], 0.01)
    c = block.prepare(FlightFaults(lists=[[loose()]], which=np.zeros(1, dtype=int), uniform=np.full((1, 2, 1), 0.5)))
    x = block.states.spread(block.start(c), 1)
    with pytest.raises(
        FddbenchError, match="a disconnection needs the floating position of its sites: .* as free=rows"
    ):
        block.step(x, c, block.draws.unpack(np.zeros((0, 1))), np.zeros((2, 1)), np.float64(0.0))
