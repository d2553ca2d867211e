"""From scores to columns: statuses in their order of precedence, site order, times without binary dust."""

from dataclasses import replace

import numpy as np
import pytest

from fddbench.interfaces import NEVER
from fddbench.metrics.found import BEFORE
from fddbench.metrics.rows import event_columns, score_columns, statuses
from fddbench.metrics.score import FaultScore, FaultTimes
from fddbench.metrics.scoring import SITES as OF_SITES
from fddbench.metrics.scoring import Scoring
from fddbench.results.schema import STATUSES

SITES = ("r1", "r2", "r3")


def times_of(first, last, own):
    return FaultTimes(first=first, last=last, own=np.array(own)[:, np.newaxis])


def scored(
    n_cases=1, *, faults=((200.0, NEVER, (1.0, 1.0, 0.0)),), found=(NEVER,), last=1000.0, sample_s=0.01, **state
):
    """Scoring, its score with some fields set, and its constants; packed."""
    scoring = Scoring(SITES, max(len(faults), 1), sample_s)
    faulty_from = np.full((3, 1), NEVER)
    for first, _, own in faults:
        faulty_from = np.minimum(faulty_from, np.where(np.array(own)[:, np.newaxis] > 0.0, first, NEVER))
    times = [times_of(*one) for one in faults]
    constants = scoring.rows(last=last, faults=times, faulty_from=faulty_from, n_cases=n_cases)
    start = scoring.start(scoring.constants.unpack(constants))
    each = tuple(FaultScore(found=number, sums=start.faults[0].sums) for number in found)
    score = replace(start, faults=each, **state)
    return scoring, scoring.states.pack(scoring.states.spread(score, n_cases), n_cases), constants


def columns(scoring, score, constants, *, limit_s=0.36, departed=NEVER, status="ok"):
    given = {"limit_s": np.array([limit_s]), "departed": np.array([departed]), "status": [status]}
    found = score_columns(scoring, score, constants, **given)
    return {name: values[0].as_py() for name, values in found.items()}


def one_event(scoring, score, constants, *, event, limit_s, departed=NEVER):
    given = {"limit_s": np.array([limit_s]), "departed": np.array([departed]), "valid": np.array([True])}
    return {n: v[0].as_py() for n, v in event_columns(scoring, score, constants, event=event, **given).items()}


def test_the_first_reason_not_to_score_wins():
    scoring, score, _ = scored(4, nonfinite=np.array([1.0, 1.0, 1.0, 0.0]))
    found, reasons = statuses(
        scoring, score, infeasible=["too fast", "", "", ""], errors=["ValueError: x"] * 2 + [""] * 2
    )
    assert found == ["infeasible", "error", "nonfinite", "ok"]
    assert reasons[:2] == ["too fast", "ValueError: x"]
    assert "not a finite number" in reasons[2]
    assert reasons[3] is None


@pytest.mark.parametrize("status", STATUSES[1:])
def test_every_status_but_ok_has_no_score(status):
    row = columns(*scored(found=(210.0,), raised=210.0, over_declared=1.0, wrong=220.0), status=status)
    truth = {"n_faulty": 2, "faulty_sites": "r1+r2", "onset_s": 2.0, "detection_time_limit_s": 0.36, "watched": True}
    assert {name: value for name, value in row.items() if value is not None} == truth


@pytest.mark.parametrize(
    ("declared", "names", "isolated"),
    [
        ([0, 0, 0], None, False),
        ([1, 0, 0], "r1", False),
        ([1, 1, 0], "r1+r2", True),
        ([0, 1, 1], "r2+r3", False),
        ([1, 1, 1], "r1+r2+r3", False),
    ],
)
def test_final_declaration(declared, names, isolated):
    row = columns(*scored(declared=np.array(declared, float)[:, None]))
    assert (row["declared_sites"], row["n_declared"], row["isolated"]) == (names, sum(declared), isolated)


