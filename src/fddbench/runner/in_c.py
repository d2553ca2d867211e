"""Detectors that fly as compiled C in a process of their own: exported here, or code that was not written here."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.blocks.layout import Layout, Rows, record
from fddbench.blocks.primitives import Symbolic
from fddbench.campaign.meaning import Campaign
from fddbench.designs.adapted import Adapted
from fddbench.designs.design import Design
from fddbench.designs.design_file import Limits
from fddbench.errors import CampaignError, DesignError, FddbenchError, Mistake
from fddbench.exported.child import Child, CodeError, GoneError
from fddbench.exported.child_main import main_text
from fddbench.exported.code import sources
from fddbench.exported.compiling import Compiler, built, compiler
from fddbench.exported.flown_c import FlownC
from fddbench.exported.interface import Interface, interface_of
from fddbench.exported.load_c import load_in_c
from fddbench.exported.symbols import library, require_symbols
from fddbench.interfaces import Bus, Floats, Verdict
from fddbench.runner.assembly import Assembly

__all__ = ["InC", "as_c", "code_of_design", "in_c_words", "loads_in_c", "require_allowed"]


_TRIES = 3


@record
class CodeState:
    """Bytes of the code's state, in words of eight."""

    words: Rows


class InC:
    """Steps many flights of a detector in compiled C, the state passed in and out as for every detector.

    Parameters
    ----------
    interface : Interface
        What the header says.
    files : mapping of str to str
        Headers and sources by name.
    whose : Adapted
        The detector in Python, which says what is watched and shown.
    by : Compiler
        Who compiles.
    exported : bool
        It was written here, and keeps nothing but its state.
    """

    batched = True

    def __init__(
        self, interface: Interface, files: Mapping[str, str], whose: Adapted, by: Compiler, *, exported: bool = False
    ) -> None:
        self.interface, self.files, self.by, self.exported = interface, dict(files), by, exported
        self.recorded, self.watches, self.isolates = whose.recorded, whose.watches, whose.isolates
        self.sees, self.estimates, self._whose = whose.sees, whose.estimates, whose
        self.program = built({**files, "flown_by_fddbench.c": main_text(interface.name)}, by)
        self._running: tuple[int, FlownC] | None = None
        self._limits = Limits() if whose.design is None else whose.design.limits
        begun = self._flown()
        self._start = begun.start[:, np.newaxis].copy()
        self.states = Layout(CodeState(words=begun.words))

    def __getstate__(self) -> dict[str, Any]:
        """Everything but the running process."""
        return {**vars(self), "_running": None}

    def again(self) -> "InC":
        """The same in a new process."""
        return InC(self.interface, self.files, self._whose, self.by, exported=self.exported)

    def start(self) -> CodeState:
        """What the init function makes."""
        return CodeState(words=self._start)

    def step(self, x: CodeState, measured: SimpleNamespace) -> tuple[CodeState, Verdict]:
        """One sample of many flights.

        Raises
        ------
        CodeError
            The code ended three times at this step, each time in a new process, or does not answer.
        """
        if isinstance(x.words, Symbolic):
            raise DesignError(f"it is C, compiled by {self.by}")
        words, given = self._tried(np.asarray(x.words), vars(measured))
        estimate = given.get("estimate")
        return CodeState(words=words), Verdict(
            given["declared"] if self.isolates else None,
            given["residual"][0],
            signals={name: given[name][0] for name in self.recorded},
            alarm=given["alarm"][0],
            estimate=estimate if estimate is None or self.estimates == "sites" else estimate[0],
        )

    def _tried(self, words: Floats, measured: Mapping[str, Floats]) -> tuple[Floats, dict[str, Floats]]:
        """State and outputs; a new process goes on where one has ended, for all its state comes with the step.

        It may have been ended from outside, or have leaked until nothing was left.
        """
        for left in reversed(range(_TRIES)):
            try:
                return self._flown().step(words, measured)
            except CodeError as error:
                self._running = None
                if not (left and isinstance(error, GoneError)):
                    raise
        raise AssertionError  # the last try returns or raises

    def _flown(self) -> FlownC:
        """The running code; of this process, for a child belongs to the process that began it."""
        if self._running is None or self._running[0] != os.getpid():
            own, memory_mb = self._limits, 0.0 if self.exported else self._limits.memory_mb
            child = Child(self.program, patience_s=own.step_s, memory_mb=memory_mb)
            self._running = os.getpid(), FlownC(self.interface, child)
        return self._running[1]


