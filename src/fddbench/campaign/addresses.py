"""How a case is named: (scenario, point, level, run), written ``jam_a/3/0/17``."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fddbench.errors import FddbenchError

__all__ = ["Address", "Addresses", "read_address"]

Address = str | Sequence[int]
"""``"jam_a/3/0/17"``; within a scenario also ``"3/0/17"`` or (3, 0, 17)."""

Numbers = npt.NDArray[np.int64]

_DIGITS = 3


@dataclass(frozen=True, kw_only=True, eq=False)
class Addresses:
    """Addresses of cases, (n,) each.

    Attributes
    ----------
    scenario : array of int
        Position of the scenario in its campaign.
    point : array of int
        Number of the point of the campaign's grid and sequence.
    level : array of int
        Number of the level of the scenario's own sweeps.
    run : array of int
        Number of the Monte-Carlo draw: everything drawn belongs to it alone.
    """

    scenario: Numbers
    point: Numbers
    level: Numbers
    run: Numbers


def read_address(case: Address, scenario: str | None = None) -> tuple[str, int, int, int]:
    """Scenario, point, level and run of an address.

    Raises
    ------
    FddbenchError
        It is none, or one of another scenario than the given one.

    Examples
    --------
    >>> read_address("jam_a/3/0/17"), read_address((3, 0, 17), "jam_a")
    (('jam_a', 3, 0, 17), ('jam_a', 3, 0, 17))
    """
    own = scenario or "jam_a"
    form = f"a case is named 'scenario/point/level/run', for instance '{own}/0/0/17'; got {case!r}"
    if not isinstance(case, str):
        try:
            parts = [str(int(part)) for part in case]
        except (TypeError, ValueError) as error:
            raise FddbenchError(form) from error
    else:
        parts = case.split("/")
    if len(parts) == _DIGITS and scenario is not None:
        parts = [scenario, *parts]
    if len(parts) != _DIGITS + 1 or not all(part.isascii() and part.isdigit() for part in parts[1:]):
        raise FddbenchError(form)
    if scenario is not None and parts[0] != scenario:
        raise FddbenchError(f"{case!r} is a case of another scenario than {scenario!r}")
    return parts[0], int(parts[1]), int(parts[2]), int(parts[3])
