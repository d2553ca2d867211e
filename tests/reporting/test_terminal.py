from fddbench.metrics.summary import summarize
from fddbench.reporting.terminal import to_text


def test_table_is_aligned_and_fits_a_terminal(make_rows):
    names = ("a_detector_with_a_very_long_name_indeed", "voting_monitor")
    text = to_text(summarize(make_rows(("jam_a", "noise_b", "turn_coordination_2_healthy"), names, 12)))
    lines = text.splitlines()
    assert max(map(len, lines)) <= 120
    assert lines[0].startswith("scenario")
    assert sum(line.startswith("jam_a") for line in lines) == 1
    assert "100 [73.5, 100]" in text
    assert "a_detector" in text


def test_nothing_flown_and_no_rows(make_rows):
    lost = dict.fromkeys(range(3), ("infeasible", "stall"))
    assert "0/3" in to_text(summarize(make_rows(("jam_a",), ("d",), 3, lost)))
    assert to_text(summarize(make_rows((), (), 0))) == "no rows: nothing was flown"
