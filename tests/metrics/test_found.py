"""Law: one pass with a number for each fault says what looking back over the whole flight says."""

import numpy as np
import pytest
from hypothesis import given, settings
from tests.metrics import independent
from tests.metrics.flights import SITES, flights, random_flights
from tests.metrics.scored import constants_of, flown, role, said_of, scoring_of
from tests.metrics.sequences import SEQUENCES
from tests.metrics.test_sequences import flight_of

from fddbench.interfaces import NEVER
from fddbench.metrics.found import BEFORE, in_flight


def _numbers(several):
    """Sample, `BEFORE` or None of every fault of flights that fly together, as the independent scorer says it."""
    scoring = scoring_of(*role(several[0]))
    constants = np.concatenate([constants_of(scoring, flight) for flight in several], axis=1)
    said = np.stack([said_of(flight) for flight in several], axis=2)
    departed = np.array([NEVER if flight.departed is None else float(flight.departed) for flight in several])
    x = scoring.states.unpack(flown(scoring, constants, said, departed, "numpy"))
    c = scoring.constants.unpack(constants)
    last = np.array([float(flight.last) for flight in several])
    found = [
        in_flight(one.found, first=times.first, last_scored=last) for one, times in zip(x.faults, c.faults, strict=True)
    ]
    names = {NEVER: None, BEFORE: independent.BEFORE}
    return [
        [names.get(float(found[j][i]), float(found[j][i])) for j in range(len(flight.faults))]
        for i, flight in enumerate(several)
    ]


def _looking_back(flight):
    return [independent.found(flight, fault) for fault in flight.faults]


def _wrong(several):
    """Flights of both kinds of detectors that are answered otherwise than by looking back."""
    wrong = []
    for isolates in (True, False):
        some = [flight for flight in several if flight.isolates == isolates]
        answers = zip(some, _numbers(some), strict=True) if some else ()
        wrong += [(flight, mine) for flight, mine in answers if mine != _looking_back(flight)]
    return wrong


@settings(max_examples=200, deadline=None)
@given(flights())
def test_one_pass_finds_what_looking_back_finds(flight):
    assert _numbers([flight]) == [_looking_back(flight)]


@pytest.mark.slow
def test_twenty_thousand_flights_in_one_chunk():
    several = random_flights(20_000)
    assert _wrong(several)[:3] == []
    # every answer is given often, by detectors that isolate and by those that only detect
    for isolates in (True, False):
        said = [k for flight in several if flight.isolates == isolates for k in _looking_back(flight)]
        assert min(said.count(None), said.count(independent.BEFORE), sum(isinstance(k, int) for k in said)) > 300


def test_the_printed_sequences_together_in_one_chunk():
    assert _wrong([flight_of(sequence) for sequence in SEQUENCES]) == []


@settings(max_examples=200)
@given(flights())
def test_the_largest_number_is_that_of_the_flight(flight):
    if not flight.faults:
        return
    found = [{None: NEVER, independent.BEFORE: BEFORE}.get(k, k) for k in _looking_back(flight)]
    outcome, at = independent.judged(flight, flight.faults)
    assert (max(found) == NEVER) == (outcome in ("missed", "undecided"))
    assert (max(found) == BEFORE) == (outcome == independent.BEFORE)
    if at is not None:
        assert max(found) == at


WRITTEN = [
    [[("r1", 1, None)]],
    [[("r1", 1, None), ("r2", 2, None)]],
    [[("r1", 1, 2)], [("r1", 3, 3)]],
    [[("r1", 0, 2)], [("r2", 2, None)]],
    [[("r1", 0, 1)], [("r1", 3, None), ("r2", 2, None)]],
    [[("r2", 1, 3)], [("r1", 5, None)]],
]


@pytest.mark.parametrize("written", WRITTEN, ids=str)
def test_every_short_flight(written):
    """All verdicts of five samples on two sites for faults that delay, end, return and stand elsewhere: 4^5 a set."""
    sets = [frozenset(), frozenset({"r1"}), frozenset({"r2"}), frozenset({"r1", "r2"})]
    faults, several = tuple(tuple(fault) for fault in written), []
    for code in range(4**5):
        declared = tuple(sets[code // 4**k % 4] for k in range(5))
        alarm = tuple(bool(said) for said in declared)
        common = {"faults": faults, "alarm": alarm, "sites": SITES}
        several.append(independent.Flight(declared=declared, **common))
        several.append(independent.Flight(declared=(frozenset(),) * 5, isolates=False, **common))
    assert _wrong(several)[:3] == []
