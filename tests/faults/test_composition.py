"""Several faults on one site: the order of its first faulty samples, freezes at the last reading, stops last."""

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.faults.bias import Bias
from fddbench.faults.injection import SignalFaults
from fddbench.faults.jam import Jam
from fddbench.faults.nrz import Nrz
from fddbench.faults.order import orders_of, pattern_of, place, stages
from fddbench.faults.runaway import Runaway
from fddbench.faults.varied import Varied
from fddbench.interfaces import FlightFaults, Site

T = 1.0
SITES = tuple(
    Site(name=name, signal="s", row=row, unit_name="deg/s", admissible=40.0, stops=(-12.0, 12.0))
    for row, name in enumerate(("a", "b"))
)
HEALTHY = np.repeat(np.arange(10.0)[:, np.newaxis], 2, axis=1)


def bias(size, onset, end=None, **more):
    return Bias(kind="bias", sites=more.pop("sites", ("a",)), onset_s=onset, end_s=end, amplitude_deg_s=size, **more)


def freeze(onset, end=None, **more):
    sites = more.pop("sites", ("a",))
    return Jam(kind="jam", mode="replace", freeze=True, sites=sites, onset_s=onset, end_s=end, **more)


def jam_at(value, onset, end=None):
    return Jam(kind="jam", mode="replace", hold_value_deg_s=value, sites=("a",), onset_s=onset, end_s=end)


def runaway(rate, onset, **more):
    return Runaway(kind="runaway", sites=more.pop("sites", ("a",)), onset_s=onset, rate_deg_s2=rate, **more)


def fly(written, flown=None, *, n_cases=1, healthy=HEALTHY, others=(), normals=0.0):
    """Readings, (n_time, n_sites, n_cases), of one scenario among others."""
    block = SignalFaults(SITES, "s", [written, *others], T)
    uniform = np.full((8, 2, n_cases), 0.5)
    flights = FlightFaults(lists=[flown or written, *others], which=np.zeros(n_cases, dtype=int), uniform=uniform)
    c = block.prepare(flights)
    x, found = block.states.spread(block.start(c), n_cases), []
    drawn = block.draws.unpack(np.full((block.draws.size, n_cases), normals))
    for k, row in enumerate(healthy):
        x, signal = block.step(x, c, drawn, np.repeat(row[:, np.newaxis], n_cases, axis=1), np.float64(k))
        found.append(signal)
    return np.array(found)


COMPOSITIONS = {
    "a biased sensor freezes": ([bias(2, 3), freeze(6)], "0 1 2 5 6 7 7 7 7 7"),
    "a frozen sensor gets a bias": ([freeze(3), bias(2, 6)], "0 1 2 2 2 2 4 4 4 4"),
    "the bias ends under the freeze": ([bias(2, 3, 8), freeze(5)], "0 1 2 5 6 6 6 6 6 6"),
    "the bias ended the sample before": ([bias(2, 3, 5), freeze(5)], "0 1 2 5 6 6 6 6 6 6"),
    "a freeze ends": ([freeze(3, 7)], "0 1 2 2 2 2 2 7 8 9"),
    "a freeze from the first sample": ([freeze(0)], "0 0 0 0 0 0 0 0 0 0"),
    "both from one sample on": ([freeze(4), bias(2, 4)], "0 1 2 3 5 5 5 5 5 5"),
    "a stuck sensor freezes": ([jam_at(5, 2), freeze(5, 8)], "0 1 5 5 5 5 5 5 5 5"),
    "a runaway reaches the stop": ([runaway(3, 2)], "0 1 2 6 10 12 12 12 12 12"),
    "a runaway freezes, then a bias": ([runaway(3, 2), freeze(5), bias(-2, 7)], "0 1 2 6 10 10 10 8 8 8"),
}


@pytest.mark.parametrize("name", COMPOSITIONS)
def test_every_order_of_the_lines_gives_the_same_reading(name):
    faults, expected = COMPOSITIONS[name]
    for lines in permutations(faults):
        found = fly(list(lines))
        assert found[:, 0, 0].tolist() == [float(word) for word in expected.split()]
        assert found[:, 1, 0].tolist() == list(range(10))


@pytest.mark.parametrize("name", COMPOSITIONS)
def test_other_scenarios_change_no_composition(name):
    """The lines of another scenario ask for another order: more stages, the same reading."""
    faults, expected = COMPOSITIONS[name]
    others = [
        [bias(1, 8), freeze(1), runaway(2, 4)],
        [freeze(2), bias(3, 1), jam_at(4, 7)],
        [runaway(1, 1, sites=("b", "a"), delay_s=3), bias(1, 2, sites=("b", "a"))],
    ]
    assert fly(faults, others=others)[:, 0, 0].tolist() == [float(word) for word in expected.split()]


