"""Voters of all signals that are voted, and which sensors have left the vote."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from fddbench.blocks.layout import Layout, Nothing, Row, Rows, record
from fddbench.interfaces import Voter
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
    """A voter for each signal.

    Parameters
    ----------
    kind : class
        Of the voters; called without arguments.
    signals : sequence of str
        Signals that are voted, names of the fields of `Voted`.
    """

    def __init__(self, kind: type[Voter], signals: tuple[str, ...]) -> None:
        self.parts = {name: VoterBlock(kind()) for name in signals}
        self.states = Layout(self._of_each({name: part.states.shape for name, part in self.parts.items()}))

    def _of_each(self, found: Mapping[str, Any]) -> Voted:
        return Voted(**{field.name: found.get(field.name, Nothing()) for field in fields(Voted)})

    def start(self) -> Voted:
        """Nothing voted yet."""
        return self._of_each({name: part.start(Nothing()) for name, part in self.parts.items()})

    def step(self, x: Voted, readings: Mapping[str, Rows]) -> tuple[Voted, dict[str, Row]]:
        """States at the next sample, and the voted signals by the names of their sensors."""
        found = {
            name: part.step(getattr(x, name), Nothing(), Nothing(), readings[name]) for name, part in self.parts.items()
        }
        after, voted = ({name: pair[j] for name, pair in found.items()} for j in (0, 1))
        return self._of_each(after), voted
