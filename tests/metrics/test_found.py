"""Law: one pass with a number for each fault says what looking back over the whole flight says."""

import numpy as np
import pytest
from hypothesis import given, settings
from tests.metrics import independent
from tests.metrics.flights import SITES, faulty_from_of, flights, random_flights
from tests.metrics.sequences import SEQUENCES
from tests.metrics.test_sequences import flight_of

from fddbench.blocks.kernel import Addresses, build
from fddbench.blocks.layout import ROW, Layout, Row, Rows, record
from fddbench.blocks.program import trace
from fddbench.metrics.found import (
    BEFORE,
    NEVER,
    changed,
    found_by_alarm,
    found_by_sites,
    in_flight,
    outside,
)

N_FAULTS = 3


@record
class OfFault:
    """Its sites (1 or 0), first and last faulty sample."""

    own: Rows
    first: Row
    last: Row


@record
class Told:
    """Sample from which each site is faulty, last scored sample, and the faults."""

    faulty_from: Rows
    last_scored: Row
    faults: tuple[OfFault, ...]


@record
class Seen:
    """What was said at the sample before, the numbers of every fault by both rules, and the sample."""

    previous: Rows
    alarm_before: Row
    by_sites: Rows
    by_alarm: Rows
    sample: Row


CONSTANTS = Layout(Told(faulty_from=3, last_scored=ROW, faults=(OfFault(own=3, first=ROW, last=ROW),) * N_FAULTS))
STATES = Layout(Seen(previous=3, alarm_before=ROW, by_sites=N_FAULTS, by_alarm=N_FAULTS, sample=ROW))


def _fault(fault):
    lasts = [last for *_, last in fault]
    own = {site for site, *_ in fault}
    return OfFault(
        own=np.array([[float(site in own)] for site in SITES]),
        first=float(independent.onset(fault)) if fault else NEVER,
        last=NEVER if not lasts or None in lasts else float(max(lasts)),
    )


def _constants(flight):
    """Rows of one flight, (n_rows,)."""
    faults = [*flight.faults, *[()] * (N_FAULTS - len(flight.faults))]
    told = Told(
        faulty_from=np.array(faulty_from_of(flight), dtype=float)[:, np.newaxis],
        last_scored=float(flight.last),
        faults=tuple(_fault(fault) for fault in faults),
    )
    return CONSTANTS.pack(told)[:, 0]


def _step(state, constants, declared, alarm):
    """One sample of both rules; the alarm is what the detector says or any declared site."""
    x, c = STATES.unpack(state), CONSTANTS.unpack(constants)
    alarm = np.maximum(alarm, np.max(declared, axis=0))
    wrong, news = outside(declared, c.faulty_from, x.sample), changed(declared, x.previous)
    active = x.sample <= c.last_scored
    by_sites, by_alarm = [], []
    for j, fault in enumerate(c.faults):
        of_fault = {"first": fault.first, "last": fault.last, "sample": x.sample, "active": active}
        by_sites.append(found_by_sites(x.by_sites[j], fault.own, declared, wrong=wrong, news=news, **of_fault))
        by_alarm.append(found_by_alarm(x.by_alarm[j], alarm, x.alarm_before, **of_fault))
    return STATES.pack(
        Seen(
            previous=declared,
            alarm_before=alarm,
            by_sites=np.stack(by_sites),
            by_alarm=np.stack(by_alarm),
            sample=x.sample + 1.0,
        )
    )


def _start(n_cases):
    return STATES.pack(Seen(previous=0.0, alarm_before=0.0, by_sites=NEVER, by_alarm=NEVER, sample=0.0), n_cases)


def _recording(flight, n):
    """Declared sites and alarm, (4, n); what is flown past the end of a flight, as in a chunk, says anything."""
    rows = [
        [float(site in said) for site in SITES] + [float(on)]
        for said, on in zip(flight.declared, flight.alarm, strict=True)
    ]
    return np.array(rows + [[1.0, 0.0, 1.0, 1.0]] * (n - len(rows))).T


def _numbers(flight, state):
    """Sample, `BEFORE` or None of every fault, as the independent scorer says it."""
    x, c = STATES.unpack(state), CONSTANTS.unpack(_constants(flight))
    names = {NEVER: None, BEFORE: independent.BEFORE}
    rows = x.by_sites if flight.isolates else x.by_alarm
    found = [
        float(in_flight(rows[j], first=c.faults[j].first, last_scored=c.last_scored)) for j in range(len(flight.faults))
    ]
    return [names.get(number, number) for number in found]


