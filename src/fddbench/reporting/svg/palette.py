"""What every mark of a picture looks like, in light and in dark; told apart by the colour blind and by dashes in grey.

References
----------
Okabe and Ito (2008), Color Universal Design: the series.
"""

from collections.abc import Mapping
from dataclasses import dataclass

__all__ = ["LOOKS", "OUTCOME_LOOKS", "SERIES", "Look", "band", "css", "series"]

_COLOURS: Mapping[str, tuple[str, str]] = {
    "bg": ("#fff", "#12181f"), "ink": ("#1b2530", "#e6ebf0"), "soft": ("#52606d", "#a9b6c3"),
    "line": ("#d5dbe1", "#34404c"), "pale": ("#f3f6f8", "#1b242d"), "acc": ("#0b4f7d", "#7fc1ee"),
    "bad": ("#a3211b", "#ff8f85"), "good": ("#00664b", "#3ecf9f"),
    "o0": ("#4c9fd0", "#3f8fc4"), "o1": ("#a6cbe3", "#86b6d4"), "o2": ("#d5dbe1", "#56636f"),
    "o3": ("#e69f00", "#e6a417"), "o4": ("#b3261e", "#ef6a5e"), "o5": ("#7b3f98", "#b98ad0"),
    "s0": ("#0072b2", "#5db5ea"), "s1": ("#c04f00", "#ff9a4d"), "s2": ("#00805c", "#3ecf9f"),
    "s3": ("#b34d8c", "#eb9ccb"), "s4": ("#8a6100", "#e2b84a"), "s5": ("#2b6f9f", "#8fd0f5"),
    "s6": ("#5b5b5b", "#bbbbbb"), "s7": ("#7b3f98", "#c9a3dd"),
}  # fmt: skip
SERIES = 8
"""Colours of detectors before they begin again, then with other dashes."""

OUTCOME_LOOKS = {"right": "o0", "quiet": "o0", "late": "o1", "undecided": "o2", "missed": "o3", "wrong_site": "o4",
                 "false_alarm": "o5"}  # fmt: skip
"""Look of every outcome, in the order in which bars stack them."""


@dataclass(frozen=True)
class Look:
    """Colour by its name, whether it fills, width of the line, its dashes, opacity."""

    colour: str
    fills: bool = False
    width: float = 1.0
    dashes: str = ""
    opacity: float = 1.0

    @property
    def light(self) -> str:
        """Colour on white."""
        return _COLOURS[self.colour][0]


def _dashes(i: int) -> str:
    """Dashes of line `i`: with its colour they come again only after 16."""
    return ("", "7 3", "2 2", "8 3 2 3")[(i % SERIES + i // SERIES) % 4]


LOOKS: Mapping[str, Look] = {
    "t": Look("ink", fills=True),
    "ts": Look("soft", fills=True),
    "no": Look("line", fills=True),
    "ax": Look("soft"),
    "gl": Look("line"),
    "on": Look("soft", dashes="2 3"),
    "ht": Look("soft", width=0.8),
    "lim": Look("bad", dashes="5 3"),
    "wr": Look("o4", width=1.6, dashes="1 3"),
    "ci": Look("ink", width=2.0),
    "ik": Look("ink", width=1.1),
    "one": Look("ink", width=1.3),
    "few": Look("ink", width=0.5, opacity=0.45),
    "thr": Look("ink", width=1.1, dashes="5 3"),
    "prm": Look("s1", width=1.5, dashes="7 4"),
    **{f"o{i}": Look(f"o{i}", fills=True) for i in range(6)},
    **{f"s{i}": Look(f"s{i % SERIES}", width=2.0, dashes=_dashes(i)) for i in range(2 * SERIES)},
    **{f"d{i}": Look(f"s{i}", fills=True) for i in range(SERIES)},
    **{f"b{i}": Look(f"s{i}", fills=True, opacity=0.16) for i in range(SERIES)},
    **{f"e{i}": Look(f"s{i}", width=2.0) for i in range(SERIES)},
    **{f"n{i}": Look(f"s{i}", width=1.0) for i in range(SERIES)},
}
"""Looks by name: t text, ax axis, gl grid line, lim limit, o outcomes, s series, d dots, b bands, e error bars, n thin."""


def series(i: int) -> str:
    """Look of the line of detector `i`."""
    return f"s{i % (2 * SERIES)}"


def band(i: int) -> str:
    """Look of its band."""
    return f"b{i % SERIES}"


def css() -> str:
    """Style sheet of the colours and looks, dark where the reader asks for it."""
    light, dark = (";".join(f"--{name}:{pair[i]}" for name, pair in _COLOURS.items()) for i in (0, 1))
    rules = "".join(f"svg .{name}{{{_rule(look)}}}" for name, look in LOOKS.items())
    dots = "".join(f".sw.s{i}{{background:var(--s{i})}}" for i in range(SERIES))
    boxes = "".join(f"i.o{i}{{background:var(--o{i})}}" for i in range(6))
    words = "svg .m{text-anchor:middle}svg .e{text-anchor:end}svg .w{font-weight:700}"
    words += "".join(f"svg .z{size}{{font-size:{size}px}}" for size in (9, 10, 11))
    roots = f":root{{color-scheme:light dark;{light}}}@media(prefers-color-scheme:dark){{:root{{{dark}}}}}"
    return f"{roots}{rules}{words}{dots}{boxes}"


def _rule(look: Look) -> str:
    if look.fills:
        return f"fill:var(--{look.colour})" + (f";opacity:{look.opacity:g}" if look.opacity < 1.0 else "")
    width = f";stroke-width:{look.width:g}" if look.width != 1.0 else ""
    dashes = f";stroke-dasharray:{look.dashes}" if look.dashes else ""
    opacity = f";opacity:{look.opacity:g}" if look.opacity < 1.0 else ""
    return f"fill:none;stroke:var(--{look.colour}){width}{dashes}{opacity}"
