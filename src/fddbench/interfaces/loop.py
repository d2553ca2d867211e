"""What a benchmark's closed loop must offer."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Row, Rows, record
from fddbench.interfaces.bus import Bus
from fddbench.interfaces.fault import Fault
from fddbench.interfaces.floats import Floats

__all__ = ["FlightFaults", "Flights", "Loop", "Prepared", "Sample"]


@dataclass(frozen=True, kw_only=True, eq=False)
class FlightFaults:
    """Which faults some flights have.

    Attributes
    ----------
    lists : sequence of sequences of Fault
        The faults of each scenario, in the order of its lines: fault slot 0, 1, … A number that differs from flight to flight
        is an array with an entry for each flight of that scenario, in their order.
    which : (n_cases,) array of int
        Scenario of each flight, a position in `lists`.
    uniform : (n_slots, n_sites, n_cases) array
        Numbers in (0, 1) for what a fault draws once a flight, by slot and by site of the benchmark.
    """

    lists: Sequence[Sequence[Fault]]
    which: npt.NDArray[np.int64]
    uniform: Floats


@dataclass(frozen=True, kw_only=True, eq=False)
class Flights:
    """Flights to start together.

    Attributes
    ----------
    parameters : mapping of str to (n_cases,) arrays
        Every parameter of the plant, true values.
    manoeuvres : sequence of str
        One name per case.
    faults : FlightFaults
        What breaks.
    normals : record
        What `Loop.before` names, (n_cases,) or (n, n_cases) standard normal numbers each.
    """

    parameters: Mapping[str, Floats]
    manoeuvres: Sequence[str]
    faults: FlightFaults
    normals: Any

    @property
    def n_cases(self) -> int:
        """Number of flights."""
        return len(self.manoeuvres)


@dataclass(frozen=True, kw_only=True, eq=False)
class Prepared:
    """Flights made ready: constants as a record of `Loop.constants`, and per case why it cannot fly ("": it can)."""

    constants: Any
    infeasible_reason: tuple[str, ...]


@record
class Sample:
    """What a loop shows of a sample.

    Attributes
    ----------
    measured : SimpleNamespace
        The signals of the bus.
    truth : mapping of str to (n_cases,) rows
        What nobody measures, by the names of `Loop.truth`.
    departed : boolean (n_cases,) row
        Flights that have left what the model describes; this sample is not scored.
    added : (n_sites, n_cases) rows or None
        What the faults really add on each site of the bus, faulty minus healthy, in its unit: what estimates are scored
        against. None: the benchmark does not say, and no estimate is scored.
    voted : mapping of str to (n_cases,) rows
        Error of each voted signal of the bus, voted minus true, by its name.
    """

    measured: SimpleNamespace
    truth: Mapping[str, Rows]
    departed: Row
    added: Rows = None
    voted: Mapping[str, Row] = field(default_factory=dict)


class Loop(Protocol):
    """A benchmark in closed loop, for one set of options: a block that is fed with the number of the sample.

    Attributes
    ----------
    before : Draws
        What is random before the first sample, handed to `prepare` by name.
    truth : tuple of str
        Names of what `Sample.truth` has.

    **Consequences.** A loop may announce ``consequences``, a tuple of `fddbench.interfaces.Consequence`: what faults do to the
    aircraft, numbers of its true signals. Each becomes a column of the rows; a loop without them has none.

    **Size.** A loop may say by ``in_python``, a sentence, that it is too large to be compiled; "" or nothing: it is not.

    **Reconfiguration.** A loop with ``reconfigures = True`` can act on what a detector declares: its step takes a keyword
    ``declared=None`` besides. Where a campaign says ``reconfigure: NAME``, it is called with (n_sites, n_cases) rows in the
    order of the bus: 1 where that detector declared a site at the sample before, else 0; all 0 at sample 0, and always 0 at
    sites that it does not watch. Everywhere else the step is called without. A loop does not remember declarations of its own
    accord: a detector that takes one back ends what the loop does about it, unless the loop latches it in its states. Rows of
    zeros give the flight that None gives, bit for bit.
    """

    bus: Bus
    states: Layout[Any]
    constants: Layout[Any]
    draws: Draws[Any]
    before: Draws[Any]
    truth: tuple[str, ...]

    def prepare(self, flights: Flights) -> Prepared:
        """Constants of flights; vectorised, may iterate (trim), with the same bits in any company."""
        ...

    def start(self, c: Any) -> Any:
        """State before sample 0, a record of `states`; plain numbers where every flight starts alike."""
        ...

    def step(self, x: Any, c: Any, n: Any, sample: Any) -> tuple[Any, Sample]:
        """State at the next sample, and what there is to see at this one."""
        ...
