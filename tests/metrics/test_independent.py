"""Laws of the contract's scores, on the independent scorer: what a flight's row can never say."""

from dataclasses import replace

import pytest
from tests.metrics.flights import random_flights
from tests.metrics.independent import BEFORE, score

FLIGHTS = random_flights(6000, seed=1)
SCORED = [(flight, score(flight)) for flight in FLIGHTS]
FAULTY = {"false_alarm", "wrong_site", "right", "late", "missed", "undecided"}


def test_each_flight_has_one_outcome_and_all_of_them_occur():
    assert {scores["outcome"] for flight, scores in SCORED if flight.faults} == FAULTY
    assert {scores["outcome"] for flight, scores in SCORED if not flight.faults} == {"quiet", "false_alarm"}
    events = {event["outcome"] for _, scores in SCORED for event in scores["events"]}
    assert events == {"right", "late", "missed", "undecided", BEFORE}


def test_more_sites_than_are_faulty_are_a_wrong_site():
    for _, scores in SCORED:
        assert not scores["over_declared"] or scores["wrong_site_time_s"] is not None


def test_outcomes_are_what_the_times_say():
    for _, scores in SCORED:
        time_s, limit_s = scores["detection_time_s"], scores["detection_time_limit_s"]
        if scores["outcome"] == "right":
            assert 0 <= time_s <= limit_s
        elif scores["outcome"] == "late":
            assert time_s > limit_s
        elif scores["outcome"] in ("missed", "undecided"):
            assert time_s is None
        assert (scores["outcome"] == "false_alarm") == (scores["false_alarm_time_s"] is not None)
        assert scores["outcome"] != "wrong_site" or scores["wrong_site_time_s"] is not None


def test_a_detection_begins_with_something_new():
    """What is found has changed the declaration at its sample, so a detection is never free of an alarm."""
    for flight, scores in SCORED:
        if scores["detection_time_s"] is not None:
            k = flight.k0 + int(scores["detection_time_s"])
            said = flight.D if flight.isolates else flight.A
            assert said(k)
            assert said(k) != said(k - 1)
            assert scores["changes"] >= 1


def test_declared_before_without_a_mistake_needs_an_earlier_fault():
    for flight, scores in SCORED:
        if scores["outcome"] in ("false_alarm", "wrong_site"):
            continue
        for fault, event in zip(flight.faults, scores["events"], strict=True):
            if event["outcome"] == BEFORE:
                assert min(first for _, first, _ in fault) > flight.k0


@pytest.mark.parametrize("later", [1, 5])
def test_a_flight_that_begins_later_scores_the_same(later):
    moved = {"onset_s", "flight_s", "false_alarm_time_s", "departed_s"}
    for flight, scores in SCORED[:2000]:
        if flight.last < 0:
            continue
        shifted = replace(
            flight,
            faults=tuple(
                tuple((site, first + later, None if last is None else last + later) for site, first, last in fault)
                for fault in flight.faults
            ),
            declared=(frozenset(),) * later + flight.declared,
            alarm=(False,) * later + flight.alarm,
            departed=None if flight.departed is None else flight.departed + later,
        )
        again = score(shifted)
        for name in scores.keys() - moved - {"events"}:
            assert again[name] == scores[name], (name, flight)
        for name in moved:
            assert again[name] == (None if scores[name] is None else scores[name] + later), (name, flight)
        for event, other in zip(scores["events"], again["events"], strict=True):
            assert other | {"onset_s": None} == event | {"onset_s": None}


def test_the_order_of_the_faults_says_nothing():
    for flight, scores in SCORED[:2000]:
        again = score(replace(flight, faults=flight.faults[::-1]))
        assert again | {"events": scores["events"]} == scores
        assert again["events"][::-1] == scores["events"]


def test_what_comes_after_a_departure_says_nothing():
    for flight, scores in SCORED[:2000]:
        if flight.departed is not None and flight.departed < len(flight.declared):
            n = len(flight.declared)
            declared = flight.declared[: flight.departed] + (frozenset({"r3"}),) * (n - flight.departed)
            if flight.isolates:
                assert score(replace(flight, declared=declared)) == scores


def test_one_fault_that_lasts_is_its_own_event():
    for flight, scores in SCORED:
        if len(flight.faults) == 1 and scores["outcome"] in FAULTY - {"false_alarm", "wrong_site"}:
            (event,) = scores["events"]
            assert event["outcome"] == scores["outcome"]
            assert event["detection_time_s"] == scores["detection_time_s"]
            assert event["detection_time_limit_s"] == scores["detection_time_limit_s"]
