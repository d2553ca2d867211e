"""A place where a fault can sit: a sensor, an actuator, a component."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

from fddbench.errors import FddbenchError
from fddbench.units import Unit, unit

__all__ = ["Site", "limit_s"]


@dataclass(frozen=True, kw_only=True)
class Site:
    """A fault site of a benchmark; sites of one benchmark may differ in all of this.

    Attributes
    ----------
    name : str
        As campaigns and result columns call it, e.g. ``"r1"``.
    signal, row : str, int
        Signal of the loop that its faults act on, and which row of it (0 for a signal of one row).
    unit_name : str
        Unit of that signal as `fddbench.units` names it; "" for plain numbers. Keys of sizes follow from it.
    admissible : float
        What percent is of, in that unit.
    kind : {"sensor", "actuator", "component"}
        What it is.
    stops : (low, high)
        What it cannot pass, in that unit, faulty or not; infinite for none.
    floats : bool
        Whether it can come loose and float (a surface on its hinge); its loop says where to, as `free` of
        `fddbench.faults.injection.SignalFaults.step`.
    additive : bool
        Whether its signal is only what faults add, zero while it is healthy, so that there is nothing to lose.
    limits_s : sequence of float
        Detection time limit [s] when one, two, … sites of this signal are faulty; the last holds for more. Empty: a scenario
        must state its own.
    """

    name: str
    signal: str
    unit_name: str
    admissible: float
    row: int = 0
    kind: Literal["sensor", "actuator", "component"] = "sensor"
    stops: tuple[float, float] = (float("-inf"), float("inf"))
    floats: bool = False
    additive: bool = False
    limits_s: Sequence[float] = field(default=())

    @property
    def unit(self) -> Unit:
        """Its unit; raises FddbenchError for one that the table does not have."""
        return unit(self.unit_name)


def limit_s(sites: Sequence[Site]) -> float:
    """Detection time limit for these faulty sites [s]: each by how many of its signal are faulty, and the smallest counts.

    Raises
    ------
    FddbenchError
        No site states one.

    Examples
    --------
    >>> a, b = (Site(name=n, signal="r_deg_s", unit_name="deg/s", admissible=40.0, limits_s=(120.0, 0.36)) for n in "ab")
    >>> limit_s([a]), limit_s([a, b])
    (120.0, 0.36)
    """
    found = []
    for site in sites:
        together = sum(other.signal == site.signal for other in sites)
        if site.limits_s:
            found.append(site.limits_s[min(together, len(site.limits_s)) - 1])
    if not found:
        raise FddbenchError(f"no detection time limit is stated for {'+'.join(site.name for site in sites)}")
    return float(min(found))
