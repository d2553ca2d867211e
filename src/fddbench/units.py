"""One table of units: what a key of a campaign carries behind its name, and what messages and pictures call it."""

from dataclasses import dataclass
from math import pi
from typing import Final

from fddbench.errors import FddbenchError

__all__ = [
    "DEG_PER_RAD",
    "FACTORS",
    "RAD_PER_DEG",
    "SUFFIXES",
    "UNITS",
    "Unit",
    "converts",
    "suffix_of_name",
    "unit",
    "unit_of_name",
]

DEG_PER_RAD: Final = 180.0 / pi
RAD_PER_DEG: Final = pi / 180.0


@dataclass(frozen=True)
class Unit:
    """A unit of a signal, and those of its rate and its variance.

    Attributes
    ----------
    name, rate_name, square_name : str
        As messages and pictures write them: ``deg/s``, ``deg/s^2``, ``deg^2/s^2``; "" for plain numbers.
    suffix, rate_suffix, square_suffix : str
        As keys and signals carry them: ``_deg_s``, ``_deg_s2``, ``_deg2_s2``; a plain number's rate is ``_per_s``.
    """

    name: str
    suffix: str
    rate_name: str
    rate_suffix: str
    square_name: str
    square_suffix: str

    def key(self, size: str) -> str:
        """Key of a fault's size in this unit; sizes that are no signal's keep their name.

        >>> [UNITS["deg/s"].key(name) for name in ("amplitude", "rate", "variance", "period_s")]
        ['amplitude_deg_s', 'rate_deg_s2', 'variance_deg2_s2', 'period_s']
        """
        return size + {
            "amplitude": self.suffix,
            "hold_value": self.suffix,
            "quantum": self.suffix,
            "rate": self.rate_suffix,
            "variance": self.square_suffix,
        }.get(size, "")


_TABLE = (
    Unit("", "", "1/s", "_per_s", "", ""),
    Unit("deg", "_deg", "deg/s", "_deg_s", "deg^2", "_deg2"),
    Unit("deg/s", "_deg_s", "deg/s^2", "_deg_s2", "deg^2/s^2", "_deg2_s2"),
    Unit("rad", "_rad", "rad/s", "_rad_s", "rad^2", "_rad2"),
    Unit("rad/s", "_rad_s", "rad/s^2", "_rad_s2", "rad^2/s^2", "_rad2_s2"),
    Unit("m", "_m", "m/s", "_m_s", "m^2", "_m2"),
    Unit("ft", "_ft", "ft/s", "_ft_s", "ft^2", "_ft2"),
    Unit("m/s", "_m_s", "m/s^2", "_m_s2", "m^2/s^2", "_m2_s2"),
    Unit("kt", "_kt", "kt/s", "_kt_s", "kt^2", "_kt2"),
    Unit("m/s^2", "_m_s2", "m/s^3", "_m_s3", "m^2/s^4", "_m2_s4"),
    Unit("g", "_g", "g/s", "_g_s", "g^2", "_g2"),
    Unit("N", "_n", "N/s", "_n_s", "N^2", "_n2"),
    Unit("kN", "_kn", "kN/s", "_kn_s", "kN^2", "_kn2"),
    Unit("N m", "_nm", "N m/s", "_nm_s", "N^2 m^2", "_nm2"),
    Unit("kg", "_kg", "kg/s", "_kg_s", "kg^2", "_kg2"),
    Unit("K", "_k", "K/s", "_k_s", "K^2", "_k2"),
    Unit("Pa", "_pa", "Pa/s", "_pa_s", "Pa^2", "_pa2"),
    Unit("A", "_a", "A/s", "_a_s", "A^2", "_a2"),
    Unit("V", "_v", "V/s", "_v_s", "V^2", "_v2"),
    Unit("ratio", "_ratio", "1/s", "_ratio_s", "", "_ratio2"),
)

UNITS = {entry.name: entry for entry in _TABLE}
"""Units that a fault site may have, by name."""

