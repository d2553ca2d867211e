"""Maps of the envelope and of infeasible flights: every decided flight in one cell, few flights hatched."""

import re

import pytest
from tests.reporting.conftest import AXES

from fddbench.reporting.infeasible import infeasible_lines, kind_of
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.envelope import envelope_pairs, failed_map, infeasible_map

PAIR = ("p_v_cas_kt", "p_altitude_ft")


def test_cells_hold_every_decided_faulty_flight_once(make_rows):
    columns = Columns(make_rows(("jam_b", "jam_a", "healthy"), ("voting_monitor", "sliding_mode"), 200))
    text = failed_map(columns, 0, *PAIR).svg()
    assert sum(int(n.replace("\u202f", "")) for n in re.findall(r">n ([\d\u202f]+)<", text)) == 400
    assert 'class="ht"' in text  # corners of few flights
    assert failed_map(columns, 0, "p_v_cas_kt", "p_delta_c_y_percent") is None


def test_what_is_drawn_is_cut_by_width_and_ends_never_look_alike(make_rows):
    """Six drawn masses were six rows side by side, and two of them were called 266k."""
    rows = make_rows(("jam_a",), ("d",), 6)
    rows["p_v_cas_kt"] = 248.0 + 0.1 * rows["run"].astype(float)
    text = failed_map(Columns(rows), 0, *PAIR).svg()
    ticks = re.findall(r">(24[\d.]+)<", text)
    assert ticks == ["248", "248.1", "248.2", "248.3", "248.4", "248.5"]  # edges of five parts, not six values
    assert len(set(ticks)) == len(ticks)


def test_pairs_are_what_the_benchmark_says_and_what_is_swept(make_rows):
    columns = Columns(make_rows(("jam_a",), ("d",), 5))
    assert envelope_pairs(columns, (*AXES, ("no_such", "mass_kg")), ()) == [PAIR, ("p_x_cg_ratio", "p_mass_kg")]
    swept = ("p_mass_kg", "p_v_cas_kt")
    assert envelope_pairs(columns, AXES, swept)[0] == swept


def test_where_nothing_can_be_flown_is_grey(make_rows):
    lost = dict.fromkeys(range(8), ("infeasible", "buffet: too slow"))
    columns = Columns(make_rows(("jam_a",), ("a",), 8, lost))
    assert failed_map(columns, 0, *PAIR) is None
    assert infeasible_map(columns, *PAIR).svg().count(">100<") >= 1
    assert infeasible_map(Columns(make_rows(("jam_a",), ("a",), 5)), *PAIR) is None


def test_infeasible_flights_are_counted_once_and_by_kind(make_rows):
    lost = {0: ("infeasible", "buffet: lift 1.2 > 1.1"), 1: ("infeasible", "buffet: lift 1.3 > 1.1"),
            2: ("infeasible", "thrust: 120 kN needed")}  # fmt: skip
    rows = make_rows(("jam_a", "jam_b"), ("a", "b"), 20, lost)
    lines = infeasible_lines(rows, AXES)
    assert [(line[0].text, line[2].text, line[3].text) for line in lines] == [
        ("buffet", "2", "20"),
        ("thrust", "1", "20"),
    ]


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
