"""The one table of units: keys of campaigns, suffixes of names, and what is refused."""

import re

import numpy as np
import pytest

from fddbench.errors import FddbenchError
from fddbench.units import DEG_PER_RAD, RAD_PER_DEG, SUFFIXES, UNITS, suffix_of_name, unit, unit_of_name

SIZES = ("amplitude", "hold_value", "rate", "variance")
# unit, keys of the four sizes
KEYS = (
    ("", ("amplitude", "hold_value", "rate_per_s", "variance")),
    ("deg", ("amplitude_deg", "hold_value_deg", "rate_deg_s", "variance_deg2")),
    ("deg/s", ("amplitude_deg_s", "hold_value_deg_s", "rate_deg_s2", "variance_deg2_s2")),
    ("rad/s", ("amplitude_rad_s", "hold_value_rad_s", "rate_rad_s2", "variance_rad2_s2")),
    ("m/s", ("amplitude_m_s", "hold_value_m_s", "rate_m_s2", "variance_m2_s2")),
    ("m/s^2", ("amplitude_m_s2", "hold_value_m_s2", "rate_m_s3", "variance_m2_s4")),
    ("kN", ("amplitude_kn", "hold_value_kn", "rate_kn_s", "variance_kn2")),
    ("K", ("amplitude_k", "hold_value_k", "rate_k_s", "variance_k2")),
    ("ratio", ("amplitude_ratio", "hold_value_ratio", "rate_ratio_s", "variance_ratio2")),
)


@pytest.mark.parametrize(("name", "keys"), KEYS)
def test_keys_of_the_four_sizes(name, keys):
    assert tuple(unit(name).key(size) for size in SIZES) == keys


def test_what_is_no_size_of_a_signal_keeps_its_name():
    for each in UNITS.values():
        kept = ("frequency_hz", "bit_s", "phase_rad", "amplitude_percent", "rate_percent_s", "onset_s", "sites")
        assert tuple(each.key(name) for name in kept) == kept


@pytest.mark.parametrize("name", [name for name in UNITS if name])
def test_the_keys_of_a_unit_say_that_unit(name):
    own = UNITS[name]
    plain = "-" if name == "ratio" else name
    assert unit_of_name(own.key("amplitude")) == unit_of_name(own.key("hold_value")) == plain
    assert unit_of_name(own.key("rate")) == own.rate_name
    assert unit_of_name(own.key("variance")) == own.square_name


def test_every_unit_has_keys_of_its_own():
    for name, other in ((a, b) for a in UNITS.values() for b in UNITS.values() if a.name < b.name):
        assert name.key("amplitude") != other.key("amplitude"), (name.name, other.name)


def test_one_suffix_has_one_meaning():
    """Two units may share a suffix only where it says the same (the rate of deg is deg/s); a ratio has no unit."""
    meanings = {}
    for each in UNITS.values():
        pairs = ((each.suffix, each.name), (each.rate_suffix, each.rate_name), (each.square_suffix, each.square_name))
        for suffix, name in pairs:
            if suffix and name and suffix != "_ratio":
                meanings.setdefault(suffix, set()).add(name)
    assert {suffix: names for suffix, names in meanings.items() if len(names) > 1} == {}
    assert all(SUFFIXES[suffix] == name for suffix, (name,) in ((s, tuple(n)) for s, n in meanings.items()))


@pytest.mark.parametrize(
    ("name", "suffix", "of"),
    [
        ("mass_kg", "_kg", "kg"),
        ("v_cas_kt", "_kt", "kt"),
        ("altitude_ft", "_ft", "ft"),
        ("x_cg_ratio", "_ratio", "-"),
        ("delta_c_n_percent", "_percent", "%"),
        ("rate_percent_s", "_percent_s", "%/s"),
        ("r_deg_s", "_deg_s", "deg/s"),
        ("limit_deg_s2", "_deg_s2", "deg/s^2"),
        ("variance_deg2_s2", "_deg2_s2", "deg^2/s^2"),
        ("v_tas_m_s", "_m_s", "m/s"),
        ("detection_time_s", "_s", "s"),
        ("frequency_hz", "_hz", "Hz"),
        ("rate_per_s", "_per_s", "1/s"),
        ("n_declared", "", ""),
        ("seed", "", ""),
        ("s", "", ""),
    ],
)
def test_the_longest_suffix_names_the_unit(name, suffix, of):
    assert (suffix_of_name(name), unit_of_name(name)) == (suffix, of)


@pytest.mark.parametrize("name", ["furlong", "DEG", "deg/s ", "deg_s"])
def test_an_unknown_unit_is_refused_with_all_known_ones(name):
    expected = (
        f"no unit is called {name!r}; known: {', '.join(map(repr, UNITS))}. A new one is a line in fddbench/units.py"
    )
    with pytest.raises(FddbenchError, match=f"^{re.escape(expected)}$"):
        unit(name)


def test_degrees_and_radians():
    assert (180.0 / np.pi, np.pi / 180.0) == (DEG_PER_RAD, RAD_PER_DEG)