@pytest.mark.parametrize("sample_s", [0.001, 0.005, 0.01, 0.02, 0.04])
@pytest.mark.parametrize("n", [1, 3, 7, 9, 18, 36])
def test_times_are_decimal_and_compare_with_the_limit_as_such(sample_s, n):
    limit_s = n * sample_s  # with the dust of binary fractions
    at = columns(*scored(found=(200.0 + n,), sample_s=sample_s), limit_s=limit_s)
    assert (at["detection_time_s"], at["outcome"], at["normalized_detection_time"]) == (round(limit_s, 9), "right", 1.0)
    assert at["detection_time_limit_s"] == round(limit_s, 9)
    assert columns(*scored(found=(201.0 + n,), sample_s=sample_s), limit_s=limit_s)["outcome"] == "late"
    just, short = ({"last": 200.0 + n + more, "sample_s": sample_s} for more in (0.0, -1.0))
    assert columns(*scored(**just), limit_s=limit_s)["outcome"] == "missed"
    assert columns(*scored(**short), limit_s=limit_s)["outcome"] == "undecided"


def test_nothing_is_nan():
    for row in (columns(*scored()), columns(*scored(faults=(), found=(NEVER,)), limit_s=np.nan)):
        assert not any(isinstance(value, float) and value != value for value in row.values())


def test_flight_s_is_the_last_scored_sample():
    assert columns(*scored())["flight_s"] == 10.0
    assert columns(*scored(), departed=2000.0)["departed_s"] is None
    row = columns(*scored(), departed=500.0)
    assert (row["flight_s"], row["departed_s"], row["outcome"]) == (4.99, 5.0, "missed")


def test_an_event_is_judged_by_its_own_onset_end_and_limit():
    faults = ((200.0, 219.0, (1.0, 0.0, 0.0)), (300.0, NEVER, (0.0, 1.0, 0.0)))
    given = scored(faults=faults, found=(NEVER, NEVER))
    assert one_event(*given, event=0, limit_s=0.36)["outcome"] == "missed"  # it is over, whatever its limit
    assert one_event(*given, event=1, limit_s=0.36)["outcome"] == "missed"
    assert one_event(*given, event=1, limit_s=120.0)["outcome"] == "undecided"
    found = scored(faults=faults, found=(210.0, BEFORE))
    first, second = (one_event(*found, event=j, limit_s=0.1) for j in (0, 1))
    assert (first["outcome"], first["detection_time_s"], first["normalized_detection_time"]) == ("right", 0.1, 1.0)
    assert (second["outcome"], second["detection_time_s"]) == ("declared_before", None)


def test_an_event_that_the_flight_did_not_reach_is_undecided_not_declared_before():
    faults = ((200.0, NEVER, (1.0, 0.0, 0.0)), (300.0, NEVER, (1.0, 0.0, 0.0)))
    given = scored(faults=faults, found=(210.0, BEFORE), last=250.0)
    assert one_event(*given, event=1, limit_s=0.36)["outcome"] == "undecided"


def test_a_departure_exactly_at_the_limit():
    """Departed at 336: the last scored sample is 335, one before the limit of 36 samples; taking the aircraft is no excuse."""
    given = scored(faults=((300.0, NEVER, (0.0, 1.0, 0.0)),))
    assert one_event(*given, event=0, limit_s=0.36, departed=336.0)["outcome"] == "missed"
    assert one_event(*given, event=0, limit_s=0.36, departed=300.0)["outcome"] == "undecided"


@pytest.mark.parametrize(("units", "bias"), [(("deg", "deg", "N"), 2.0), (("deg", "N", "N"), None)])
def test_errors_of_estimates_in_two_units_have_no_common_mean(units, bias):
    """The faults of r1 and r2 were found, each with two samples of an error of 2 in its own unit."""
    scoring = Scoring(SITES, 2, 0.01, estimates=OF_SITES, units=units)
    times = [times_of(200.0, NEVER, own) for own in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))]
    faulty_from = np.array([[200.0], [200.0], [NEVER]])
    constants = scoring.rows(last=1000.0, faults=times, faulty_from=faulty_from, n_cases=1)
    each = (FaultScore(found=210.0, sums=(2.0, 4.0, 8.0)),) * 2
    score = replace(scoring.start(scoring.constants.unpack(constants)), faults=each)
    packed = scoring.states.pack(scoring.states.spread(score, 1), 1)
    assert columns(scoring, packed, constants)["estimate_bias"] == bias
    assert one_event(scoring, packed, constants, event=1, limit_s=1.0)["estimate_bias"] == 2.0
