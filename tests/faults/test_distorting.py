"""Faults that distort the reading: two's complement, whole steps, refreshes, latency, scale, against their definitions."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from fddbench.faults.injection import SignalFaults
from fddbench.faults.latency import Latency
from fddbench.faults.quantisation import Quantisation
from fddbench.faults.scale_factor import ScaleFactor
from fddbench.faults.spike import Spike
from fddbench.faults.stale import Stale
from fddbench.faults.stuck_bit import StuckBit
from fddbench.interfaces import FlightFaults, Site

T, N, ONSET = 0.01, 40, 10
SITES = tuple(Site(name=name, signal="s", row=row, unit_name="deg/s", admissible=40.0) for row, name in enumerate("ab"))
HEALTHY = np.random.default_rng(3).normal(size=N) * 4.0


def made(kind, name, onset=ONSET, **keys):
    return kind(kind=name, sites=keys.pop("sites", ("a",)), onset_s=onset * T, **keys)


def fly(fault, healthy=HEALTHY, *, flown=None, n_cases=1, others=()):
    """Readings of the first site, (n_time, n_cases), of a fault among those of other scenarios."""
    written, lists = [[fault], *others], [[flown or fault], *others]
    block = SignalFaults(SITES, "s", written, T)
    which, uniform = np.zeros(n_cases, dtype=int), np.full((1, 2, n_cases), 0.5)
    c = block.prepare(FlightFaults(lists=lists, which=which, uniform=uniform))
    x, found = block.states.spread(block.start(c), n_cases), []
    for k, value in enumerate(healthy):
        x, shown = block.step(x, c, block.draws.unpack(np.zeros((0, n_cases))), np.full((2, n_cases), value), float(k))
        found.append(shown[0])
    return np.array(found)


def after(expected, healthy=HEALTHY, onset=ONSET):
    return np.where(np.arange(len(healthy)) >= onset, expected, healthy)


def twos_complement(reading, bit, value, quantum):
    """A count as a word of 64 bits, by integers."""
    count = int(np.rint(reading / quantum))
    changed = (count | 1 << bit) if value else (count & ~(1 << bit))
    return reading + (changed - count) * quantum


@settings(max_examples=60)
@given(st.integers(0, 31), st.sampled_from([0, 1]), st.sampled_from([2.0**-6, 0.0156, 0.5]), st.floats(-127.0, 127.0))
def test_a_stuck_bit_is_that_of_integers(bit, value, quantum, reading):
    fault = made(StuckBit, "stuck_bit", onset=0, bit=bit, value=value, quantum_deg_s=quantum)
    found = fly(fault, [reading])[0, 0]
    expected = twos_complement(reading, bit, value, quantum)
    assert found == pytest.approx(expected, abs=1e-9 * 2.0**bit * quantum)
    count = round(reading / quantum)
    if (count >> bit) & 1 == value:
        assert found == reading


def test_of_minus_one_every_bit_is_one():
    for bit in (0, 5, 30):
        fault = made(StuckBit, "stuck_bit", onset=0, bit=bit, value=0, quantum_deg_s=1.0)
        assert fly(fault, [-1.0])[0, 0] == -1.0 - 2.0**bit


@settings(max_examples=20)
@given(st.floats(1e-3, 5.0))
def test_quantisation_is_the_nearest_step(quantum):
    found = fly(made(Quantisation, "quantisation", quantum_deg_s=quantum))[:, 0]
    assert (np.abs(found - HEALTHY)[ONSET:] <= quantum / 2.0 * (1 + 1e-12)).all()
    np.testing.assert_allclose(found, after(np.round(HEALTHY / quantum) * quantum), rtol=1e-12)


@pytest.mark.parametrize("every", [1, 2, 7])
def test_stale_data_is_refreshed_from_the_onset_on(every):
    k = np.arange(N)
    expected = HEALTHY[np.where(k >= ONSET, ONSET + (k - ONSET) // every * every, k)]
    assert fly(made(Stale, "stale", every_samples=every))[:, 0].tolist() == expected.tolist()


@pytest.mark.parametrize("others", [(), (0.05, 0.12)])
def test_latency_shows_what_was_read_before(others):
    """Alone by the ring, beside others picked out of it: the same reading; before the first there is only the first."""
    beside = [[made(Latency, "latency", latency_s=each)] for each in others]
    for ago, onset in ((0, 10), (1, 10), (7, 10), (12, 3), (9, 0)):
        fault = made(Latency, "latency", onset=onset, latency_s=ago * T)
        expected = after(HEALTHY[np.maximum(np.arange(N) - ago, 0)], onset=onset)
        assert fly(fault, others=beside)[:, 0].tolist() == expected.tolist()


def test_latencies_side_by_side_are_each_flight_s_own():
    fault = made(Latency, "latency", latency_s={"uniform": [0.0, 0.09]})
    flown = fault.flown({"latency_s": np.array([0.0, 0.02, 0.09])})
    found = fly(fault, flown=flown, n_cases=3)
    for case, ago in enumerate((0, 2, 9)):
        assert found[:, case].tolist() == after(HEALTHY[np.maximum(np.arange(N) - ago, 0)]).tolist()


def test_a_scale_factor_is_a_proportion_and_may_be_opposite():
    both = made(ScaleFactor, "scale_factor", sites=("b", "a"), scale_factor_percent=2.0, correlation="opposite")
    np.testing.assert_allclose(fly(both)[:, 0], after(0.98 * HEALTHY), rtol=1e-14)


@pytest.mark.parametrize(("period_s", "faulty"), [(None, {10, 11}), (0.1, {10, 11, 20, 21, 30, 31})])
def test_spikes_are_there_for_their_width_at_every_period(period_s, faulty):
    found = fly(made(Spike, "spike", amplitude_deg_s=3.0, width_s=0.02, period_s=period_s))[:, 0]
    assert {k for k in range(N) if found[k] != HEALTHY[k]} == faulty
    np.testing.assert_allclose(found, HEALTHY + 3.0 * np.isin(np.arange(N), list(faulty)), rtol=1e-15)


NOTHING = {
    "spike": (Spike, {"amplitude_deg_s": 0.0, "width_s": 0.02}),
    "stale": (Stale, {"every_samples": 1}),
    "scale_factor": (ScaleFactor, {"scale_factor_percent": 0.0}),
    "latency": (Latency, {"latency_s": 0.0}),
    "quantisation": (Quantisation, {"quantum_deg_s": 0.0}),
    "stuck_bit": (StuckBit, {"bit": 20, "value": 0, "quantum_deg_s": 1.0}),
}


@pytest.mark.parametrize("name", NOTHING)
def test_size_zero_is_the_healthy_signal_bit_for_bit(name):
    kind, sizes = NOTHING[name]
    healthy = np.abs(HEALTHY)
    assert fly(made(kind, name, **sizes), healthy)[:, 0].tobytes() == healthy.tobytes()


@pytest.mark.parametrize(
    ("kind", "keys", "message"),
    [
        (StuckBit, {"bit": 1.5, "value": 1, "quantum_deg_s": 1}, "need a whole number, got 1.5"),
        (
            StuckBit,
            {"bit": {"uniform": [0, 3]}, "value": 1, "quantum_deg_s": 1},
            "cannot draw a whole number; use grid",
        ),
        (StuckBit, {"bit": 32, "value": 1, "quantum_deg_s": 1}, "less than or equal to 31"),
        (StuckBit, {"bit": 3, "value": 1, "quantum_deg_s": 0}, "greater than 0"),
        (StuckBit, {"bit": 3, "value": 1}, "need exactly one of quantum_percent | quantum_deg_s, got none"),
        (Stale, {"every_samples": {"grid": [2, 2.5]}}, "need a whole number, got 2.5"),
        (Stale, {"every_samples": 0}, "greater than or equal to 1"),
        (Quantisation, {"quantum_percent": -1}, "greater than or equal to 0"),
        (Latency, {"latency_s": 0.1, "mode": "replace"}, "'add'"),
        (Stale, {"every_samples": 2, "correlation": "opposite"}, "'identical' or 'independent'"),
        (Spike, {"amplitude_deg_s": 1, "width_s": 0.1, "period_s": 0.1}, "pulses that touch are a bias"),
    ],
)
def test_what_is_refused_and_why(kind, keys, message):
    name = {StuckBit: "stuck_bit", Stale: "stale", Quantisation: "quantisation", Latency: "latency", Spike: "spike"}
    with pytest.raises(ValidationError, match=message):
        kind.model_validate({"kind": name[kind], "sites": ["a"], "onset_s": 1.0, **keys})


def test_what_the_clock_cannot_show_is_named():
    late = made(Latency, "latency", latency_s={"grid": [0.005, 10.01]})
    assert [message for _, message in late.unfit(T)] == [
        "latency_s = 0.005 falls between two samples of 0.01 s; the nearest are 0 and 0.01 [s]",
        "latency_s is at most 10 s at sample_s 0.01, 1000 samples, got 0.005|10.01; a signal so late is a freeze",
    ]
    assert [key for key, _ in made(Spike, "spike", amplitude_deg_s=1, width_s=0.005).unfit(T)] == ["width_s"]


def test_where_the_healthy_signal_is_zero_there_is_nothing_to_distort():
    added = Site(name="f1", signal="f", unit_name="", admissible=1.0, additive=True)
    assert "nothing to lose" in made(Stale, "stale", every_samples=2).unfit_on(added)
    assert made(Spike, "spike", amplitude_deg_s=1, width_s=0.01).unfit_on(added) == ""
