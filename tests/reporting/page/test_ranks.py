"""What no false alarm leaves open, in words: the interval beside it, whose witnesses are runs."""

import numpy as np
import pytest

from fddbench.metrics.clustered import korn_graubard
from fddbench.reporting.page.ranking import Rank
from fddbench.reporting.page.ranks import rank_lines, silence


def quiet(flights, runs):
    share = korn_graubard(np.zeros(flights), np.arange(flights) % runs)
    return Rank(
        detector="own", number=0, faulty=0, decided=0, undecided=0, right=share, outcomes={}, distinct_flights=flights,
        alarms=0, alarms_high_percent=None if share.high is None else 100.0 * share.high, weakest=None, runs=runs,
    )  # fmt: skip


@pytest.mark.parametrize(("flights", "runs"), [(100, 100), (540, 60), (225, 25), (90, 10), (45, 5)])
def test_the_rule_of_three_counts_runs_and_agrees_with_the_interval_beside_it(flights, runs):
    line = quiet(flights, runs)
    assert line.alarms_high_percent == pytest.approx(370.0 / runs, rel=0.04)
    text = silence([line])
    assert (f" of {runs} runs" in text) == (flights != runs)
    ((_, _, _, cells),) = rank_lines([line])
    assert text.partition("up to ")[2].partition(" %")[0] == cells[4].small.partition("≤ ")[2].partition(" %")[0]
    assert (f"of {runs} runs" in cells[4].small) == (flights != runs)


def test_one_run_leaves_everything_open():
    assert silence([quiet(9, 1)]) == "none in 9 flights of one run leaves everything open"
    assert silence([]) == ""


def test_what_silence_leaves_open_is_true_of_few_runs():
    """ "About 3.7 in as many" was told of two runs."""
    assert silence([quiet(2, 2)]) == "none in 2 flights leaves up to 84.2 % (about 1.7 in as many)"
