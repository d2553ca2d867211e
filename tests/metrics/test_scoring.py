"""Law: one pass over a flight gives every column of the independent scorer, in NumPy and in machine code."""

from dataclasses import replace
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.metrics.flights import flights, random_flights
from tests.metrics.independent import Flight, score
from tests.metrics.scored import LONGEST, N_FAULTS, SITES, constants_of, flown, said_of, scores_of, scoring_of
from tests.metrics.sequences import SEQUENCES
from tests.metrics.test_sequences import flight_of

from fddbench.blocks import llvm
from fddbench.interfaces import NEVER, Sample
from fddbench.results.schema import EVENTS, rows_schema

BACKENDS = ["numpy", pytest.param("llvm", marks=pytest.mark.skipif(not llvm.available(), reason="no llvmlite"))]
NUMBERS = st.floats(-9.0, 9.0)


def same(mine, own):
    """Every column that the independent scorer knows; sums of floats to a part in 10^9."""
    assert mine["status"] == "ok"
    for name, value in own.items():
        if name == "events":
            continue
        assert mine[name] == (pytest.approx(value, rel=1e-9, abs=1e-9) if isinstance(value, float) else value), name
    for event, expected in zip(mine["events"], own["events"], strict=True):
        for name, value in event.items():
            wanted = expected[name]
            assert value == (pytest.approx(wanted, rel=1e-9, abs=1e-9) if isinstance(wanted, float) else wanted), name


def with_signals(flight, numbers, kind, sample_s, watches):
    """The flight with residuals and, as told, with estimates of the sites or of a voted signal."""
    n = len(flight.declared)
    names = {"none": (), "sites": SITES, "voted": ("voted",)}[kind]
    rows = [{name: tuple(next(numbers) for _ in range(n)) for name in names} for _ in range(2)]
    return replace(
        flight,
        residual=tuple(next(numbers) for _ in range(n)),
        estimate=rows[0] or None,
        added=rows[1] or None,
        sample_s=sample_s,
        watches=watches,
    )


@st.composite
def whole_flights(draw):
    """Flights with delays, ends, departures and early alarms, isolating or not, with or without an estimate."""
    kind, sample_s = draw(st.sampled_from(["none", "sites", "voted"])), draw(st.sampled_from([1.0, 0.5]))
    watches = draw(st.sampled_from([None, ("r1", "r2")]))
    numbers = iter(lambda: draw(NUMBERS), object())
    return with_signals(draw(flights()), numbers, kind, sample_s, watches)


@pytest.mark.parametrize("backend", BACKENDS)
def test_every_column_is_that_of_the_independent_scorer(backend):
    @settings(max_examples=150, deadline=None)
    @given(st.lists(whole_flights(), min_size=1, max_size=3))
    def holds(several):
        for mine, flight in zip(scores_of(several, backend), several, strict=True):
            same(mine, score(flight))

    holds()


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.slow
def test_thousands_of_flights_side_by_side(backend):
    random = Random(5)
    numbers = iter(lambda: random.gauss(0.0, 1.0), object())
    several = [
        with_signals(
            flight, numbers, random.choice(["none", "sites", "voted"]), 1.0, random.choice([None, ("r2", "r3")])
        )
        for flight in random_flights(4000, seed=5)
    ]
    estimated = 0
    for mine, flight in zip(scores_of(several, backend), several, strict=True):
        same(mine, score(flight))
        estimated += mine["estimate_bias"] is not None
    assert estimated > 300


@pytest.mark.parametrize("backend", BACKENDS)
def test_the_printed_sequences(backend):
    several = [flight_of(sequence, residual=(0.5,) * sequence.n_samples) for sequence in SEQUENCES]
    for mine, flight, sequence in zip(scores_of(several, backend), several, SEQUENCES, strict=True):
        same(mine, score(flight))
        assert mine["outcome"] == sequence.outcome, sequence.case
        printed = (sequence.false_alarm, sequence.alarm, sequence.detection, sequence.wrong_site, sequence.limit)
        times = (
            "false_alarm_time_s",
            "alarm_time_s",
            "detection_time_s",
            "wrong_site_time_s",
            "detection_time_limit_s",
        )
        assert tuple(mine[name] for name in times) == printed, sequence.case
        assert (mine["isolated"], mine["over_declared"]) == (sequence.isolated, sequence.over_declared), sequence.case
        events = tuple((event["detection_time_s"], event["outcome"]) for event in mine["events"])
        assert not sequence.events or events == sequence.events, sequence.case


