"""The independent scorer gives every printed value, and the examples are what they say."""

from itertools import permutations

import pytest
from tests.metrics.independent import Flight, score
from tests.metrics.sequences import COMPOSITIONS, SEQUENCES, STOPS


def flight_of(sequence, **more):
    return Flight(
        faults=sequence.faults,
        declared=sequence.declared,
        alarm=sequence.alarms,
        isolates=sequence.isolates,
        departed=sequence.departed,
        **more,
    )


@pytest.mark.parametrize("sequence", SEQUENCES, ids=lambda s: f"{s.number}: {s.case}")
def test_every_printed_value(sequence):
    scores = score(flight_of(sequence))
    printed = {
        "outcome": sequence.outcome,
        "false_alarm_time_s": sequence.false_alarm,
        "alarm_time_s": sequence.alarm,
        "detection_time_s": sequence.detection,
        "wrong_site_time_s": sequence.wrong_site,
        "detection_time_limit_s": sequence.limit,
        "isolated": sequence.isolated,
        "over_declared": sequence.over_declared,
    }
    assert {name: scores[name] for name in printed} == printed
    if sequence.events:
        assert [(event["detection_time_s"], event["outcome"]) for event in scores["events"]] == list(sequence.events)


def test_all_of_them_are_here():
    assert [sequence.number for sequence in SEQUENCES] == list(range(1, 48))
    assert len(COMPOSITIONS) == 10


@pytest.mark.parametrize("sequence", [s for s in SEQUENCES if s.number <= 16 and "r2" not in s.verdict])
def test_one_site_in_the_whole_benchmark(sequence):
    scores = score(flight_of(sequence, sites=("r1",)))
    assert (scores["outcome"], scores["wrong_site_time_s"]) == (sequence.outcome, None)


def test_sites_with_requirements_of_their_own():
    """a: 2, b: 8 samples, both faulty at 10: the flight has the smallest, each event its own."""
    own = {"a": 2, "b": 8}
    flight = Flight(
        faults=((("a", 10, None),), (("b", 10, None),)),
        declared=(frozenset(),) * 20,
        sites=("a", "b"),
        requirement=lambda sites: min(own[site] for site in sites),
    )
    scores = score(flight)
    assert scores["detection_time_limit_s"] == 2
    assert [event["detection_time_limit_s"] for event in scores["events"]] == [2, 8]


def test_columns_beside_the_printed_ones():
    by_number = {sequence.number: score(flight_of(sequence)) for sequence in SEQUENCES}
    assert by_number[1]["changes"] == 1
    assert by_number[11]["changes"] == 9
    assert by_number[15]["changes"] == 1
    assert by_number[16]["changes"] == 0
    assert (by_number[41]["changes"], by_number[41]["n_declared"], by_number[41]["isolated"]) == (2, 0, None)
    assert by_number[38]["changes"] is None
    assert by_number[38]["flight_s"] == 7
    assert (by_number[23]["onset_s"], by_number[23]["n_faulty"], by_number[23]["faulty_sites"]) == (10, 2, "r1+r2")
    assert (by_number[18]["n_declared"], by_number[18]["declared_sites"]) == (2, "r1+r2")
    assert by_number[3]["normalized_detection_time"] == 6 / 5
    assert (by_number[45]["onset_s"], by_number[45]["n_faulty"], by_number[45]["changes"]) == (None, 0, None)


def test_margins_and_estimates():
    n, half = 20, 0.5
    flight = Flight(
        faults=((("r1", 10, 17),),),
        declared=tuple(frozenset({"r1"} if k >= 12 else ()) for k in range(n)),
        departed=19,
        sample_s=half,
        residual=tuple(range(n)),
        estimate={"r1": tuple(range(n)), "r2": (100.0,) * n},
        added={"r1": tuple(k - (2 if k % 2 else 1) for k in range(n)), "r2": (0.0,) * n},
    )
    scores = score(flight)
    assert (scores["margin_healthy"], scores["margin_faulty"]) == (9, 18)
    # found at 12, so from 14 to 17: errors of 1, 2, 1, 2, and r2 is healthy
    assert scores["estimate_bias"] == 1.5
    assert scores["estimate_rms"] == 2.5**0.5
    assert scores["detection_time_s"] == 1.0


# --- faults on one site, composed a second time ---

RANK = {"freeze": 0, "jam": 0, "bias": 1, "runaway": 1}


def compose(faults):
    """Readings of a site: faults by onset, `replace` before `add`, then by kind; stops last."""
    readings = []
    for k in range(10):
        value = float(k)
        for kind, size, first, last in sorted(faults, key=lambda f: (f[2], RANK[f[0]], f[0])):
            if first <= k and (last is None or k <= last):
                value = _act(kind, size, first, value, k, readings)
        readings.append(min(max(value, STOPS[0]), STOPS[1]))
    return tuple(readings)


def _act(kind, size, first, value, k, readings):
    if kind == "freeze":
        return readings[first - 1] if first > 0 else value if k == 0 else readings[0]
    if kind == "jam":
        return size
    return value + (size if kind == "bias" else size * (k - first))


@pytest.mark.parametrize("composition", COMPOSITIONS, ids=lambda c: " ".join(f[0] for f in c.faults))
def test_every_order_of_the_lines_gives_the_printed_reading(composition):
    for faults in permutations(composition.faults):
        assert compose(faults) == composition.reading