def as_c(assembly: Assembly) -> Assembly:
    """The same assembly whose traced detectors fly as exported C.

    Raises
    ------
    FddbenchError
        There is no compiler.
    """
    by, detectors = compiler(), {}
    for name, own in assembly.detectors.items():
        detectors[name] = own if own.opaque or own.draws.size else _exported(name, own, assembly.loop.bus, by)
    return replace(assembly, detectors=detectors)


def _exported(name: str, own: Adapted, bus: Bus, by: Compiler) -> Adapted:
    interface = interface_of(own, bus, name=name)
    return Adapted(InC(interface, sources(interface, own.detector), own, by, exported=True), bus, own.every)


def in_c_words(name: str, own: Adapted, bus: Bus) -> str:
    """What a detector takes as exported C, in one line; or why nobody knows."""
    try:
        interface, by = interface_of(own, bus, name=name), compiler()
        return str(load_in_c(interface, sources(interface, own.at_every_sample.detector), by))
    except FddbenchError as error:
        return f"in C: not known, {error}"


def loads_in_c(flown: Mapping[str, InC]) -> dict[str, dict[str, Any]]:
    """What exported detectors take, measured by the compiler that they fly with; without those that nobody could measure."""
    found = {}
    for name, own in flown.items():
        if own.exported:
            try:
                found[name] = asdict(load_in_c(own.interface, own.files, own.by))
            except FddbenchError:
                continue  # a machine without binutils flies all the same
    return found


def code_of_design(design: Design, own: Adapted, bus: Bus) -> Adapted:
    """A detector, or the C that a design names in its place.

    Raises
    ------
    CampaignError
        The code does not compile, or has other structs than the header that is exported from the design.
    """
    if not design.code:
        return own
    files = {
        name.removeprefix(design.code.rstrip("/") + "/"): text.decode("utf-8", "replace")
        for name, text in design.files.items()
        if name.startswith(design.code.rstrip("/") + "/") and name.endswith((".c", ".h"))
    }
    try:
        interface = interface_of(own, bus, name=_prefix(files, design))
        return Adapted(InC(interface, files, own, compiler()), bus, design.every)
    except FddbenchError as error:
        raise CampaignError((Mistake(design.where, f"design {design.name!r}, code {design.code}: {error}"),)) from error


def _prefix(files: Mapping[str, str], design: Design) -> str:
    """Prefix of the functions: the name of the design, or of the one header that has them."""
    names = [name.removesuffix(".h") for name in files if name.endswith(".h")]
    own = [name for name in names if f"{name}_step" in files[f"{name}.h"] and f"{name}_init" in files[f"{name}.h"]]
    if design.base in own:
        return design.base
    if len(own) != 1:
        raise DesignError(
            f"needs one header NAME.h with NAME_init and NAME_step, as fddbench export writes it; "
            f"found {', '.join(own) or 'none'}"
        )
    return own[0]


def require_allowed(campaign: Campaign, detectors: Mapping[str, Adapted], bus: Bus) -> None:
    """Do nothing where every detector keeps to the symbols that its design or the campaign states.

    Raises
    ------
    CampaignError
        What they need beyond them, and in which lines.
    """
    mistakes = []
    for design in campaign.designs:
        for symbols in _stated(design, campaign):
            own = detectors[design.name]
            try:
                require_symbols(interface_of(own, bus, name=design.name).program, library(symbols), design.name)
            except DesignError as error:
                mistakes.append(Mistake(design.where, str(error)))
    if mistakes:
        raise CampaignError(tuple(mistakes))


def _stated(design: Design, campaign: Campaign) -> Sequence[Any]:
    return [symbols for symbols in (design.symbols, campaign.symbols) if symbols is not None]
