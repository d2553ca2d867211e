"""What a detector may ask of a bus, and how it is told what is not there."""

import re

import pytest

from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Site


def site(name, signal, row=0, kind="sensor"):
    return Site(name=name, signal=signal, row=row, kind=kind, unit_name="", admissible=1.0)


BUS = Bus(
    sample_s=0.01,
    # not in the order of their rows, and of three kinds
    sites=(
        site("r3", "r_deg_s", 2),
        site("elevator", "surface_deg", 4, "actuator"),
        site("r1", "r_deg_s", 0),
        site("r2", "r_deg_s", 1),
        site("pump", "flow", kind="component"),
        site("alpha1", "alpha_deg", 0),
        site("rudder", "surface_deg", 2, "actuator"),
        site("q", "q_deg_s"),
    ),
    signals={"r_deg_s": 3, "surface_deg": 13, "flow": 1, "alpha_deg": 2, "q_deg_s": 1, "phi_deg": 0},
)


def test_sites_by_kind_and_by_signal():
    assert BUS.names == ("r3", "elevator", "r1", "r2", "pump", "alpha1", "rudder", "q")
    assert BUS.sites_of("actuator") == ("elevator", "rudder")
    assert BUS.sites_of("component") == ("pump",)
    assert BUS.sites_of("engine") == ()
    assert BUS.sites_on("r_deg_s") == ("r1", "r2", "r3")
    assert BUS.sites_on("surface_deg") == ("rudder", "elevator")
    assert BUS.sites_on("phi_deg") == ()


def test_redundant_sensors_are_in_the_order_of_the_rows():
    assert BUS.redundant("r_deg_s") == BUS.redundant("r_deg_s", least=3) == ("r1", "r2", "r3")
    assert BUS.redundant("q_deg_s", least=1) == ("q",)


@pytest.mark.parametrize(
    ("signal", "least", "message"),
    [
        ("r_deg_s", 4, "needs 4 or more redundant sensors on r_deg_s, a fault site each; this benchmark has 3 rows and "
         "the sites r3, r1, r2 there"),
        ("alpha_deg", 2, "needs 2 or more redundant sensors on alpha_deg, a fault site each; this benchmark has 2 rows and "
         "the sites alpha1 there"),
        ("q_deg_s", 2, "needs 2 or more redundant sensors on q_deg_s, a fault site each; this benchmark has 1 rows and "
         "the sites q there"),
        ("surface_deg", 2, "needs 2 or more redundant sensors on surface_deg, a fault site each; this benchmark has 13 rows "
         "and the sites none there"),
        ("phi_deg", 1, "needs 1 or more redundant sensors on phi_deg, a fault site each; this benchmark has 0 rows and "
         "the sites none there"),
    ],
)  # fmt: skip
def test_too_few_redundant_sensors_are_told_with_what_there_is(signal, least, message):
    with pytest.raises(DesignError, match=f"^{re.escape(message)}$"):
        BUS.redundant(signal, least)


def test_missing_signals_are_told_with_what_there_is_and_the_nearest():
    BUS.require()
    BUS.require("r_deg_s", "phi_deg")
    there = "['alpha_deg', 'flow', 'phi_deg', 'q_deg_s', 'r_deg_s', 'surface_deg']"
    expected = f"needs the signals ['volts'], this benchmark has {there}"
    with pytest.raises(DesignError, match=f"^{re.escape(expected)}$"):
        BUS.require("r_deg_s", "volts")
    close = "Did you mean 'alpha_deg'? Did you mean 'phi_deg'?"
    expected = f"needs the signals ['alpha', 'phi_degs'], this benchmark has {there}. {close}"
    with pytest.raises(DesignError, match=f"^{re.escape(expected)}$"):
        BUS.require("alpha", "r_deg_s", "phi_degs")


def test_redundant_sensors_on_a_signal_that_is_not_there():
    with pytest.raises(DesignError, match="needs the signals .'r_deg'., this benchmark has .* Did you mean 'r_deg_s'"):
        BUS.redundant("r_deg")
