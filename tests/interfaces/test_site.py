"""Fault sites, and the time limit that follows from those that are faulty."""

from itertools import permutations

import pytest

from fddbench.errors import FddbenchError
from fddbench.interfaces import Site
from fddbench.interfaces.site import limit_s


def site(name, signal="r_deg_s", limits_s=(120.0, 0.36), **more):
    return Site(
        **{"name": name, "signal": signal, "unit_name": "deg/s", "admissible": 40.0, "limits_s": limits_s, **more}
    )


RATES = [site(f"r{i}") for i in (1, 2, 3)]
ELEVATOR = site("elevator", "surface_deg", (5.0,), unit_name="deg", kind="actuator")


@pytest.mark.parametrize(
    ("faulty", "limit"),
    [
        (RATES[:1], 120.0),
        (RATES[:2], 0.36),
        (RATES, 0.36),  # the last one holds for more
        ([ELEVATOR], 5.0),
        ([ELEVATOR, RATES[0]], 5.0),  # each by how many of its own signal: one rate, one surface
        ([ELEVATOR, *RATES[:2]], 0.36),
        ([site("a", limits_s=()), site("b", "b", (2.0, 1.0))], 2.0),  # who states none has none
        ([site("a", limits_s=()), site("b", limits_s=(2.0, 1.0))], 1.0),  # but counts as faulty
        ([site("a", limits_s=(3,))], 3.0),
    ],
)
def test_the_smallest_limit_of_the_faulty_sites_counts(faulty, limit):
    for order in permutations(faulty):
        found = limit_s(order)
        assert (found, type(found)) == (limit, float)


def test_sites_without_a_limit_need_one_of_the_scenario():
    with pytest.raises(FddbenchError, match=r"^no detection time limit is stated for a\+b$"):
        limit_s([site("a", limits_s=()), site("b", "b", ())])


def test_the_unit_of_a_site_is_one_of_the_table():
    assert ELEVATOR.unit.key("rate") == "rate_deg_s"
    assert site("x", unit_name="").unit.key("rate") == "rate_per_s"
    with pytest.raises(FddbenchError, match="no unit is called 'volts'; known: '', 'deg', "):
        _ = site("x", unit_name="volts").unit


def test_what_a_site_need_not_say():
    plain = Site(name="x", signal="x", unit_name="", admissible=1.0)
    assert (plain.row, plain.kind, plain.stops, tuple(plain.limits_s)) == (
        0,
        "sensor",
        (float("-inf"), float("inf")),
        (),
    )
    assert not plain.floats
    assert not plain.additive
