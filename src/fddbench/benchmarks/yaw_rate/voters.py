"""Voters of all signals that are voted, and which sensors have left the vote."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from fddbench.blocks.layout import Layout, Nothing, Row, Rows, record
from fddbench.interfaces import Site, Voter
from fddbench.voting.block import VoterBlock

__all__ = ["Voted", "Voters"]


@record
class Voted:
    """One part for each signal that may be voted, by the name of its sensors."""

    r_deg_s: Any
    p_units_deg_s: Any
    phi_units_deg: Any
    alpha_deg: Any
    n_z_g: Any


class Voters:
    """A voter for each signal; declared sites leave their vote.

    Parameters
    ----------
    kind : class
        Of the voters; called without arguments, or by its ``for_signal``.
    signals : mapping of str to int
        Signals that are voted, names of the fields of `Voted`, and how many sensors each has.
    sites : tuple of Site
        Of the bus, in the order in which they are declared.
    sample_s : float
        Sample time [s].
    """

    def __init__(self, kind: type[Voter], signals: Mapping[str, int], sites: tuple[Site, ...], sample_s: float) -> None:
        self.parts = {name: VoterBlock.on(kind, name, n, sample_s) for name, n in signals.items()}
        self.states = Layout(self._of_each({name: part.states.shape for name, part in self.parts.items()}))
        placed = {(site.signal, site.row): j for j, site in enumerate(sites) if site.kind == "sensor"}
        self._sites = {name: [placed.get((name, row)) for row in range(n)] for name, n in signals.items()}

    def _of_each(self, found: Mapping[str, Any]) -> Voted:
        return Voted(**{field.name: found.get(field.name, Nothing()) for field in fields(Voted)})

    def start(self) -> Voted:
        """Nothing voted yet."""
        return self._of_each({name: part.start(Nothing()) for name, part in self.parts.items()})

    def step(self, x: Voted, readings: Mapping[str, Rows], declared: Rows = None) -> tuple[Voted, dict[str, Row]]:
        """States at the next sample, and the voted signals by the names of their sensors.

        `declared`, (n_sites, n_cases), is what the aircraft acts on, as `fddbench.interfaces.Loop` says.
        """
        found = {
            name: part.step(
                getattr(x, name), Nothing(), Nothing(), readings[name], self._declared(name, readings[name], declared)
            )
            for name, part in self.parts.items()
        }
        after, voted = ({name: pair[j] for name, pair in found.items()} for j in (0, 1))
        return self._of_each(after), voted

    def _declared(self, name: str, sensors: Rows, declared: Rows) -> Rows:
        """Rows of the sensors of a signal, 0 for one without a site; None where no sensor of it can be declared."""
        own = self._sites[name]
        if declared is None or all(j is None for j in own):
            return None
        return np.stack([0.0 * value if j is None else declared[j] for j, value in zip(own, sensors, strict=True)])
