"""The first sentence on constructed tables: it names a best one only where the flights say so."""

TWO = ("one", "other")
FAULTS = ("jam_a", "jam_b")


def test_all_right_is_no_contest(told, sentence):
    text = sentence(told(FAULTS, TWO, 20, lambda *_: "right"))
    assert text.startswith("Both detectors are right in time in all 40 decided faulty flights (at least ")
    assert "fails" not in text
    one = sentence(told(FAULTS, ("one",), 20, lambda *_: "right"))
    assert "It fails in no flight. It never declares a healthy site." in one


def test_all_wrong_is_no_contest_either(told, sentence):
    text = sentence(told(FAULTS, (*TWO, "third"), 20, lambda *_: "wrong_site"))
    assert text.startswith(
        "None of 3 detectors is ever right in time in 40 decided faulty flights. one fails most in jam_a: 20 of 20"
    )
    assert "In 40 flights it declares a healthy site." in text


def test_a_tie_is_not_decided(told, sentence):
    half = told(FAULTS, TWO, 20, lambda s, d, run: "right" if run < 10 else "missed")
    assert sentence(half).startswith("Not decided: one and other are right in the same flights, 50.0 % of 40")
    four = told(
        FAULTS, (*TWO, "third", "fourth"), 20, lambda s, d, run: "right" if run < 10 and d != "fourth" else "missed"
    )
    assert " and other are right in the same flights, third as often, 50.0 % of 40" in sentence(four)
    assert "). one fails most in jam_a: 10 of 20 flights, as often in 1 more scenario." in sentence(half)
    apart = told(FAULTS, TWO, 20, lambda s, d, run: "right" if (run < 10) == (d == "one") else "missed")
    assert sentence(apart).startswith(
        "Not decided between one and other, 50.0 and 50.0 % of faulty flights right in time (p = 1)"
    )


def test_the_best_is_best_when_the_same_flights_say_so(told, sentence):
    text = sentence(
        told(FAULTS, TWO, 20, lambda s, d, run: "right" if d == "other" or (run < 4 and s == "jam_a") else "missed")
    )
    assert text.startswith("Best of 2: other, 100 % of 40 decided faulty flights right in time (")
    close = told(FAULTS, TWO, 20, lambda s, d, run: "right" if d == "other" or run > 2 else "missed")
    assert sentence(close).startswith("Not decided between other and one, 100 and 85.0 %")


def test_nothing_decided_is_no_rate(told, sentence):
    text = sentence(told(FAULTS, TWO, 5, lambda *_: "undecided"))
    assert text.startswith(
        "Not decided: all 10 faulty flights end before the limit of their fault without a declaration."
    )
    assert "No false alarm of any detector in 5 distinct flights" in text
    assert "%" not in text.split("No false alarm")[0]


def test_one_flight_has_no_interval(told, sentence):
    one = sentence(told(("jam_a",), ("one",), 1, lambda *_: "right"))
    assert one.startswith("one: 100 % of 1 decided faulty flight right in time (one run: no interval).")
    two = sentence(told(("jam_a",), TWO, 1, lambda s, d, run: "right" if d == "one" else "missed"))
    assert two.startswith(
        "Of these flights one is right in time in 100 %, other in 0 %; of other flights one run proves nothing."
    )


def test_without_faults_it_speaks_of_false_alarms(told, sentence):
    quiet = sentence(told(("healthy", "healthy_turn"), TWO, 30, lambda *_: "quiet"))
    assert quiet.startswith("No false alarm of any detector in ")
    loud = told(("healthy_turn",), TWO, 30, lambda s, d, run: "false_alarm" if d == "one" and run < 3 else "quiet")
    text = sentence(loud)
    assert "False alarms: one in 3 of 30 (10 %), fewest other in 0 of 30 (0 %); most in healthy_turn: 3 of 30." in text


def test_what_is_swept_is_answered_first(told, sentence):
    rows = told(FAULTS, TWO, 40, lambda s, d, run: "missed" if d == "one" and run % 2 else "right")
    rows["p_gust_scale_ratio"] = (rows["run"].to_numpy(dtype=int) % 2).astype(float)
    text = sentence(rows, swept=("p_gust_scale_ratio",))
    assert "From gust scale 0 to 1 right goes from 100 to 0 % with one, and stays at 100 % with other." in text


def test_what_changes_for_nobody_is_not_told(told, sentence):
    rows = told(FAULTS, TWO, 40, lambda s, d, run: "missed" if d == "one" else "right")
    rows["p_gust_scale_ratio"] = (rows["run"].to_numpy(dtype=int) % 2).astype(float)
    assert "gust scale" not in sentence(rows, swept=("p_gust_scale_ratio",))


def test_the_weakness_told_is_that_of_the_first_with_a_decided_flight(told, sentence):
    rows = told(FAULTS, TWO, 20, lambda s, d, run: "undecided" if d == "one" else "wrong_site")
    text = sentence(rows, voted={"other"})
    assert text.startswith("The detector is never right in time in 40 decided faulty flights. It fails most in jam_a")
    assert "In 40 flights it declares a healthy site." in text


def test_nothing_flown_says_so(told, sentence, make_rows):
    assert sentence(make_rows((), (), 0)) == "Not decided: no flight was flown."
    lost = dict.fromkeys(range(3), ("infeasible", "buffet: too slow"))
    assert "Not decided" in sentence(make_rows(("jam_a",), TWO, 3, lost)) or "No healthy" in sentence(
        make_rows(("jam_a",), TWO, 3, lost)
    )


def test_who_sees_the_voted_signal_alone_is_not_ranked_before_others(told, sentence):
    rows = told(FAULTS, TWO, 20, lambda s, d, run: "right" if d == "other" or run < 4 else "missed")
    assert sentence(rows, voted={"other"}).split(",")[0].endswith("one")


def test_who_does_not_come_to_the_end_neither_leads_nor_is_silent(told, sentence):
    """A detector that raised in a quarter of its flights led the page, right in the same flights as the one that did not."""
    rows = told(("jam_a",), TWO, 12, lambda s, d, run: "right" if run % 2 else "missed")
    gone = ((rows["detector"] == "one") & (rows["run"] < 4)).to_numpy()
    rows.loc[gone, "status"], rows.loc[gone, "outcome"] = "error", None
    text = sentence(rows)
    assert text.startswith("Not decided: other and one are right in the same flights")
    assert "one has no score in 4 flights: it did not come to their end." in text


def test_where_nobody_came_to_an_end_nothing_is_decided(told, sentence, make_rows):
    rows = told(("jam_a",), ("one",), 3, lambda *_: "right")
    rows["status"], rows["outcome"] = "error", None
    assert sentence(rows) == (
        "Not decided: no flight has a score. one has no score in 3 flights: it did not come to their end. "
    )
    lost = dict.fromkeys(range(3), ("infeasible", "buffet: too slow"))
    assert sentence(make_rows(("jam_a",), TWO, 3, lost)) == "Not decided: no flight was flown."


def test_in_sample_is_said_in_the_sentence(told, sentence):
    text = sentence(told(FAULTS, TWO, 20, lambda *_: "right"), in_sample={"one"})
    assert "In sample, tuned on these very flights: one." in text


def test_a_detector_that_names_no_site_is_not_praised_for_it(told, sentence):
    rows = told(("jam_a",), ("one",), 20, lambda *_: "right")
    rows["isolated"] = None
    assert "healthy site" not in sentence(rows)
