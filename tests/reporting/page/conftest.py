"""Tables that are told outcome by outcome."""

import pytest

from fddbench.metrics.alarms import summarize_alarms
from fddbench.reporting.page.answer import answer
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.courses import courses, loudest
from fddbench.reporting.page.ranking import ranking, second_beside_best


@pytest.fixture
def told(make_rows):
    """Rows whose outcomes are those of a function of scenario, detector and run."""

    def make(scenarios, detectors, flights, outcome, lost=None):
        rows = make_rows(scenarios, detectors, flights, lost)
        names = zip(rows["scenario"], rows["detector"], rows["run"], strict=True)
        rows["outcome"] = (
            rows["outcome"].astype(object).where(rows["status"] != "ok", [outcome(*each) for each in names])
        )
        rows["outcome"] = rows["outcome"].astype("string[pyarrow]")
        rows.loc[rows["outcome"] == "false_alarm", "false_alarm_time_s"] = 1.0
        return rows

    return make


@pytest.fixture
def sentence():
    """First sentence of the page of a table."""

    def say(rows, swept=(), **more):
        columns = Columns(rows)
        ranks = ranking(columns, summarize_alarms(rows), **more)
        second = second_beside_best(columns, ranks)
        said = answer(ranks, second, courses=courses(columns, swept), loudest=loudest(columns, ranks))
        return "".join(text for text, _ in said)

    return say