def test_a_freeze_from_the_first_sample_takes_that_sample_with_what_acts_before_it():
    found = fly([freeze(0), bias(3, 0)], healthy=HEALTHY + 1.0)
    assert found[:, 0, 0].tolist() == [4.0] * 10


def test_the_order_is_that_of_each_site():
    """The freeze reaches b five samples later than a, behind the bias there and before it here."""
    faults = [freeze(2, sites=("a", "b"), delay_s=5), bias(2, 4, sites=("a", "b"))]
    found = fly(faults)
    assert found[:, 0, 0].tolist() == [0, 1, 1, 1, 3, 3, 3, 3, 3, 3]
    assert found[:, 1, 0].tolist() == [0, 1, 2, 3, 6, 7, 8, 8, 8, 8]


def test_a_wave_counts_from_each_site_s_own_onset():
    found = fly([runaway(3, 2, sites=("b", "a"), delay_s=3)]) - HEALTHY[:, :, np.newaxis]
    assert found[:7, 1, 0].tolist() == [0, 0, 0, 3, 6, 7, 6]
    assert found[:8, 0, 0].tolist() == [0, 0, 0, 0, 0, 0, 3, 5]


def test_the_end_is_the_first_healthy_sample():
    assert (fly([bias(2, 3, 5)]) - HEALTHY[:, :, np.newaxis])[:, 0, 0].tolist() == [0, 0, 0, 2, 2, 0, 0, 0, 0, 0]


@pytest.mark.parametrize("sizes", [[1.0], [1e6], [-1.7e308], [1.7e308, 1.7e308]])
def test_no_fault_passes_the_stops(sizes):
    with np.errstate(over="ignore"):
        found = fly([*(bias(size, 2) for size in sizes), runaway(1.0, 4, sites=("b",))])
    assert np.abs(found).max() <= 12.0
    assert sizes == [1.0] or (np.abs(found[2:, 0]) == 12.0).all()


def test_two_infinite_faults_that_cancel_are_no_number():
    """What cannot be computed must not look like a reading."""
    with np.errstate(all="ignore"):
        found = fly([bias(1.7e308, 1), bias(1.7e308, 1), bias(-1.7e308, 2), bias(-1.7e308, 2)])
    assert found[1, 0, 0] == 12.0
    assert not np.isnan(found[:, 1]).any()


def test_a_healthy_signal_within_its_stops_keeps_every_bit():
    healthy = np.random.default_rng(5).normal(size=(10, 2)) * 5.0
    healthy[3, 0] = -0.0
    found = fly([], healthy=healthy, others=[[freeze(2), bias(1, 4)]])
    assert found[:, :, 0].tobytes() == np.clip(healthy, -12.0, 12.0).tobytes()
    assert found[3, 0].tobytes() == np.array([-0.0]).tobytes()


def test_zero_size_in_any_order_is_the_healthy_flight():
    healthy = np.random.default_rng(6).normal(size=(10, 2)) * 20.0
    zeros = [bias(0, 3), runaway(0, 1, sites=("a", "b"), delay_s=4), bias(0, 2, 5, sites=("b",))]
    assert fly(zeros, healthy=healthy).tobytes() == fly([], healthy=healthy).tobytes()


lines = st.lists(
    st.tuples(
        st.sampled_from(["bias", "freeze", "jam", "runaway"]), st.integers(0, 9), st.integers(0, 6), st.booleans()
    ),
    min_size=1,
    max_size=4,
)


def made(kind, onset, length, both):
    sites, end = ("b", "a") if both else ("a",), onset + length if length else None
    if kind == "jam":
        return Jam(kind="jam", mode="replace", hold_value_deg_s=3.5, sites=sites, onset_s=onset, end_s=end)
    if kind == "freeze":
        return freeze(onset, end, sites=sites)
    return bias(1.25, onset, end, sites=sites) if kind == "bias" else runaway(0.75, onset, end_s=end, sites=sites)


def by_hand(faults, site, healthy):
    """Reading of a site sample by sample, as the contract words it."""
    here = sorted(
        (j for j, f in enumerate(faults) if site in f.sites),
        key=lambda j: (faults[j].onset_s, faults[j].mode != "replace", faults[j].kind, j),
    )
    shown, stands = [], {}
    for k, value in enumerate(healthy):
        reading = value
        for j in here:
            f = faults[j]
            if k == f.onset_s and f.freeze:
                stands[j] = shown[-1] if k else reading
            if k < f.onset_s or (f.end_s is not None and k >= f.end_s):
                continue
            if f.mode == "replace":
                reading = stands[j] if f.freeze else f.hold_value
            else:
                reading += f.amplitude if f.kind == "bias" else f.rate * (k - f.onset_s)
        shown.append(min(max(reading, -12.0), 12.0))
    return shown


