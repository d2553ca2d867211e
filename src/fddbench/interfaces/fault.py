"""What a kind of fault must offer."""

from collections.abc import Sequence
from typing import Any, ClassVar, Protocol

from fddbench.blocks.layout import Layout, Row, Rows, record
from fddbench.interfaces.floats import Floats
from fddbench.interfaces.site import Site

__all__ = ["Fault", "FaultBlock", "Instant"]


@record
class Instant:
    """A sample as a fault sees it, (n_sites, n_cases) each.

    Attributes
    ----------
    since_samples : rows
        Samples since the onset on each site; negative before.
    time_s : rows
        The same in seconds, 0 while the fault is not there.
    active : boolean rows
        Where the fault is there.
    sign : rows
        1, or -1 on every second site of faults with opposite sign.
    random : rows or None
        A standard normal number a site, the same on all sites unless the fault is independent; None unless the kind is
        `random`.
    sample : row
        Number of the sample since the start of the flight, the same for all sites and flights.
    free : rows or None
        What the sites would show if they floated, in their unit; None where the loop has no site that floats.
    """

    since_samples: Rows
    time_s: Rows
    active: Rows
    sign: Rows
    random: Rows
    sample: Row
    free: Rows = None


class FaultBlock(Protocol):
    """What flies of a kind of fault on some sites: its constants per flight, its states, and its step."""

    states: Layout[Any]
    constants: Layout[Any]

    def start(self, c: Any) -> Any:
        """State before sample 0."""
        ...

    def step(self, x: Any, c: Any, reading: Rows, now: Instant) -> tuple[Any, Rows]:
        """State at the next sample, and what the sites show, (n_sites, n_cases).

        `reading` is what the fault acts on: the signal, or with ``mode: replace`` what stands in its place. What is given
        where the fault is not active is not used.
        """
        ...


class Fault(Protocol):
    """A fault as a campaign writes it: a pydantic model registered under ``fddbench.faults``.

    `fddbench.faults.specification.FaultSpecification` brings all of this but the sizes and the block.
    """

    random: ClassVar[bool]
    """Whether the kind draws a normal number at every sample."""

    @property
    def kind(self) -> str:
        """Kind as result columns call it."""
        ...

    @property
    def mode(self) -> str:
        """``add`` or ``replace``."""
        ...

    @property
    def sites(self) -> tuple[str, ...]:
        """Faulty sites."""
        ...

    @property
    def onset_s(self) -> Any:
        """First faulty sample of the first site [s]; a number, in flight also (n_cases,), as written also `Varied`."""
        ...

    @property
    def end_s(self) -> Any:
        """First healthy sample again [s]; None: never."""
        ...

    @property
    def correlation(self) -> str:
        """``identical``, ``independent`` or ``opposite``."""
        ...

    @property
    def delay_s(self) -> Any:
        """Later onset from site to site [s]."""
        ...

    @property
    def freeze(self) -> bool:
        """Whether the signal stands at its last reading."""
        ...

    def numbers(self, site: Site, uniform: Floats) -> Any:
        """Constants of the block on one site, a record of numbers or (n_cases,) arrays, in the unit of the site.

        The fault's own numbers are numbers or (n_cases,) arrays here, so compute with them as with arrays.

        `uniform`, (n_cases,), holds a number in (0, 1) of each flight, for what is drawn once.
        """
        ...

    def held(self, site: Site) -> Any:
        """What stands in place of the signal with ``mode: replace``, in the unit of the site."""
        ...

    @classmethod
    def block_for(cls, faults: Sequence[Any], n_sites: int, sample_s: float) -> FaultBlock:
        """What flies of these faults of this kind, as they are written, on so many sites."""
        ...
