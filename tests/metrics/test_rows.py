"""From scores to columns: statuses in their order of precedence, site order, times without binary dust."""

from dataclasses import replace

import numpy as np
import pytest

from fddbench.metrics.rows import Truth, event_columns, score_columns, statuses
from fddbench.metrics.scoring import NEVER, EventTimes, Scoring

SITES = ("r1", "r2", "r3")


def scored(n_cases=1, *, k0=200.0, n_faulty=2, last=1000.0, events=(), **state):
    """Score state with some rows set, and its constants; packed."""
    scoring = Scoring(3, len(events))
    constants = scoring.rows(k0=k0, n_faulty=n_faulty, last=last, events=events, n_cases=n_cases)
    score = replace(scoring.start(scoring.constants.unpack(constants)), **state)
    packed = scoring.states.pack(scoring.states.spread(score, n_cases), n_cases)
    return scoring, packed, constants


def event_times(first, last, own):
    return EventTimes(first=first, last=last, own=np.array(own)[:, np.newaxis])


def columns(
    scoring, score, constants, *, faulty=("r1", "r2"), limit_s=0.36, departed=NEVER, status="ok", sample_s=0.01
):
    found = score_columns(
        scoring, score, constants, truth=Truth(faulty_sites=[faulty], limit_s=[limit_s], scenario=np.array([0])), sites=SITES,
        status=[status], departed=np.array([departed]), sample_s=sample_s,
    )  # fmt: skip
    return {name: values[0].as_py() for name, values in found.items()}


def one_event(*scored, event, limit_s, end):
    """Columns of one fault of the only case."""
    found = event_columns(
        *scored, cases=np.array([0]), event=event, limit_s=limit_s, end=np.array([end]), sample_s=0.01,
        valid=np.array([True]),
    )  # fmt: skip
    return {name: values[0].as_py() for name, values in found.items()}


def test_the_first_reason_not_to_score_wins():
    scoring, score, constants = scored(5, nonfinite=np.array([1.0, 1.0, 1.0, 1.0, 0.0]))
    found, reasons = statuses(
        scoring, score, constants,
        departed=np.array([1.0, 1.0, 1.0, NEVER, NEVER]),
        infeasible=["too fast", "", "", "", ""],
        errors=["ValueError: x", "ValueError: x", "", "", ""],
    )  # fmt: skip
    assert found == ["infeasible", "error", "diverged", "nonfinite", "ok"]
    assert reasons[:2] == ["too fast", "ValueError: x"]
    assert "sample 1" in reasons[2]
    assert reasons[4] is None


@pytest.mark.parametrize("status", ["infeasible", "diverged", "error", "nonfinite", "memory", "timeout", "crashed"])
def test_every_status_but_ok_has_no_score(status):
    row = columns(*scored(detection=210.0, first_alarm=210.0, over_declared=1.0), status=status)
    truth = {"n_faulty": 2, "faulty_sites": "r1+r2", "onset_s": 2.0, "detection_time_limit_s": 0.36}
    assert {name: value for name, value in row.items() if value is not None} == truth


@pytest.mark.parametrize(
    ("declared", "names", "classified", "isolated", "false_isolation"),
    [
        ([0, 0, 0], None, False, False, False),
        ([1, 0, 0], "r1", False, False, False),
        ([1, 1, 0], "r1+r2", True, True, False),
        ([0, 1, 1], "r2+r3", True, False, True),
        ([1, 1, 1], "r1+r2+r3", False, False, True),
    ],
)
def test_final_declaration(declared, names, classified, isolated, false_isolation):
    row = columns(*scored(declared=np.array(declared, float)[:, None]))
    assert row["declared_sites"] == names
    assert row["n_declared"] == sum(declared)
    found = (row["classified"], row["isolated"], row["false_isolation"])
    assert found == (classified, isolated, false_isolation)


@pytest.mark.parametrize("sample_s", [0.001, 0.005, 0.01, 0.02, 0.04])
@pytest.mark.parametrize("n", [1, 3, 7, 9, 18, 36])
def test_times_are_decimal_and_compare_with_the_limit_as_such(sample_s, n):
    limit_s = round(n * sample_s, 9)
    at = columns(*scored(detection=200.0 + n), limit_s=limit_s, sample_s=sample_s)
    assert at["detection_time_s"] == limit_s
    assert at["missed"] is False
    assert at["normalized_detection_time"] == 1.0
    late = columns(*scored(detection=201.0 + n), limit_s=limit_s, sample_s=sample_s)
    assert late["missed"] is True
    just = columns(*scored(last=200.0 + n), limit_s=limit_s, sample_s=sample_s)
    assert (just["missed"], just["censored"]) == (True, False)
    short = columns(*scored(last=199.0 + n), limit_s=limit_s, sample_s=sample_s)
    assert (short["missed"], short["censored"]) == (None, True)


def test_nothing_is_nan():
    for row in (columns(*scored()), columns(*scored(k0=NEVER, n_faulty=0), faulty=(), limit_s=None)):
        assert not any(isinstance(value, float) and value != value for value in row.values())


def test_flight_s_is_the_scored_length():
    assert columns(*scored())["flight_s"] == 10.0
    assert columns(*scored(detection=210.0), departed=2000.0)["flight_s"] == 10.0
    assert columns(*scored(detection=210.0), departed=500.0)["flight_s"] == pytest.approx(5.0, abs=0.011)


def test_an_event_that_ends_before_its_limit_is_censored_and_one_after_it_is_missed():
    events = [event_times(200.0, 219.0, (1.0, 0.0, 0.0)), event_times(300.0, NEVER, (0.0, 1.0, 0.0))]
    given = scored(events=events)

    def event(number, limit_s, **more):
        return one_event(*given, event=number, limit_s=limit_s, **{"end": 1000.0, **more})

    assert (event(0, 0.36)["censored"], event(0, 0.36)["missed"]) == (True, None)
    assert (event(0, 0.1)["censored"], event(0, 0.1)["missed"]) == (False, True)
    assert (event(1, 0.36)["censored"], event(1, 0.36)["missed"]) == (False, True)
    assert (event(1, 120.0)["censored"], event(1, 120.0)["missed"]) == (True, None)


def test_an_event_cut_off_by_a_departure_exactly_at_its_limit_is_censored():
    """Departed at 336: the last scored sample is 335, one before the limit of 36 samples could pass."""
    events = [event_times(300.0, NEVER, (0.0, 1.0, 0.0))]
    row = one_event(*scored(events=events), event=0, limit_s=0.36, end=335.0)
    assert row["censored"]
