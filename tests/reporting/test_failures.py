"""Where it goes wrong: bins, the order of the worst flights, and infeasible ones by kind of reason."""

import numpy as np
import pytest
from tests.reporting.conftest import AXES

from fddbench.reporting.failures import failure_tables, worst_lines
from fddbench.reporting.infeasible import infeasible_lines, infeasible_map, kind_of


@pytest.fixture
def rows(make_rows):
    return make_rows(("jam_b", "jam_a", "healthy"), ("voting_monitor", "sliding_mode"), 40)


def test_bins_count_every_decided_faulty_flight_once(rows):
    for table in failure_tables(rows, AXES):
        for line in table["lines"]:
            counts = [cell.small.split(":")[0].split(" of ") for cell in line[1:] if cell.small]
            wrong, flights = (sum(int(pair[i]) for pair in counts) for i in (0, 1))
            assert flights == 40
            assert all(cell.alarm == (not cell.small.startswith("0 of")) for cell in line[1:] if cell.small)
            pair = line[0].small == "2 faulty sites"
            assert wrong == (40 if line[0].text == "voting_monitor" and pair else 0)


def test_of_grid_values_that_vary_together_there_is_one_table(rows):
    level = rows["run"].to_numpy(dtype=np.int64) % 3
    more = rows.assign(
        p_gust_scale_ratio=level / 2.0, p_mass_error_percent=10.0 * level, p_x_cg_error_percent=-1.0 * level
    )
    heads = [table["heads"] for table in failure_tables(more, AXES)]
    assert [head[0] for head in heads[4:]] == ["gust scale [-]", "x cg error [%]"]
    assert heads[4][1:] == ("0", "0.5", "1")


def test_nothing_wrong_is_no_table(rows):
    assert failure_tables(rows[rows["detector"] == "sliding_mode"], AXES) == []


def test_the_worst_are_healthy_sites_declared_then_the_slowest(rows):
    lines = worst_lines(rows, AXES, "results/x")
    assert [line[2].text for line in lines[:2]] == ["wrong site"] * 2
    assert {line[1].text for line in lines} == {"voting_monitor"}
    scenarios = [line[0].text.split("/")[0] for line in lines]
    assert all(scenarios.count(name) <= 2 for name in scenarios)
    case = lines[0][0].text
    assert lines[0][-1].text == f'fddbench.signals("results/x", "{case.split("/")[0]}", ["{case}"])'


def test_infeasible_flights_are_counted_once_and_by_kind(make_rows):
    lost = {0: ("infeasible", "buffet: lift 1.2 > 1.1"), 1: ("infeasible", "buffet: lift 1.3 > 1.1"),
            2: ("infeasible", "thrust: 120 kN needed")}  # fmt: skip
    rows = make_rows(("jam_a", "jam_b"), ("a", "b"), 20, lost)
    lines = infeasible_lines(rows, AXES)
    assert [(line[0].text, line[2].text, line[3].text) for line in lines] == [
        ("buffet", "2", "20"),
        ("thrust", "1", "20"),
    ]
    assert infeasible_map(rows, AXES) is not None
    assert infeasible_map(make_rows(("jam_a",), ("a",), 5), AXES) is None


@pytest.mark.parametrize(
    ("reason", "kind"),
    [
        ("buffet: 1 > 2", "buffet"),
        ("roll_2: above M_MO: Mach 0.9", "roll_2: above M_MO"),
        ("too fast by 12.5 kt", "too fast by … kt"),
    ],
)
def test_kinds_of_reasons(reason, kind):
    assert kind_of(reason) == kind
    assert np.unique([kind_of(reason.replace("2", "7"))]).size == 1
