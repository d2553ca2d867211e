"""What an exported detector takes, keeps and gives: the members of its three structs, each with its unit."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from inspect import getdoc
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.blocks.layout import Layout, Nothing
from fddbench.blocks.program import Program
from fddbench.designs.adapted import Adapted
from fddbench.designs.tracing import detector_program
from fddbench.errors import DesignError
from fddbench.exported.naming import identifier
from fddbench.interfaces import Bus
from fddbench.units import unit_of_name

__all__ = ["Interface", "Member", "interface_of"]

_MEANINGS = {
    "alarm": "1 while something is wrong, else 0",
    "residual": "largest residual over its threshold [-]; above 1 a fault is suspected",
    "declared": "1 where a site is declared faulty, else 0",
}


@dataclass(frozen=True)
class Member:
    """One member of a struct.

    Attributes
    ----------
    name, source : str
        In C, and in Python: a signal of the bus, a path in the state, an output.
    rows : int
        Length of the array; 0 for a single number.
    comment : str
        Unit and meaning.
    """

    name: str
    source: str
    rows: int
    comment: str = ""

    @property
    def size(self) -> int:
        """Numbers in it."""
        return self.rows or 1

    def at(self, row: int) -> str:
        """How C writes one of its numbers."""
        return f"{self.name}[{row}U]" if self.rows else self.name


@dataclass(frozen=True, kw_only=True)
class Interface:
    """Structs of a detector, and the program between them.

    Attributes
    ----------
    name : str
        Prefix of everything that other files see.
    inputs, state, outputs : tuple of Member
        In the order of their structs.
    start : (n_state,) array
        State before the first sample.
    program : Program
        One step on the detector's own clock, with the inputs ``state`` and the signals it reads, an output a member.
    step_s : float
        Time from call to call [s].
    sites : tuple of str
        Those it declares, in the order of ``declared``.
    about : str
        What the design says of itself.
    """

    name: str
    inputs: tuple[Member, ...]
    state: tuple[Member, ...]
    outputs: tuple[Member, ...]
    start: npt.NDArray[np.float64]
    program: Program
    step_s: float
    sites: tuple[str, ...]
    about: str = ""

    @cached_property
    def leaves(self) -> Mapping[tuple[str, int], str]:
        """How C reads each input row of the program, by its name and row."""
        found, row = {}, 0
        for member in self.state:
            for own in range(member.size):
                found["state", row] = f"x->{member.at(own)}"
                row += 1
        for member in self.inputs:
            found |= {(member.source, own): f"in->{member.at(own)}" for own in range(member.size)}
        return found

    @property
    def state_places(self) -> list[str]:
        """How C writes each row of the state."""
        return [f"x->{member.at(row)}" for member in self.state for row in range(member.size)]

    @property
    def numbers(self) -> tuple[int, int, int]:
        """How many there are of inputs, states and outputs."""
        return tuple(sum(member.size for member in part) for part in (self.inputs, self.state, self.outputs))  # type: ignore[return-value]


def interface_of(detector: Adapted, bus: Bus, *, name: str, about: str = "", step_s: float | None = None) -> Interface:
    """Interface of a detector that can be traced.

    Raises
    ------
    DesignError
        It is ordinary Python, or draws random numbers.
    """
    if detector.opaque:
        raise DesignError(f"{name} is ordinary Python and cannot become C: {detector.opaque}")
    if detector.draws.size:
        raise DesignError(
            f"{name} draws random numbers in flight ({detector.draws.size} a step); a flight computer has none"
        )
    alone = detector.at_every_sample
    sites = detector.watches if detector.isolates else ()
    program = _watched(detector_program(alone, bus), alone, bus)
    read = {value[0] for op, _, value in program.nodes if op == "input"}
    inputs = tuple(_input(signal, rows, bus) for signal, rows in bus.signals.items() if signal in read)
    start = alone.own_states.pack(alone.start(Nothing()), 1)[:, 0]
    return Interface(
        name=identifier(name), inputs=inputs, state=_state(alone.own_states), outputs=_outputs(program, detector),
        start=np.array(start, dtype=float), program=program, sites=sites, about=about,
        step_s=step_s or round(detector.every * bus.sample_s, 12),
    )  # fmt: skip


def _watched(program: Program, detector: Adapted, bus: Bus) -> Program:
    """The program with declarations of watched sites only."""
    outputs = dict(program.outputs)
    rows = [bus.names.index(site) for site in detector.watches]
    outputs["declared"] = tuple(outputs["declared"][row] for row in rows) if detector.isolates else ()
    if detector.estimates == "sites":
        outputs["estimate"] = tuple(outputs["estimate"][row] for row in rows)
    kept = {key: nodes for key, nodes in outputs.items() if nodes or key == "state"}
    return Program(program.inputs, program.nodes, kept, program.origins).keep(*kept)


def _input(signal: str, rows: int, bus: Bus) -> Member:
    of = bus.sites_on(signal)
    unit = unit_of_name(signal)
    whose = f", of {', '.join(of)}" if of and len(of) == (rows or 1) else ""
    return Member(identifier(signal), signal, rows, f"[{unit or '-'}]{whose}")


def _state(layout: Layout[Any]) -> tuple[Member, ...]:
    return tuple(
        Member(identifier(path), path, rows, _unit(path) or _kept(layout.shape, path))
        for path, rows in layout.counts.items()
    )


def _unit(name: str) -> str:
    unit = unit_of_name(re.sub(r"_\d+$", "", name))
    return f"[{unit}]" if unit and not re.search(r"(^|[._])[a-z]?_[a-z]$", name) else ""


def _kept(shape: Any, path: str) -> str:
    """First line of the docstring of the record that a leaf lies in, for its first leaf."""
    parts, record = path.split("."), shape
    for part in parts[:-1]:
        record = record[int(part)] if isinstance(record, tuple) else getattr(record, part)
    fields = list(getattr(record, "__dataclass_fields__", ()))
    text = re.sub(r",? \([^()]*n_cases\)( each)?", "", (getdoc(type(record)) or "").split("\n")[0])  # shapes of Python
    return text.encode("ascii", "replace").decode() if fields and fields[0] == parts[-1] else ""


def _outputs(program: Program, detector: Adapted) -> tuple[Member, ...]:
    found = []
    for name, rows in program.outputs.items():
        if name == "state":
            continue
        comment = _MEANINGS.get(name, f"[{unit_of_name(name) or '-'}]")
        several = len(rows) if name == "declared" or (name == "estimate" and detector.estimates == "sites") else 0
        if several:
            comment = f"{comment}; {', '.join(detector.watches)}"
        if name == "estimate" and detector.estimates:
            of = (
                "of each site, in its own unit"
                if several
                else f"of {detector.estimates} [{unit_of_name(detector.estimates) or '-'}]"
            )
            comment = f"size of the fault {of}"
        found.append(Member(identifier(name), name, several, comment))
    return tuple(found)