def _flown(several, n=None):
    """State of many flights after flying them together in plain NumPy, some samples past their end, (n_rows, n_flights)."""
    n = n or max(len(flight.declared) for flight in several) + 3
    constants = np.stack([_constants(flight) for flight in several], axis=1)
    said = np.stack([_recording(flight, n) for flight in several], axis=2)
    state = _start(len(several))
    for k in range(n):
        state = _step(state, constants, said[:3, k], said[3, k])
    return state


def _looking_back(flight):
    return [independent.found(flight, fault) for fault in flight.faults]


@settings(max_examples=300)
@given(flights())
def test_one_pass_finds_what_looking_back_finds(flight):
    assert _numbers(flight, _flown([flight])[:, 0]) == _looking_back(flight)


def test_twenty_thousand_flights_in_one_chunk():
    several = random_flights(20_000)
    state = _flown(several)
    answers = [(_numbers(flight, state[:, i]), _looking_back(flight)) for i, flight in enumerate(several)]
    assert [(i, *pair) for i, pair in enumerate(answers) if pair[0] != pair[1]][:3] == []
    # every answer is given often, by detectors that isolate and by those that only detect
    for isolates in (True, False):
        said = [k for flight, (_, ks) in zip(several, answers, strict=True) if flight.isolates == isolates for k in ks]
        assert min(said.count(None), said.count(independent.BEFORE), sum(isinstance(k, int) for k in said)) > 300


def test_the_printed_sequences_together_in_one_chunk():
    several = [flight_of(sequence) for sequence in SEQUENCES]
    state = _flown(several)
    for i, flight in enumerate(several):
        assert _numbers(flight, state[:, i]) == _looking_back(flight), SEQUENCES[i].case


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


def _every_short_flight():
    """All verdicts of five samples on two sites for faults that delay, end, return and stand elsewhere: 4^5 a set."""
    sets = [frozenset(), frozenset({"r1"}), frozenset({"r2"}), frozenset({"r1", "r2"})]
    written = [
        [[("r1", 1, None)]],
        [[("r1", 1, None), ("r2", 2, None)]],
        [[("r1", 1, 2)], [("r1", 3, 3)]],
        [[("r1", 0, 2)], [("r2", 2, None)]],
        [[("r1", 0, 1)], [("r1", 3, None), ("r2", 2, None)]],
        [[("r2", 1, 3)], [("r1", 5, None)]],
    ]
    for several in written:
        faults = tuple(tuple(fault) for fault in several)
        for code in range(4**5):
            declared = tuple(sets[code // 4**k % 4] for k in range(5))
            for isolates in (True, False):
                alarm = tuple(bool(said) for said in declared)
                yield independent.Flight(
                    faults=faults, declared=declared if isolates else (frozenset(),) * 5, alarm=alarm, isolates=isolates
                )


def test_every_short_flight():
    several = list(_every_short_flight())
    state = _flown(several)
    wrong = [
        (flight, _numbers(flight, state[:, i]), _looking_back(flight))
        for i, flight in enumerate(several)
        if _numbers(flight, state[:, i]) != _looking_back(flight)
    ]
    assert not wrong[:3]


@pytest.mark.parametrize("backend", ["numpy", "llvm"])
def test_it_can_be_traced_and_gives_the_same_bits(backend):
    """What is said stands in constant rows, four a sample, so that the compiled step needs nothing but its counter."""
    if backend == "llvm":
        pytest.importorskip("llvmlite")
    several = [flight_of(sequence) for sequence in SEQUENCES]
    n = 20
    said = np.stack([_recording(flight, n) for flight in several], axis=2)
    constants = np.concatenate(
        [np.stack([_constants(flight) for flight in several], axis=1), said.transpose(1, 0, 2).reshape(4 * n, -1)]
    )

    def step(state, constants):
        sample = STATES.unpack(state).sample
        now = constants[CONSTANTS.size : CONSTANTS.size + 4]
        for k in range(1, n):
            now = np.where(sample == float(k), constants[CONSTANTS.size + 4 * k : CONSTANTS.size + 4 * k + 4], now)
        after = _step(state, constants[: CONSTANTS.size], now[:3], now[3])
        return {"state": after, "y": after}

    program = trace(step, state=STATES.size, constants=len(constants))
    flown = build(program, recorded=("y",), backend=backend).fly(
        _start(len(several)),
        constants,
        np.full(len(several), n, dtype=np.int64),
        Addresses(key=0, run=0, flight=0, scenario=0),
        first=0,
        end=n,
    )
    np.testing.assert_array_equal(flown.recorded["y"][-1], _flown(several, n))
