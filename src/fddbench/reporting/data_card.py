"""The card of a data set: what it is, how it came about, how it is laid out, what it is not good for."""

from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import Any

import yaml

__all__ = ["card_text", "card_yaml"]

_COLUMNS = {
    "case": "flight, scenario/point/level/run",
    "time_s": "time since the start [s]",
    "fault": "kinds of the faults that act at this sample, joined by +; none",
    "faulty": "1 while any site is faulty",
}


def card_yaml(card: Mapping[str, Any]) -> str:
    """The card for machines."""
    text: str = yaml.safe_dump(dict(card), sort_keys=False, allow_unicode=True, width=120)
    return text


def card_text(card: Mapping[str, Any]) -> str:
    """The card for readers, Markdown."""
    splits = "\n".join(
        f"| {name} | {own['purpose']} | {own['aircraft']} | {own['flights']} | {own['samples']:,} |"
        for name, own in card["splits"].items()
    )
    columns = "\n".join(f"| `{name}` | {about} |" for name, about in _described(card))
    words = {
        **card,
        "about": card["about"] or "Flights of the campaign.",
        "nth": _nth(card["every"]),
        "fold_hz": card["rate_hz"] / 2.0,
        "splits": splits,
        "columns": columns,
    }
    template = files("fddbench.reporting").joinpath("templates", "data_card.md").read_text(encoding="utf-8")
    return template.format_map(words)


def _described(card: Mapping[str, Any]) -> list[tuple[str, str]]:
    units: Mapping[str, str] = card["units"]
    found = list(_COLUMNS.items())
    found += [(f"faulty_{site}", f"1 while {site} is faulty") for site in card["sites"]]
    found += [(name, f"measured [{units.get(name) or '-'}]") for name in card["measured"]]
    return found + [(name, f"truth [{units.get(name) or '-'}]") for name in card["truth"]]


def _nth(every: int) -> str:
    endings: Sequence[str] = ("th", "st", "nd", "rd")
    ending = endings[every % 10] if every % 10 < 4 and every % 100 not in (11, 12, 13) else "th"
    return f"{every}{ending}"
