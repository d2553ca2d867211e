"""Loss of effectiveness: a share of the total, exact at both ends."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from fddbench.faults.bias import Bias
from fddbench.faults.effectiveness import Effectiveness
from fddbench.faults.injection import SignalFaults
from fddbench.interfaces import FlightFaults, Site

T, ONSET = 0.01, 3
ELEVATOR = Site(
    name="elevator", kind="actuator", signal="s", unit_name="deg", admissible=20.0, stops=(-23.0, 17.0), floats=True
)
signals = st.lists(st.floats(-15.0, 15.0), min_size=8, max_size=8)


def loss(percent, **more):
    model = Effectiveness.in_unit("deg")
    return model(kind="effectiveness", sites=("elevator",), onset_s=ONSET * T, loss_percent=percent, **more)


def fly(faults, healthy):
    """Reading, (n_time,)."""
    block = SignalFaults([ELEVATOR], "s", [faults], T)
    c = block.prepare(FlightFaults(lists=[faults], which=np.zeros(1, dtype=int), uniform=np.full((4, 1, 1), 0.5)))
    x, found = block.states.spread(block.start(c), 1), []
    for k, value in enumerate(healthy):
        x, shown = block.step(x, c, block.draws.unpack(np.zeros((0, 1))), np.array([[value]]), np.float64(k))
        found.append(shown[0, 0])
    return np.array(found)


@settings(max_examples=30)
@given(signals, st.floats(0.0, 100.0))
def test_what_is_left_is_a_share_of_the_total(healthy, percent):
    expected = [value * (1.0 - percent / 100.0) if k >= ONSET else value for k, value in enumerate(healthy)]
    np.testing.assert_allclose(fly([loss(percent)], healthy), expected, rtol=1e-15)


@settings(max_examples=30)
@given(signals)
def test_no_loss_is_the_healthy_signal_bit_for_bit(healthy):
    healthy = np.array([*healthy, -0.0, 5e-324])
    assert fly([loss(0.0)], healthy).tobytes() == fly([], healthy).tobytes()


def test_all_lost_is_nothing():
    assert fly([loss(100.0)], np.arange(8.0))[ONSET:].tolist() == [0.0] * 5


def test_losses_multiply_and_take_what_earlier_faults_made():
    offset = Bias.in_unit("deg")(kind="bias", sites=("elevator",), onset_s=0.0, amplitude_deg=4.0)
    half, fifth = loss(50.0), loss(20.0, end_s=0.06)
    assert fly([half, fifth], np.full(8, 10.0)).tolist() == [10.0] * 3 + [4.0] * 3 + [5.0] * 2
    assert fly([half, offset], np.full(8, 10.0)).tolist() == [14.0] * 3 + [7.0] * 5


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"loss_percent": -1.0}, "greater than or equal to 0"),
        ({"loss_percent": 100.5}, "less than or equal to 100"),
        ({"loss_percent": {"uniform": [50.0, 101.0]}}, "uniform must stay <= 100.0, got 101"),
        ({"loss_percent": {"grid": [-5.0, 10.0]}}, "grid must stay >= 0.0, got -5"),
        ({"loss_percent": {"normal": {"mean": 20.0, "std": 1.0}}}, "a bell curve draws any number"),
        ({"loss_percent": 20.0, "mode": "replace"}, "'add'"),
        ({"loss_percent": 20.0, "correlation": "opposite"}, "'identical' or 'independent'"),
        ({}, "Field required"),
    ],
)
def test_what_is_refused_and_why(keys, message):
    with pytest.raises(ValidationError, match=message):
        Effectiveness(kind="effectiveness", sites=("elevator",), onset_s=1.0, **keys)


def test_a_site_without_a_signal_of_its_own_has_nothing_to_lose():
    added = Site(name="f1", signal="f", unit_name="", admissible=1.0, additive=True)
    assert "nothing to lose" in loss(10.0).unfit_on(added)
    sensor = Site(name="r1", signal="r", unit_name="deg/s", admissible=40.0)
    assert loss(10.0).unfit_on(ELEVATOR) == loss(10.0).unfit_on(sensor) == ""