@pytest.mark.skipif(not llvm.available(), reason="no llvmlite")
@pytest.mark.parametrize("estimates", [None, "sites", "voted"])
@pytest.mark.parametrize("isolates", [True, False])
def test_machine_code_has_the_same_bits(isolates, estimates):
    """Also of a case alone, whatever flies beside it."""
    random = Random(9)
    numbers = iter(lambda: random.gauss(0.0, 1.0), object())
    several = [f for f in random_flights(300, seed=9) if f.isolates == isolates]
    several = [with_signals(flight, numbers, str(estimates).lower(), 1.0, None) for flight in several]
    scoring = scoring_of(isolates, estimates, SITES, 1.0)
    constants = np.concatenate([constants_of(scoring, flight) for flight in several], axis=1)
    said = np.stack([said_of(flight) for flight in several], axis=2)
    departed = np.array([NEVER if flight.departed is None else float(flight.departed) for flight in several])
    together = flown(scoring, constants, said, departed, "numpy")
    assert together.tobytes() == flown(scoring, constants, said, departed, "llvm").tobytes()
    for i in (0, 7):
        alone = flown(scoring, constants[:, [i]], said[:, :, [i]], departed[[i]], "numpy")
        assert alone.tobytes() == together[:, [i]].tobytes()


def test_these_are_all_columns():
    (mine,) = scores_of([flight_of(SEQUENCES[0])])
    identity = {"case", "scenario", "manoeuvre", "fault", "point", "level", "run", "detector", "reason"}
    assert mine.keys() - {"events"} == {field.name for field in rows_schema(())} - identity
    assert set(mine["events"][0]) <= {field.name for field in EVENTS}


def flight(n=20, *, faults=((("r1", 10, None),),), at=12, **more):
    declared = tuple(frozenset({"r1"} if k >= at else ()) for k in range(n))
    return Flight(faults=faults, declared=declared, **more)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("signal", ["residual", "estimate"])
def test_what_is_no_number_gives_no_score(bad, signal):
    numbers = [1.0] * 20
    numbers[3] = bad
    sizes = dict.fromkeys(SITES, tuple(numbers if signal == "estimate" else [1.0] * 20))
    residual = tuple(numbers if signal == "residual" else [1.0] * 20)
    (row,) = scores_of([flight(residual=residual, estimate=sizes, added=dict.fromkeys(SITES, (0.0,) * 20))])
    assert row["status"] == "nonfinite"
    truth = {"n_faulty", "faulty_sites", "onset_s", "detection_time_limit_s", "watched", "status", "events"}
    assert {name for name, value in row.items() if value is not None} == truth


@pytest.mark.parametrize("row", [0, 3])
def test_a_verdict_that_is_neither_0_nor_1_is_said_not_repaired(row):
    scoring = scoring_of(True, None, SITES, 1.0)
    said = said_of(flight())
    said[5, row] = 0.5
    score_ = flown(scoring, constants_of(scoring, flight()), said[:, :, np.newaxis], np.array([NEVER]), "numpy")
    assert scoring.states.unpack(score_).nonfinite[0] == 1.0


def test_a_flight_that_departs_is_scored_up_to_there():
    """Its last sample is the one before; what a detector says when the aircraft is gone says nothing."""
    (row,) = scores_of([flight(at=14, departed=14)])
    assert (row["status"], row["outcome"], row["departed_s"], row["flight_s"]) == ("ok", "missed", 14.0, 13.0)
    (row,) = scores_of([flight(at=13, departed=14)])
    assert (row["outcome"], row["detection_time_s"]) == ("right", 3.0)


def test_a_fault_elsewhere_is_scored_like_any_other():
    (row,) = scores_of([flight(watches=("r2", "r3"))])
    assert (row["watched"], row["outcome"]) == (False, "right")


def test_a_flight_that_alarms_at_once_and_a_signed_residual():
    (row,) = scores_of([flight(at=0, residual=(-3.0,) * 10 + (-2.0,) * 10)])
    assert (row["outcome"], row["false_alarm_time_s"]) == ("false_alarm", 0.0)
    assert (row["margin_healthy"], row["margin_faulty"]) == (-3.0, -2.0)


def test_an_estimate_of_something_that_nobody_votes_is_refused():
    seen = Sample(measured=None, truth={}, departed=np.zeros(1) > 1.0, voted={"r_voted_deg_s": np.zeros(1)})
    with pytest.raises(Exception, match="write 'sites' or one of \\['r_voted_deg_s'\\]"):
        scoring_of(True, "r_vote_deg_s", SITES, 1.0).actual(seen)
    assert scoring_of(True, "sites", SITES, 1.0).actual(seen) is None


def test_there_is_room_for_what_is_tested():
    assert max(len(sequence.declared) for sequence in SEQUENCES) <= LONGEST
    assert max(len(sequence.faults) for sequence in SEQUENCES) <= N_FAULTS
