"""The smallest factor on all thresholds of a design that keeps a target, found from coarse to fine."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from fddbench.design.tuning.promise import Promise, Target
from fddbench.errors import DesignError

__all__ = ["FoundFactor", "smallest_factor"]

Promised = Callable[[Sequence[float]], Mapping[float, Promise]]
"""What factors promise; one that the kind of the design refuses is left out."""

_FAR, _STEPS, _INSIDE = 6, 6, 12
"""Powers of two looked at first, how many more then in one direction, and points between two factors."""


@dataclass(frozen=True, kw_only=True)
class FoundFactor:
    """A factor on thresholds.

    Attributes
    ----------
    factor : float
        The smallest that was tried and keeps the target, as do all larger ones that were tried [-].
    resolution : float
        A factor smaller by this share was tried and does not keep it [-].
    promise : Promise
        What it promises.
    tried : int
        Factors tried in all: each has flown all flights.
    """

    factor: float
    resolution: float
    promise: Promise
    tried: int


def smallest_factor(promised: Promised, target: Target, *, resolution: float = 0.005) -> FoundFactor:
    """Smallest factor that keeps a target, to a relative resolution.

    First the powers of two from 1/64 to 64, further out where these do not enclose it, then twelve factors in equal ratios
    between the last that fails and the first that holds, until they are close enough.

    Raises
    ------
    DesignError
        No factor keeps it, or all do.
    """
    known = dict(promised([2.0**n for n in range(-_FAR, _FAR + 1)]))
    if not known:
        raise DesignError("the kind refuses every factor on its thresholds from 1/64 to 64")
    tried = len(known)
    further: list[float] = []
    if not target.kept(known[max(known)]):
        further = [max(known) * 2.0**n for n in range(1, _STEPS + 1)]
    elif all(map(target.kept, known.values())):
        further = [min(known) / 2.0**n for n in range(1, _STEPS + 1)]
    if further:
        more = promised(further)
        tried, known = tried + len(more), known | dict(more)
    fails, holds = _enclosed(known, target)
    while holds / fails - 1.0 > resolution:
        ratio = (holds / fails) ** (1.0 / (_INSIDE + 1))
        more = promised([fails * ratio**n for n in range(1, _INSIDE + 1)])
        tried, known = tried + len(more), known | dict(more)
        if not more:
            break
        fails, holds = _enclosed(known, target)
    return FoundFactor(factor=holds, resolution=holds / fails - 1.0, promise=known[holds], tried=tried)


def _enclosed(known: Mapping[float, Promise], target: Target) -> tuple[float, float]:
    """The largest factor that does not keep the target, and the next larger one."""
    failing = [factor for factor in sorted(known) if not target.kept(known[factor])]
    if not failing:
        raise DesignError(
            f"even {min(known):.3g} times the thresholds keep {target.words} ({known[min(known)].alarms} alarms in "
            f"{known[min(known)].flights} flights): these flights do not excite the detector, there is nothing to choose from"
        )
    above = [factor for factor in sorted(known) if factor > failing[-1]]
    if not above:
        last = known[failing[-1]]
        raise DesignError(
            f"no factor on the thresholds keeps {target.words}: with {failing[-1]:.3g} times their size, the most that the "
            f"kind takes or that was tried, {last.alarms} of {last.flights} flights still alarm; something else in it alarms"
        )
    return failing[-1], above[0]
