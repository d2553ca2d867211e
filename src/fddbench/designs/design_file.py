"""The keys of a design file and what values they take."""

from collections.abc import Mapping
from typing import Annotated, Any

import yaml
from pydantic import Field

from fddbench.campaign.rules.model import Name, Seed, Strict

__all__ = ["DesignFile", "Limits", "TunedOn", "design_text"]

MOST_SLOW = 100
"""Samples between two steps of a detector, at most."""


class TunedOn(Strict):
    """A set of flights that a design has seen.

    Attributes
    ----------
    campaign : str
        Name of the campaign.
    seed : int
        Its seed.
    """

    campaign: Name
    seed: Seed


class Limits(Strict):
    """What ordinary Python, or C not written here, may take in its process; beyond, its row has the status that says so.

    Attributes
    ----------
    step_s : float
        Longest step of a flight, in C of all flights together [s], by the clock on the wall: a row of status ``timeout``.
    memory_mb : float
        Memory that its flights may take beyond what it has when it is built [MB]: ``memory``.
    """

    step_s: Annotated[float, Field(gt=0.0, le=86_400.0)] = 10.0
    memory_mb: Annotated[float, Field(ge=1.0, le=1e6)] = 1024.0


class DesignFile(Strict):
    """A tuned detector as it is written.

    Attributes
    ----------
    kind : str
        Registered detector, or ``plugin.py:ClassName`` beside the design.
    source : str
        Where the numbers come from.
    tuned_on : list of TunedOn, or None
        Flights the numbers were chosen on.
    every : int
        Steps at every so manieth sample and holds its decision between; its times are counted on that slower clock.
    code : str
        Folder of C beside the design that flies in its place, with the functions of the exported header; "" for none.
    symbols : str, list of symbols, or None
        Library of operations that it must keep to, see `fddbench.exported.symbols`.
    limits : Limits
        What a step may take where the detector is ordinary Python, or C that was not written here.
    recipe : mapping, or None
        What ``fddbench design`` makes the gains from, and what it found.
    gains : mapping
        Numbers of the kind.
    """

    kind: str
    about: str = ""
    source: str
    tuned_on: tuple[TunedOn, ...] | None
    every: Annotated[int, Field(ge=1, le=MOST_SLOW)] = 1
    code: str = ""
    symbols: str | list[str | dict[str, Annotated[int, Field(ge=1)]]] | None = None
    limits: Limits = Limits()
    recipe: dict[str, Any] | None = None
    gains: dict[str, Any]

    @property
    def gamma(self) -> float | None:
        """What the recipe found to be guaranteed in the worst case [-]; None without one."""
        found = (self.recipe or {}).get("found")
        gamma = found.get("gamma") if isinstance(found, dict) else None
        return float(gamma) if isinstance(gamma, float | int) else None


def design_text(data: Mapping[str, Any]) -> str:
    """File of a design: a first line that says what it is, then the keys, a line per row of a matrix."""
    about = data.get("about") or data["source"]
    body = yaml.safe_dump(dict(data), sort_keys=False, default_flow_style=None, allow_unicode=True, width=10_000)
    return f"# {about.strip().splitlines()[0]}\n{body}"
