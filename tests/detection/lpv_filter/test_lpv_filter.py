"""Filters in flight beside a plant whose parameter swings: decoupling, size of faults, decision, refusals."""

import numpy as np
import pytest
from tests.detection.lpv_filter.plant import SAMPLE_S, Tilt, bus, detector, fly, gains

from fddbench.blocks.program import trace
from fddbench.detection.lpv_filter.detector import LpvFilter
from fddbench.errors import DesignError
from fddbench.interfaces import Tunable

ALL, TWO = np.eye(3), np.eye(3)[:2]
BANKS = {
    "one state": (ALL, {}),
    "full order": (ALL, {"one_state": False}),
    "N moves": (TWO, {"one_state": False, "decay": 0.5}),
}


def step_of(left, right, since=4.0):
    return lambda t: np.array([left, right]) if t >= since else np.zeros(2)


@pytest.mark.parametrize("bank", BANKS)
def test_a_fault_shows_in_its_own_estimate_and_in_no_other(bank):
    C, how = BANKS[bank]
    made = detector(C, **how)
    assert any(each.varies for each in made.filters) == (bank == "N moves")
    estimate, _ = fly(made, C, step_of(2.0, 0.0), step_of(0.0, -3.0))
    # an unmeasured state bends the outputs between samples, and nobody sees it; L moves faster than the filters follow
    worst, near = (3e-3, 0.4) if bank == "N moves" else (1e-6, 0.2)
    for flight, own, size in ((0, 0, 2.0), (1, 1, -3.0)):
        peak = np.abs(estimate[:, own, flight]).max()
        assert np.abs(estimate[:, 1 - own, flight]).max() < worst * peak
        assert np.abs(estimate[: round(4.0 / SAMPLE_S)]).max() < worst
        assert estimate[-1, own, flight] == pytest.approx(size, rel=near)


def test_the_estimate_is_the_fault_through_a_lag_of_the_decay():
    estimate, declared = fly(detector(ALL, decay=4.0), ALL, step_of(2.0, 0.0))
    after = round(4.0 / SAMPLE_S) + np.arange(1, 50)
    expected = 2.0 * (1.0 - np.exp(-4.0 * SAMPLE_S * np.arange(1, 50)))
    np.testing.assert_allclose(estimate[after, 0, 0], expected, atol=0.02)
    first = np.argmax(estimate[:, 0, 0] > 1.0)
    assert np.argmax(declared[:, 0, 0] > 0.0) == first + 5  # confirm_s 0.2 at 0.04 s
    assert declared[-1, :, 0].tolist() == [1.0, 0.0]


def test_it_starts_in_the_state_of_its_outputs():
    estimate, _ = fly(detector(ALL), ALL, step_of(0.0, 0.0), time_s=2.0, x0=(3.0, -1.0, 2.0))
    assert np.abs(estimate).max() < 1e-4


def test_an_estimate_is_not_blown_up_where_its_fault_hardly_shows():
    made = detector(ALL)
    lame = gains(ALL).model_copy(
        update={"filters": tuple(f.model_copy(update={"least_gain": 1e3}) for f in gains(ALL).filters)}
    )
    estimate, _ = fly(LpvFilter.from_design(lame, bus(ALL), Tilt), ALL, step_of(2.0, 0.0))
    assert np.abs(estimate).max() < 1e-4
    assert isinstance(made, Tunable)


def test_the_offset_of_its_estimates_is_taken_out():
    trim = {"time_constant_s": 2.0, "freeze_above": [3.0, 3.0], "learn_s": 1.0}
    estimate, _ = fly(detector(ALL, trim=trim), ALL, step_of(2.0, 0.0, since=0.0), time_s=12.0)
    assert np.abs(estimate[-1]).max() < 0.01


@pytest.mark.parametrize("bank", BANKS)
def test_it_is_traced(bank):
    C, how = BANKS[bank]
    made = detector(C, **how)

    def step(state, **signals):
        from types import SimpleNamespace

        after, verdict = made.step(made.states.unpack(state), None, None, SimpleNamespace(**signals))
        return {"state": made.states.pack(after), "declared": verdict.declared}

    assert trace(step, state=made.states.size, **bus(C).signals).hash


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"outputs": [{"signal": "z"}] * 3}, "needs the signals .'z'., this benchmark has"),
        ({"outputs": [{"signal": "y", "row": 3}] * 3}, r"outputs\[0\]: y has 3 rows, give row: 0 to 2; got row: 3"),
        ({"inputs": [{"signal": "left_deg", "row": 0}] * 2}, r"inputs\[0\]: left_deg has one row, leave row out"),
        ({"inputs": [{"signal": "left_deg"}]}, r"filters\[0\].F is 1 x 2, needs 1 x 1"),
        ({"thresholds": [1.0]}, "thresholds has 1 numbers for 2 filters"),
        ({"trim": {"time_constant_s": 1.0, "freeze_above": [1.0]}}, "trim.freeze_above has 1 numbers for 2"),
        ({"bend": [np.eye(3).tolist()] * 3}, "bend has 3 matrices for 1 scheduling parameters; it needs 1 or 2"),
        ({"confirm_s": 0.05}, "confirm_s"),
    ],
)
def test_banks_that_cannot_fly_say_why(change, message):
    with pytest.raises(DesignError, match=message):
        LpvFilter.from_design(gains(ALL, **change), bus(ALL), Tilt)


def test_a_bank_that_diverges_is_refused():
    good = gains(ALL)
    bad = good.filters[0].model_copy(update={"N": (((0.1,),),)})
    with pytest.raises(DesignError, match=r"filters\[0\] diverges: N has poles .0.1."):
        LpvFilter.from_design(good.model_copy(update={"filters": (bad, good.filters[1])}), bus(ALL), Tilt)
    twice = good.model_copy(update={"filters": (good.filters[0], good.filters[0])})
    with pytest.raises(DesignError, match="two filters speak for one site"):
        LpvFilter.from_design(twice, bus(ALL), Tilt)


def test_a_channel_is_a_signal_or_a_constant():
    with pytest.raises(ValueError, match="signal or constant: a channel has one of them"):
        gains(ALL, inputs=[{"scale": 2.0}, {"signal": "left_deg"}])
