"""Fault sites that inertial units have besides their yaw rates: a unit can be lost whole."""

from dataclasses import replace
from functools import cache
from typing import Any

from fddbench.interfaces import Site

__all__ = ["PHI_UNITS", "P_UNITS", "plant_with_units", "unit_sites"]

P_UNITS, PHI_UNITS = "p_units_deg_s", "phi_units_deg"
"""Signals of the units: roll rates and bank angles."""
_BANK_ADMISSIBLE_DEG, _BANK_STOPS_DEG = 60.0, (-180.0, 180.0)


def unit_sites(sites: tuple[Site, ...]) -> tuple[Site, ...]:
    """A bank angle and a roll rate for each yaw-rate sensor, with its number and its time limits.

    Percent of a roll rate is of the admissible yaw rate; of a bank angle it is of 60 deg, our choice.

    >>> r2 = Site(name="r2", signal="r_deg_s", row=1, unit_name="deg/s", admissible=40.0)
    >>> [(site.name, site.signal, site.row) for site in unit_sites((r2,))]
    [('phi2', 'phi_units_deg', 1), ('p2', 'p_units_deg_s', 1)]
    """
    rates = [site for site in sites if site.signal == "r_deg_s"]
    phi = [
        replace(
            site,
            name=f"phi{site.row + 1}",
            signal=PHI_UNITS,
            unit_name="deg",
            admissible=_BANK_ADMISSIBLE_DEG,
            stops=_BANK_STOPS_DEG,
        )
        for site in rates
    ]
    return (*phi, *(replace(site, name=f"p{site.row + 1}", signal=P_UNITS) for site in rates))


@cache
def plant_with_units(plant: Any) -> Any:
    """The same plant with the fault sites of inertial units behind its own."""
    own = {"sites": (*plant.sites, *unit_sites(plant.sites)), "__doc__": plant.__doc__, "__module__": plant.__module__}
    return type(plant.__name__, (plant,), own)
