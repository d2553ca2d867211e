"""The keys of a design file and what values they take."""

from typing import Any

from fddbench.campaign.model import Name, Seed, Strict

__all__ = ["DesignFile", "TunedOn"]


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
    gains : mapping
        Numbers of the kind.
    """

    kind: str
    about: str = ""
    source: str
    tuned_on: tuple[TunedOn, ...] | None
    gains: dict[str, Any]
