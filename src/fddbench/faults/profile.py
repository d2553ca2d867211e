"""Fault profiles: what a fault adds to the signal of a site, as a function of the time since its onset."""

from dataclasses import fields
from typing import Any, Protocol

from fddbench.blocks.block import NOTHING
from fddbench.blocks.layout import Layout, Nothing, Rows
from fddbench.interfaces import Instant

__all__ = ["Profile", "ProfileBlock", "constants_of"]


class Profile(Protocol):
    """A record of the constants of a fault whose instances, rows of numbers (n_sites, n_cases), say what it adds."""

    def at(self, time_s: Rows) -> Rows:
        """What is added, (n_sites, n_cases), so long after the onset on each site [s]; in the unit of the sites."""
        ...


def constants_of(kind: type[Any], n_sites: int) -> Layout[Any]:
    """Layout of a record of constants whose fields all have a row a site."""
    return Layout(kind(**{field.name: n_sites for field in fields(kind)}))


class ProfileBlock:
    """A profile added to the reading of its sites; nothing is kept from sample to sample."""

    states: Layout[Any] = NOTHING

    def __init__(self, profile: type[Profile], n_sites: int, sample_s: float) -> None:
        self.constants = constants_of(profile, n_sites)
        self.sample_s = sample_s

    def start(self, c: Profile) -> Nothing:
        """Nothing to keep."""
        del c
        return Nothing()

    def step(self, x: Nothing, c: Profile, reading: Rows, now: Instant) -> tuple[Nothing, Rows]:
        """What the sites show."""
        return x, reading + now.sign * c.at(now.time_s)