SUFFIXES: dict[str, str] = {
    "_percent_s": "%/s",
    "_percent": "%",
    "_hz": "Hz",
    "_min": "min",
    "_h": "h",
    "_s": "s",
    **{
        suffix: name
        for entry in _TABLE
        for suffix, name in (
            (entry.suffix, entry.name),
            (entry.rate_suffix, entry.rate_name),
            (entry.square_suffix, entry.square_name),
        )
        if suffix and name
    },
    "_ratio": "-",
}
"""Unit by what a name carries behind it."""

FACTORS: dict[str, tuple[str, float]] = {
    "": ("number", 1.0),
    "-": ("number", 1.0),
    "ratio": ("number", 1.0),
    "%": ("number", 0.01),
    "s": ("time", 1.0),
    "ms": ("time", 1e-3),
    "us": ("time", 1e-6),
    "ns": ("time", 1e-9),
    "min": ("time", 60.0),
    "h": ("time", 3600.0),
    "deg": ("angle", RAD_PER_DEG),
    "rad": ("angle", 1.0),
    "mrad": ("angle", 1e-3),
    "deg/s": ("angular rate", RAD_PER_DEG),
    "rad/s": ("angular rate", 1.0),
    "mrad/s": ("angular rate", 1e-3),
    "m": ("length", 1.0),
    "ft": ("length", 0.3048),
    "km": ("length", 1000.0),
    "m/s": ("speed", 1.0),
    "kt": ("speed", 1852.0 / 3600.0),
    "km/h": ("speed", 1.0 / 3.6),
    "ft/s": ("speed", 0.3048),
    "ft/min": ("speed", 0.3048 / 60.0),
    "m/s^2": ("acceleration", 1.0),
    "g": ("acceleration", 9.80665),
    "N": ("force", 1.0),
    "kN": ("force", 1000.0),
    "lbf": ("force", 4.4482216152605),
    "N m": ("moment", 1.0),
    "kg": ("mass", 1.0),
    "lb": ("mass", 0.45359237),
    "K": ("temperature", 1.0),
    "Pa": ("pressure", 1.0),
    "hPa": ("pressure", 100.0),
    "A": ("current", 1.0),
    "V": ("voltage", 1.0),
}
"""What a recording may be in: the quantity, and how much one of it is in the unit of the quantity."""

_LONGEST_FIRST = sorted(SUFFIXES, key=len, reverse=True)


def unit(name: str) -> Unit:
    """Unit by its name.

    Raises
    ------
    FddbenchError
        The table does not have it.
    """
    if name not in UNITS:
        known = ", ".join(repr(each) for each in UNITS)
        raise FddbenchError(f"no unit is called {name!r}; known: {known}. A new one is a line in fddbench/units.py")
    return UNITS[name]


def suffix_of_name(name: str) -> str:
    """What a name carries behind it to say its unit, "" for nothing.

    >>> suffix_of_name("p_mass_kg"), suffix_of_name("n_declared")
    ('_kg', '')
    """
    return next((suffix for suffix in _LONGEST_FIRST if name.endswith(suffix)), "")


def unit_of_name(name: str) -> str:
    """Unit that a name carries, "" for none.

    >>> unit_of_name("mass_kg"), unit_of_name("rate_deg_s2"), unit_of_name("seed"), unit_of_name("r_deg_s_2")
    ('kg', 'deg/s^2', '', '')
    """
    return SUFFIXES.get(suffix_of_name(name), "")


def converts(one: str, other: str) -> float:
    """Factor from a unit to another of the same quantity; 1, to the last bit, between equal ones.

    >>> converts("kt", "m/s") == 1852 / 3600, converts("deg/s", "deg/s")
    (True, 1.0)

    Raises
    ------
    FddbenchError
        A unit is unknown, or they measure different things.
    """
    for each in (one, other):
        if each not in FACTORS:
            known = ", ".join(filter(None, FACTORS))
            raise FddbenchError(f"no unit is called {each!r}; recordings may be in {known}")
    (quantity, factor), (wanted, per) = FACTORS[one], FACTORS[other]
    if quantity != wanted:
        raise FddbenchError(
            f"{one or 'a plain number'} is no unit of {wanted} and cannot become {other or 'a plain number'}"
        )
    return 1.0 if one == other else factor / per
