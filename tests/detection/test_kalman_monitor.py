"""The Kalman monitor: it alarms on what its model does not know, says no site, and belongs to its clock."""

from types import SimpleNamespace

import numpy as np
import pytest

from fddbench.blocks.layout import Nothing
from fddbench.detection.kalman_monitor import KalmanMonitor, KalmanMonitorGains
from fddbench.errors import DesignError
from fddbench.interfaces import Bus

BUS = Bus(sample_s=0.01, sites=(), signals={"y": 0, "u": 0})
GOOD = {
    "outputs": [{"signal": "y"}], "inputs": [{"signal": "u"}], "sample_s": 0.01, "A": [[0.99]], "B": [[0.01]], "C": [[1.0]],
    "K": [[0.3]], "W": [[2.0]], "mean_s": 0.1, "thresholds": [4.0], "confirm_s": 0.05,
}  # fmt: skip


def monitor(bus=BUS, **change):
    return KalmanMonitor.from_design(KalmanMonitorGains.model_validate(GOOD | change), bus)


def fly(made, fault, *, n=600):
    state, alarms, means = made.states.spread(made.start(Nothing()), 1), [], []
    x = np.zeros(1)
    for k in range(n):
        u = np.array([np.sin(0.02 * k)])
        state, verdict = made.step(state, Nothing(), Nothing(), SimpleNamespace(y=x + fault(k), u=u))
        assert verdict.declared is None
        alarms.append(verdict.alarm[0])
        means.append(verdict.signals["innovation_mean"][0])
        x = 0.99 * x + 0.01 * u
    return np.array(alarms), np.array(means)


def test_it_is_silent_on_its_model_and_alarms_on_what_it_does_not_know():
    made = monitor()
    assert not made.isolates
    alarms, means = fly(made, lambda k: 0.0)
    assert not alarms.any()
    assert means.max() < 1e-20
    assert fly(made, lambda k: 7.0)[1].max() < 1e-20  # another trim is none of its business
    alarms, means = fly(made, lambda k: 0.5 * (k - 300) if k >= 300 else 0.0)
    assert np.argmax(alarms) > 300
    first = np.argmax(means > 4.0)
    assert np.argmax(alarms) == first + 5  # confirm_s 0.05 at 0.01 s
    assert alarms[-1] == 1.0


def test_its_mean_is_a_lag_of_the_squared_whitened_innovation():
    _, means = fly(monitor(K=[[0.0]], A=[[0.5]], B=[[0.0]]), lambda k: 1.5 * k, n=2)
    assert means[1] == pytest.approx((1.0 - np.exp(-0.1)) * (2.0 * 1.5) ** 2)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"K": [[-0.2]], "A": [[1.0]]}, "this filter diverges: A - K C has spectral radius 1.2000"),
        ({"sample_s": 0.02}, "this design is for sample_s = 0.02, this campaign has 0.01"),
        ({"W": [[1.0, 0.0]]}, "W needs 1 rows of 1 numbers"),
        ({"inputs": [{"signal": "v"}]}, "needs the signals .'v'."),
        ({"confirm_s": 0.005}, "confirm_s"),
    ],
)
def test_numbers_that_make_no_monitor_say_why(change, message):
    with pytest.raises(DesignError, match=message):
        monitor(**change)