@settings(max_examples=150)
@given(lines, st.randoms())
def test_any_composition_is_that_of_the_contract(drawn, random):
    faults = [made(*one) for one in drawn]
    found = fly(faults)
    for row, site in enumerate(("a", "b")):
        assert found[:, row, 0].tolist() == by_hand(faults, site, HEALTHY[:, row])
    shuffled = list(faults)
    random.shuffle(shuffled)
    replacing = [f.onset_s for f in faults if f.mode == "replace"]
    if len(set(replacing)) == len(replacing):
        np.testing.assert_array_equal(fly(shuffled), found)


onsets = st.lists(st.integers(0, 9), min_size=3, max_size=3)


@settings(max_examples=60)
@given(st.lists(onsets, min_size=1, max_size=6))
def test_drawn_onsets_act_in_each_flight_as_if_they_were_written(cases):
    """Flights with orders of their own side by side, each as the scenario with its onsets written down."""
    anywhere = Varied(uniform=(0.0, 9.0))
    written = [bias(2, anywhere), freeze(anywhere, sites=("a", "b")), runaway(3, anywhere)]
    flown = [
        f.flown({"onset_s": np.array(at, dtype=float)}) for f, at in zip(written, zip(*cases, strict=True), strict=True)
    ]
    found = fly(written, flown, n_cases=len(cases))
    for i, (first, second, third) in enumerate(cases):
        alone = fly([bias(2, first), freeze(second, sites=("a", "b")), runaway(3, third)])
        assert found[:, :, i].tobytes() == alone[:, :, 0].tobytes()


def test_random_bits_belong_to_the_line_whatever_the_order():
    """A line that has two stages draws the same numbers in both."""
    bits = Nrz(kind="nrz", sites=("a",), onset_s=3.0, amplitude_deg_s=1.0, bit_s=1.0)
    other = [freeze(2), Nrz(kind="nrz", sites=("a",), onset_s=1.0, amplitude_deg_s=1.0, bit_s=1.0)]
    block = SignalFaults(SITES, "s", [[bits, freeze(6)], other[::-1], other], T)
    assert len(block.lines) > 2
    assert {consumer for consumer, _ in block.draws.streams} == {64, 65}
    np.testing.assert_array_equal(
        fly([bits, freeze(6)], normals=1.0), fly([bits, freeze(6)], others=[other], normals=1.0)
    )


def test_one_order_costs_one_stage_a_line():
    block = SignalFaults(SITES, "s", [[bias(1, 3), freeze(5)], [bias(1, 2), bias(1, 2)], [freeze(1)]], T)
    assert block.lines == (0, 1)
    later_first = SignalFaults(SITES, "s", [[bias(1, 5), freeze(3)], [bias(1, 2)]], T)
    assert later_first.lines == (1, 0)
    either = SignalFaults(SITES, "s", [[bias(1, 5), freeze(3)], [bias(1, 2), freeze(3)]], T)
    assert sorted(either.lines) in ([0, 0, 1], [0, 1, 1])


def test_only_what_may_overtake_is_repeated():
    moving = Varied(uniform=(2.0, 4.0))
    assert pattern_of([bias(1, moving), freeze(3), bias(1, 7)], "a", T) == (0, 1, 0, 2)
    assert pattern_of([bias(1, moving), freeze(4), bias(1, 7)], "a", T) == (0, 1, 0, 2)
    assert pattern_of([bias(1, moving), freeze(2)], "a", T) == (1, 0)
    assert pattern_of([bias(1, moving), freeze(5)], "b", T) == ()


@given(st.lists(st.permutations(range(4)).flatmap(lambda p: st.integers(1, 4).map(lambda n: tuple(p[:n]))), min_size=1))
def test_every_pattern_has_its_place_in_the_stages(patterns):
    sequence = stages(patterns)
    for pattern in patterns:
        acting = place(np.array(pattern)[:, np.newaxis], sequence)[:, 0]
        assert [line for line, acts in zip(sequence, acting, strict=True) if acts] == list(pattern)


def test_orders_are_those_of_the_first_faulty_samples():
    faults = [bias(1, 3).flown({"onset_s": np.array([3.0, 1.0, 2.0])}), freeze(2)]
    assert orders_of(faults, "a", T, 3).tolist() == [[1, 0, 1], [0, 1, 0]]
