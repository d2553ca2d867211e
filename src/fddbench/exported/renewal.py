"""The new state in an order in which no row is overwritten that another one still needs."""

from collections.abc import Sequence

from fddbench.errors import DesignError
from fddbench.exported.rolling import Assignment

__all__ = ["renewal"]


def renewal(places: Sequence[str], values: Sequence[str]) -> list[Assignment]:
    """Assignments of values to places, where a value may be another place.

    Examples
    --------
    >>> [each.target for each in renewal(["x->b", "x->a"], ["s->y", "x->b"])]  # the shift first
    ['x->a', 'x->b']
    """
    changed = {place: value for place, value in zip(places, values, strict=True) if place != value}
    readers: dict[str, set[str]] = {}
    for place, value in changed.items():
        if value in changed:
            readers.setdefault(value, set()).add(place)
    order: list[Assignment] = []
    left = dict(changed)
    shifted = [place for place, value in changed.items() if value in places]
    for turn in (shifted[::-1], shifted, list(changed)):  # a shift register from its far end on stays a loop
        _take(turn, left, readers, order)
    if left:
        raise DesignError(f"states change places in a ring ({', '.join(left)}), which the export does not write")
    return order


def _take(turn: Sequence[str], left: dict[str, str], readers: dict[str, set[str]], order: list[Assignment]) -> None:
    """Assign those places of a turn, in its order, that nobody has to read any more."""
    for place in turn:
        if place in left and not readers.get(place):
            value = left.pop(place)
            order.append(Assignment(place, value))
            readers.get(value, set()).discard(place)
