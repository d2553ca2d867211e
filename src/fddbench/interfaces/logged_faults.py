"""Faults that are in what flies already: somebody says when, nobody injects them."""

from dataclasses import dataclass

from fddbench.interfaces.floats import Floats

__all__ = ["IN_LOG", "LoggedFaults"]

IN_LOG = "in_log"
"""Kind of such a fault, as result columns call it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LoggedFaults:
    """Faults of flights that a plant brings with it; scored like those of a scenario, behind which they stand.

    Attributes
    ----------
    first : (n_lines, n_sites, n_cases) array
        First faulty sample of every site, `NEVER` for one that the fault leaves alone.
    last : (n_lines, n_cases) array
        Last faulty sample; `NEVER` for a fault that stays, or for none.
    """

    first: Floats
    last: Floats
