"""Scores of random verdict histories against a reference that reads the table of columns sample by sample."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.blocks.layout import Nothing
from fddbench.interfaces import Verdict
from fddbench.metrics.rows import Truth, event_columns, score_columns, statuses
from fddbench.metrics.scoring import NEVER, EventTimes, Scoring

SITES = ("r1", "r2", "r3")
T = 0.01
STEADY = settings(deadline=None, derandomize=True, database=None, max_examples=150)


@st.composite
def flights(draw):
    """One flight: truth, verdicts of every sample, departure, faults."""
    n = draw(st.integers(3, 30))
    rows = st.tuples(*[st.integers(0, 1)] * 3)
    changes = draw(st.dictionaries(st.integers(0, n - 1), rows, max_size=4))
    declared, now = [], (0, 0, 0)
    for k in range(n):
        now = changes.get(k, now)
        declared.append(now)
    residual = draw(st.lists(st.floats(0.0, 5.0), min_size=n, max_size=n))
    n_faults = draw(st.integers(0, 2))
    faults = []
    for _ in range(n_faults):
        first = draw(st.integers(0, n - 1))
        last = draw(st.one_of(st.none(), st.integers(first, n + 3)))
        faults.append((first, last, draw(st.lists(st.sampled_from(SITES), min_size=1, max_size=2, unique=True))))
    return {
        "n": n,
        "declared": declared,
        "residual": residual,
        "faults": faults,
        "departed": draw(st.one_of(st.none(), st.integers(0, n + 2))),
        "limit": draw(st.integers(1, n + 2)),
    }


def verdict_of(declared, residual, alarm=None):
    """Verdict on every site, (3, n_cases); alarm: where any is declared."""
    alarm = np.where(np.any(declared, axis=0), 1.0, 0.0) if alarm is None else alarm
    return Verdict(declared, residual, alarm=alarm)


def event_of(first, last, own):
    sites = np.array([[float(site in own)] for site in SITES])
    return EventTimes(first=float(first), last=NEVER if last is None else float(last), own=sites)


def begun(scoring, constants):
    """Constants as a record, and the score before sample 0."""
    c = scoring.constants.unpack(constants)
    return c, scoring.states.spread(scoring.start(c), constants.shape[1])


def score_of(flight, *, tail=4):
    """Columns, status and events as the package scores them; flown `tail` samples past the end, as in a chunk."""
    faults = flight["faults"]
    truly = tuple(s for s in SITES if any(s in own for *_, own in faults))
    scoring = Scoring(3, max(len(faults), 1))
    constants = scoring.rows(
        k0=min((float(first) for first, *_ in faults), default=NEVER),
        n_faulty=len(truly),
        last=float(flight["n"] - 1),
        events=[event_of(*fault) for fault in faults],
        n_cases=1,
    )
    departed = NEVER if flight["departed"] is None else float(flight["departed"])
    c, state = begun(scoring, constants)
    for k in range(flight["n"] + tail):
        # after the end of this flight its neighbours still fly; what is declared then must not count
        declared = flight["declared"][k] if k < flight["n"] else (1, 1, 1)
        residual = flight["residual"][k] if k < flight["n"] else np.nan
        verdict = verdict_of(np.array(declared, float)[:, None], np.array([residual]))
        state, number = scoring.step(state, c, Nothing(), verdict, float(k), np.array([k < departed]))
        assert number.tolist() == [sum(declared)]
    state = scoring.states.pack(state)
    status, reason = statuses(scoring, state, constants, departed=np.array([departed]), infeasible=[""], errors=[""])
    limit_s = round(flight["limit"] * T, 9) if faults else None
    columns = score_columns(
        scoring, state, constants, truth=Truth(faulty_sites=[truly], limit_s=[limit_s], scenario=np.array([0])),
        sites=SITES, status=status, departed=np.array([departed]), sample_s=T,
    )  # fmt: skip
    end = min(flight["n"] - 1.0, departed)
    events = [
        event_columns(
            scoring, state, constants, cases=np.array([0]), event=j, limit_s=limit_s, end=np.array([end]), sample_s=T,
            valid=np.array([True]),
        )
        for j in range(len(faults))
    ]  # fmt: skip
    first, *events = ({name: values[0].as_py() for name, values in each.items()} for each in (columns, *events))
    return first, status[0], reason[0], events


def reference(flight):
    """The table of columns, read word by word, with Python loops."""
    faults, limit = flight["faults"], flight["limit"]
    truly = {site for *_, own in faults for site in own}
    scored = [k for k in range(flight["n"]) if flight["departed"] is None or k < flight["departed"]]
    left = flight["departed"] is not None and flight["departed"] <= flight["n"] - 1
    k0 = min((first for first, *_ in faults), default=None)
    sites = {k: {s for s, on in zip(SITES, flight["declared"][k], strict=True) if on} for k in range(flight["n"])}
    final = sites[scored[-1]] if scored else set()
    healthy = [k for k in scored if k0 is None or k < k0]
    faulty = [k for k in scored if k0 is not None and k >= k0]
    alarm = next((k for k in faulty if sites[k]), None)
    detection = next((k for k in faulty if len(sites[k]) == len(truly)), None)
    out = {
        "n_faulty": len(truly),
        "faulty_sites": "+".join(s for s in SITES if s in truly) or None,
        "onset_s": None if k0 is None else round(k0 * T, 9),
        "detection_time_limit_s": None if k0 is None else round(limit * T, 9),
    }
    if left and detection is None:
        return out, "diverged"
    out |= {
        "n_declared": len(final),
        "declared_sites": "+".join(s for s in SITES if s in final) or None,
        "false_alarm": any(sites[k] for k in healthy),
        "margin_healthy": None if k0 == 0 else max((flight["residual"][k] for k in healthy), default=0.0),
    }
    if k0 is not None:
        censored = detection is None and flight["n"] - 1 - k0 < limit
        out |= {
            "first_alarm_time_s": None if alarm is None else round((alarm - k0) * T, 9),
            "detection_time_s": None if detection is None else round((detection - k0) * T, 9),
            "normalized_detection_time": None if detection is None else pytest.approx((detection - k0) / limit),
            "detected": alarm is not None,
            "classified": len(final) == len(truly),
            "isolated": final == truly,
            "false_isolation": bool(final - truly),
            "over_declared": any(len(sites[k]) > len(truly) for k in faulty),
            "missed": None if censored else detection is None or detection - k0 > limit,
            "censored": censored,
            "margin_faulty": max((flight["residual"][k] for k in faulty), default=0.0),
        }
    return out, "ok"


@STEADY
@given(flights())
def test_every_column_is_what_the_table_says(flight):
    columns, status, reason, _ = score_of(flight)
    expected, expected_status = reference(flight)
    assert status == expected_status
    assert (reason is None) == (status == "ok")
    columns.pop("flight_s")
    for name, value in columns.items():
        assert value == expected.get(name), name
    assert set(expected) <= set(columns)


@STEADY
@given(flights())
def test_every_event_is_scored_on_its_own_sites_and_interval(flight):
    _, status, _, events = score_of(flight)
    if status != "ok":
        return
    end = flight["n"] - 1 if flight["departed"] is None else min(flight["n"] - 1, flight["departed"] - 1)
    for event, (first, last, own) in zip(events, flight["faults"], strict=True):
        samples = [k for k in range(first, end + 1) if last is None or k <= last]
        hits = {k: sum(on for s, on in zip(SITES, flight["declared"][k], strict=True) if s in own) for k in samples}
        alarm = next((k for k in samples if hits[k]), None)
        detection = next((k for k in samples if hits[k] == len(own)), None)
        assert event["first_alarm_time_s"] == (None if alarm is None else round((alarm - first) * T, 9))
        assert event["detection_time_s"] == (None if detection is None else round((detection - first) * T, 9))
        assert event["detected"] == (alarm is not None)
        if detection is not None:
            assert event["missed"] == (detection - first > flight["limit"])
            assert event["censored"] is False


def flight_of(n, declared, **more):
    base = {"n": n, "declared": [declared(k) for k in range(n)], "residual": [0.1] * n, "departed": None, "limit": 10}
    return base | {"faults": []} | more


R1 = (1, 0, 0)
R12 = (1, 1, 0)
NONE = (0, 0, 0)


@pytest.mark.parametrize(("at", "missed"), [(14, False), (15, False), (16, True)])
def test_a_detection_exactly_at_the_limit_is_in_time(at, missed):
    row, *_ = score_of(flight_of(40, lambda k: R1 if k >= at else NONE, faults=[(5, None, ["r1"])]))
    assert row["detection_time_s"] == round((at - 5) * T, 9)
    assert (row["missed"], row["censored"]) == (missed, False)
    assert row["normalized_detection_time"] == pytest.approx((at - 5) / 10)


@pytest.mark.parametrize(("n", "censored"), [(15, True), (16, False)])
def test_a_flight_that_ends_before_the_limit_is_censored(n, censored):
    row, *_ = score_of(flight_of(n, lambda k: NONE, faults=[(5, None, ["r1"])]))
    assert row["censored"] == censored
    assert row["missed"] is (None if censored else True)
    assert row["detection_time_s"] is None


def test_one_faulty_sensor_declared_as_two_is_over_declared_even_if_it_was_right_before():
    row, *_ = score_of(flight_of(30, lambda k: R12 if k > 9 else R1 if k > 7 else NONE, faults=[(5, None, ["r1"])]))
    assert row["over_declared"]
    assert not row["classified"]
    assert row["false_isolation"]
    assert row["detection_time_s"] == 0.03


def test_an_alarm_before_the_onset_is_false_and_the_time_counts_from_the_onset():
    row, *_ = score_of(flight_of(30, lambda k: R1 if k >= 2 else NONE, faults=[(5, None, ["r1"])]))
    assert row["false_alarm"]
    assert row["first_alarm_time_s"] == row["detection_time_s"] == 0.0


def test_onset_at_the_first_and_at_the_last_sample():
    first, *_ = score_of(flight_of(20, lambda k: R1, faults=[(0, None, ["r1"])]))
    assert (first["false_alarm"], first["detection_time_s"], first["margin_healthy"]) == (False, 0.0, None)
    last, *_ = score_of(flight_of(20, lambda k: R1 if k == 19 else NONE, faults=[(19, None, ["r1"])]))
    assert (last["false_alarm"], last["detection_time_s"], last["margin_faulty"]) == (False, 0.0, 0.1)


def test_a_healthy_flight_has_nulls_in_all_fault_columns():
    row, status, *_ = score_of(flight_of(20, lambda k: R1 if k == 9 else NONE))
    assert status == "ok"
    assert row["n_faulty"] == 0
    assert row["false_alarm"]
    known = {"flight_s", "n_faulty", "n_declared", "false_alarm", "margin_healthy"}
    assert {name for name, value in row.items() if value is not None} == known


@pytest.mark.parametrize(("departed", "status"), [(12, "ok"), (8, "ok"), (7, "diverged"), (20, "ok"), (25, "ok")])
def test_a_departure_after_the_detection_is_scored_and_before_it_has_diverged(departed, status):
    """Detected at sample 7: a departure at 7 comes first, one at 8 does not; 20 is after the end of the flight."""
    flight = flight_of(
        20, lambda k: R12 if k > 14 else R1 if k >= 7 else NONE, faults=[(5, None, ["r1"])], departed=departed
    )
    row, found, reason, _ = score_of(flight)
    assert found == status
    if status == "ok":
        assert row["over_declared"] == (departed > 15)
    else:
        assert reason == f"the flight departed at sample {departed}"
        kept = {"n_faulty", "faulty_sites", "onset_s", "detection_time_limit_s"}
        assert {name for name, value in row.items() if value is not None} == kept


def test_a_healthy_flight_that_departs_has_diverged():
    assert score_of(flight_of(20, lambda k: NONE, departed=12))[1] == "diverged"


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_verdict_that_is_no_number_gives_no_score(bad):
    flight = flight_of(20, lambda k: R1 if k >= 7 else NONE, faults=[(5, None, ["r1"])])
    flight["residual"][3] = bad
    row, status, reason, _ = score_of(flight)
    assert status == "nonfinite"
    assert "not a finite number" in reason
    assert row["detected"] is None
    assert row["margin_healthy"] is None


@STEADY
@given(st.lists(flights(), min_size=2, max_size=4))
def test_a_case_alone_scores_as_in_company(many):
    """Flights of different lengths and faults side by side."""
    scoring, alone = Scoring(3, 2), []
    columns = []
    for flight in many:
        events = [event_of(*fault) for fault in flight["faults"]]
        k0 = min((float(first) for first, *_ in flight["faults"]), default=NEVER)
        n_faulty = len({s for *_, own in flight["faults"] for s in own})
        columns.append(scoring.rows(k0=k0, n_faulty=n_faulty, last=flight["n"] - 1.0, events=events, n_cases=1))
    constants, longest = np.concatenate(columns, axis=1), max(flight["n"] for flight in many)

    def run(which):
        c, state = begun(scoring, constants[:, which])
        for k in range(longest):
            each = [many[i] for i in which]
            declared = np.array([f["declared"][min(k, f["n"] - 1)] for f in each], float).T
            residual = np.array([f["residual"][min(k, f["n"] - 1)] for f in each])
            alive = np.array([f["departed"] is None or k < f["departed"] for f in each])
            state, _ = scoring.step(state, c, Nothing(), verdict_of(declared, residual), float(k), alive)
        return scoring.states.pack(state)

    together = run(list(range(len(many))))
    alone = np.concatenate([run([i]) for i in range(len(many))], axis=1)
    assert together.tobytes() == alone.tobytes()


def scored(verdicts, *, n_faulty=1, k0=0.0, events=(), n_cases=1):
    """Score after these verdicts, one a sample."""
    scoring = Scoring(3, len(events))
    constants = scoring.rows(k0=k0, n_faulty=n_faulty, last=len(verdicts) - 1.0, events=events, n_cases=n_cases)
    c, state = begun(scoring, constants)
    for k, verdict in enumerate(verdicts):
        state, _ = scoring.step(state, c, Nothing(), verdict, float(k), np.ones(n_cases, bool))
    scoring.states.check(state, n_cases)
    return state


def test_a_plug_in_may_declare_with_booleans():
    state = scored([verdict_of(np.array([[True], [True], [False]]), np.ones(1), np.array([True]))])
    assert (state.over_declared[0], state.first_alarm[0], state.nonfinite[0]) == (1.0, 0.0, 0.0)


def test_a_site_that_another_fault_has_made_faulty_is_no_early_alarm():
    """r1 fails at 2 and is declared; the second fault, on r1 and r2 from 5 on, is not declared before its time by that."""
    events = [event_of(2, None, ["r1"]), event_of(5, None, ["r1", "r2"])]
    declared = [np.array([[k >= 3, k >= 3], [k >= 6, k >= 4], [False, False]]) for k in range(10)]
    verdicts = [verdict_of(each, np.ones(2)) for each in declared]
    state = scored(verdicts, k0=2.0, n_faulty=2, events=events, n_cases=2)
    assert state.events[0].early.tolist() == [0.0, 0.0]
    assert state.events[1].early.tolist() == [0.0, 1.0]


@pytest.mark.parametrize("value", [0.5, 2.0, -1.0, np.nan])
def test_a_verdict_is_zero_or_one_and_is_not_repaired(value):
    none, quiet = np.zeros((3, 1)), np.zeros(1)
    declared = np.array([[0.0], [value], [0.0]])
    assert scored([verdict_of(declared, quiet, quiet)]).nonfinite[0] == 1.0
    assert scored([verdict_of(none, quiet, np.array([value]))]).nonfinite[0] == 1.0
    assert scored([verdict_of(none, quiet, quiet)]).nonfinite[0] == 0.0


def test_an_alarm_without_a_declaration_is_an_alarm():
    """A detector that only detects: its alarm is scored, and it declares nothing."""
    none = np.zeros((3, 1))
    verdicts = [verdict_of(none, np.zeros(1), np.array([float(k in (3, 7, 8))])) for k in range(10)]
    state = scored(verdicts, k0=5.0)
    assert (state.false_alarm[0], state.first_alarm[0], state.detection[0]) == (1.0, 7.0, NEVER)
    assert not state.declared.any()
