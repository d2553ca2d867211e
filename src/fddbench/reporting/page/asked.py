"""What a campaign asks beside which detector is best, and the answer that comes first: consequences, and printed figures.

A campaign whose `about` names two or more of the numbers that its loop announces (bank, sideslip, heading, track) asks what
faults do to the aircraft, and so does one whose aircraft acts on a detector (then all of them): where each is worst. One that
asks for figures in print is answered by pictures: it says where they are and of which scenarios.
"""

import re
from collections.abc import Sequence

import pandas as pd

from fddbench.interfaces import Consequence
from fddbench.reporting.consequences import Worst, worst_scenarios
from fddbench.reporting.formats import short
from fddbench.reporting.labels import label
from fddbench.reporting.page.alarms_said import Said

__all__ = ["asked", "asks_of_what_varies", "of_consequences", "of_figures"]

_HOW = {"peak", "error", "rise"}
_FIGURES = re.compile(r"\bFigs?\.? \d+(?:(?:, | and | to )\d+)*")
_LEAST_NAMED = 2


def asked(
    about: str, rows: pd.DataFrame, announced: Sequence[Consequence], drawn: Sequence[str], *, commander: str = ""
) -> Said:
    """Sentences that come first; empty where the campaign asks for detectors alone.

    Parameters
    ----------
    about : str
        What the campaign says of itself.
    rows : DataFrame
        As ``fddbench.load`` gives them.
    announced : sequence of Consequence
        By the loop.
    drawn : sequence of str
        Scenarios whose signals are drawn on the page.
    commander : str
        Detector on whose declarations the aircraft acts; "" where nobody acts.
    """
    text = " ".join(about.split())
    named = [each for each in announced if _named(each.name, text)]
    own = named if len(named) >= _LEAST_NAMED else announced if commander else ()
    return of_consequences(worst_scenarios(rows, own), commander) + of_figures(text, drawn)


def of_consequences(worst: Sequence[Worst], commander: str = "") -> Said:
    """``Worst for the aircraft: heading error [deg] 12.1 in jam_b, ... (medians of flights).``."""
    if not worst:
        return []
    said: Said = [(f"Worst for the aircraft{f', which acts on {commander}' if commander else ''}: ", False)]
    for i, each in enumerate(worst):
        healthy = f", healthy {short(each.healthy)}" if each.healthy is not None else ""
        said += [
            (f"{'; ' if i else ''}{label(each.name)} {short(each.median)}{healthy} in ", False),
            (each.scenario, True),
        ]
    return [*said, (" (medians of flights; all below). ", False)]


def of_figures(about: str, drawn: Sequence[str]) -> Said:
    """``Figs 2 and 3 are drawn below, under Signals, from faults and healthy.``."""
    figures = _FIGURES.search(about.partition("?")[0]) if "?" in about else None
    if figures is None or not drawn:
        return []
    verb = "are" if figures[0].startswith("Figs") else "is"
    more = f"{', '.join(drawn[:-1])} and {drawn[-1]}" if len(drawn) > 1 else drawn[0]
    return [(figures[0], True), (f" {verb} drawn below, under Signals, as flown here: {more}. ", False)]


def asks_of_what_varies(about: str) -> bool:
    """Whether a campaign asks what the values that it varies do, rather than which detector is best.

    >>> asks_of_what_varies("How much wind is too much?"), asks_of_what_varies("Which detector is best?")
    (True, False)
    """
    return re.match(r"What (do|does|is left)\b|How\b|At which\b", about) is not None


def _named(column: str, text: str) -> bool:
    """Whether a text names what a column is of: ``heading_error_deg`` by the word heading."""
    words = [word for word in label(column).partition(" [")[0].split() if word not in _HOW]
    return re.search(rf"\b{re.escape(' '.join(words))}\b", text) is not None
