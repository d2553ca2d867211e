"""Names made short: cut in the middle, and never to equality."""

from collections.abc import Iterable, Iterator

__all__ = ["TITLE", "shortened"]

TITLE = 36
"""Characters of a name above a small picture."""


def shortened(names: Iterable[str], width: int) -> dict[str, str]:
    """Every name with at most `width` characters, as far as all stay different.

    What is too long loses its middle. Where two would read alike, the cut moves; where no cut tells all of them apart, the
    names keep more characters than asked for.

    Parameters
    ----------
    names : iterable of str
        Different names; equal ones count once.
    width : int
        Characters, at least 3.

    Returns
    -------
    dict of str to str
        Short name of each, all different.

    Examples
    --------
    >>> shortened(["sliding_mode_published", "sliding_mode_equation_19", "off"], 12)
    {'sliding_mode_published': 'slidin…ished', 'sliding_mode_equation_19': 'slidin…on_19', 'off': 'off'}
    """
    known = list(dict.fromkeys(names))
    for wide in range(max(width, 3), max((len(name) for name in known), default=3) + 1):
        for head in _heads(wide):
            found = {name: _cut(name, wide, head) for name in known}
            if len(set(found.values())) == len(known):
                return found
    return {name: name for name in known}


def _heads(width: int) -> Iterator[int]:
    """Characters before the cut, from half of them outwards."""
    half = width // 2
    for away in range(width):
        for head in dict.fromkeys((half - away, half + away)):
            if 0 <= head < width:
                yield head


def _cut(name: str, width: int, head: int) -> str:
    if len(name) <= width:
        return name
    tail = width - head - 1
    return f"{name[:head]}…{name[len(name) - tail :]}"
