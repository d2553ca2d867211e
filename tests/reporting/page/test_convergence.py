"""How an estimate settles: the last look is the share of the ranking, and bands hold it."""

import numpy as np

from fddbench.metrics.alarms import summarize_alarms
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.convergence import convergence_scene, settling
from fddbench.reporting.page.ranking import ranking
from fddbench.reporting.references import METHODS, bibliography


def test_the_last_look_is_what_the_ranking_says(told):
    rows = told(("jam_a", "jam_b"), ("d",), 40, lambda s, d, run: "right" if run % 4 else "missed")
    columns = Columns(rows)
    own, (rank,) = settling(columns, 0), ranking(columns, summarize_alarms(rows))
    assert (own.runs[0], own.runs[-1]) == (2, 40)
    np.testing.assert_allclose(
        [own.share[-1], own.low[-1], own.high[-1]], [rank.right.share, rank.right.low, rank.right.high]
    )
    assert np.all((own.low <= own.share) & (own.share <= own.high))
    assert "right [%]" in convergence_scene(columns, rank).svg()


def test_one_run_settles_nothing(told):
    rows = told(("jam_a",), ("d",), 1, lambda *_: "right")
    columns = Columns(rows)
    assert settling(columns, 0) is None


def test_every_method_has_its_reference():
    for _, entry in bibliography(METHODS):
        assert entry.count("{") == entry.count("}")
        assert "year={" in entry
