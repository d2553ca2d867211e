"""What opaque detectors are put through before all others fly: whether they fail always, and whether their rows are theirs.

Compiled code sees a sample of a flight and nothing else. Python sees what it likes: other flights, what it kept from the last
one, a generator of random numbers, the clock. So some flights are flown twice: in company by the detector that flew the first
flights, and alone, for a shorter time, by a new one. Every verdict must be the same to the last bit.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fddbench.designs.adapted import Adapted
from fddbench.errors import DesignError
from fddbench.interfaces import Floats
from fddbench.runner.assembly import Assembly, Batch
from fddbench.runner.eager import DetectorFlight
from fddbench.runner.firsts import first_flights
from fddbench.runner.flight import Flyer
from fddbench.runner.given_up import GivenUp
from fddbench.runner.in_c import InC
from fddbench.runner.supervised.verdicts import Supervised

__all__ = ["rehearse", "rehearsed"]

_DEATHS = 3
"""How often sound flights are flown again whose process was ended; then nothing is said of the detector."""

_HANGS = 2
"""First flights that end with `timeout` after which a detector is given up; part of the result."""

_ALONE, _SIDE_BY_SIDE, _LONGEST, _SHORTER = 5, 64, 2000, 25
"""Flights that are flown again alone, flights beside them where that costs nothing, samples of each at most, and how many fewer
are flown alone."""


def rehearsed(flyer: Flyer, notice: Callable[[str], None] | None = None) -> Flyer:
    """The same flyer without the detectors that are given up; told which these are, and which fly in Python.

    Raises
    ------
    DesignError
        As `rehearse`.
    """
    given_up = rehearse(flyer)
    for name, reason in flyer.opaque.items():
        own = flyer.assembly.detectors[name]
        if notice is None:
            break
        if name in given_up:
            rest = "all its rows are `error`, the other detectors fly"
            if name == flyer.assembly.commander:
                rest = "the aircraft acts on it, so nothing is flown and all rows are `error`"
            notice(f"{name} is {given_up[name].said}; {rest}")
        elif isinstance(own.detector, InC):
            notice(f"{name} flies as C in a process of its own, compiled by {own.detector.by}")
        elif own.one_by_one or flyer.compiled:
            how = "one flight at a time" if own.one_by_one else "many flights side by side"
            all_ = ", and with it the aircraft that acts on it" if name == flyer.assembly.commander else ""
            notice(f"{name} cannot be compiled and flies in Python, {how}{all_}: {reason}")
    return Flyer(flyer.assembly, flyer.backend, given_up) if given_up else flyer


def rehearse(flyer: Flyer) -> dict[str, GivenUp]:
    """Detectors that are given up; nothing but the plan, the detectors and their code has a part in it.

    Raises
    ------
    DesignError
        What detectors decide on a flight depends on something else than what is measured in it.
    """
    first = first_flights(flyer.assembly) if flyer.opaque else None
    if first is None:
        return {}
    given_up, wrong = {}, []
    for name in flyer.opaque:
        own = flyer.assembly.detectors[name].detector
        if isinstance(own, InC) and own.exported:
            continue
        given = _always_failing(flyer, name, first)
        if given is not None:
            given_up[name] = given
        elif different := _difference(flyer, name):
            wrong.append(f"{name} {different}")
    if wrong:
        raise DesignError("\n".join(wrong))
    return given_up


def _always_failing(flyer: Flyer, name: str, first: Batch) -> GivenUp | None:
    """The detector's end, if it raises the same at the same line on each of the first flights; flown one after another."""
    reasons: dict[int, str] = {}
    lines: set[tuple[str, str]] = set()
    for i, case in enumerate(first.cases.tolist()):
        batch = first.take(np.array([i]))
        flight = DetectorFlight(flyer.assembly, name, batch, feed=flyer.feed)
        flyer.feed(batch, [flight])
        _, errors = flight.finish()
        raised = flight.verdicts.raised[0]
        if not raised or not errors[0]:
            return None
        reasons[case] = errors[0]
        lines.add(raised[1])
        if len(lines) > 1:
            return None
        if raised[1][0] == "timeout" and len(reasons) == _HANGS:
            break  # each takes as long as a step may
    return GivenUp(reasons=tuple(reasons.items()))


def _difference(flyer: Flyer, name: str) -> str:
    """In which way a detector's verdicts on a flight depend on something else; "" for not at all."""
    assembly, batched = flyer.assembly, flyer.assembly.detectors[name].batched
    together = _sound_company(flyer, name, _SIDE_BY_SIDE if batched else _ALONE)
    if together is None:
        return ""
    last = assembly.ends(together.batch)
    prefix = assembly.shortened(together.batch, np.maximum(last - _SHORTER, np.floor(last / 2.0)))
    fresh = replace(assembly, detectors={**assembly.detectors, name: _made_again(assembly, name)})
    for i in _chosen(together):
        one = prefix.take(np.array([i]))
        alone = _heard(flyer, fresh, name, one)
        found = _first_difference(together, i, alone)
        if found:
            again = _heard(flyer, assembly, name, one) if batched else alone
            by_company = batched and not _first_difference(again, 0, alone)
            return _told(assembly, one, found, len(last), by_company=by_company)
    return ""


def _sound_company(flyer: Flyer, name: str, most: int) -> DetectorFlight | None:
    """A detector on some flights together, without those on which it raises where that ends the flight of all."""
    assembly = flyer.assembly
    batch = _company(assembly, most)
    batch = assembly.shortened(batch, float(_LONGEST))
    together = _heard(flyer, assembly, name, batch)
    if not together.over:
        return together
    for _ in range(_DEATHS):
        batch = batch.take(np.flatnonzero([not error for error in together.finish()[1]]))
        if not len(batch.cases):
            break
        together = _heard(flyer, assembly, name, batch)
        if not _ended_with_its_process(together):
            return together
    return None


def _ended_with_its_process(flight: DetectorFlight) -> bool:
    """Whether flights ended because their process did: a machine that is short of memory says nothing of the detector."""
    verdicts = flight.verdicts
    return isinstance(verdicts, Supervised) and bool(len(verdicts.lost) or len(verdicts.doubt))


def _company(assembly: Assembly, most: int) -> Batch:
    """Flights from all of the plan, the first one among them."""
    first = first_flights(assembly, 1)
    spread = np.unique(np.linspace(0, assembly.plan.n_cases - 1, 8 * most).astype(np.int64))
    batch = assembly.batch(spread)
    able = spread[[not reason for reason in batch.infeasible_reason]]
    cases = np.unique(np.concatenate([[] if first is None else first.cases, able]).astype(np.int64))
    return assembly.batch(cases[_spread(len(cases), most)])


def _chosen(together: DetectorFlight) -> list[int]:
    """Places of the flights that are flown again: some from all of them, and those that alarmed first."""
    heard = _padded(together, len(together.heard))[:, together.names.index("alarm")] > 0.0
    since = np.where(heard.any(axis=0), heard.argmax(axis=0), len(heard))
    early = (
        np.argsort(since, kind="stable")[: _ALONE // 2] if together.detector.batched else np.empty(0, dtype=np.int64)
    )
    return sorted({*_spread(len(since), _ALONE).tolist(), *early.tolist()})


def _spread(n: int, most: int) -> npt.NDArray[np.int64]:
    """At most so many places among n, the first and the last among them."""
    return np.unique(np.linspace(0, n - 1, most).astype(np.int64))


def _made_again(assembly: Assembly, name: str) -> Adapted:
    """The same detector, newly made of its design."""
    own = assembly.detectors[name]
    if isinstance(own.detector, InC):
        return Adapted(own.detector.again(), own.bus, own.every)
    for design in assembly.plan.campaign.designs:
        if design.name == name:
            made = Adapted(design.build(own.bus), own.bus, design.every, design)
            return made if type(made.detector) is type(own.detector) else own
    return own


def _heard(flyer: Flyer, assembly: Assembly, name: str, batch: Batch) -> DetectorFlight:
    """A detector on a batch, every verdict kept."""
    flight = DetectorFlight(assembly, name, batch, hear=True, feed=flyer.feed)
    flyer.feed(batch, [flight])
    return flight


Difference = tuple[int, str, float, float]
"""Sample, what differs, and its value in company and alone."""


def _first_difference(together: DetectorFlight, j: int, alone: DetectorFlight) -> Difference | None:
    """First difference of verdicts on a flight that flew in company at place `j`, and alone for a shorter time."""
    count = len(alone.heard) + alone.over  # where it raised alone, it must have raised in company
    short, long = _padded(alone, count)[:, :, 0], _padded(together, count)[:, :, j]
    differs: npt.NDArray[np.bool_] = ~((short == long) | (np.isnan(short) & np.isnan(long)))
    if not differs.any():
        return None
    sample = int(differs.any(axis=1).argmax())
    row = int(differs[sample].argmax())
    return sample, alone.names[row], float(long[sample, row]), float(short[sample, row])


def _padded(flight: DetectorFlight, count: int) -> Floats:
    """Verdicts of a flight at so many samples, not-a-number where it had raised."""
    heard = np.full((count, len(flight.names), len(flight.batch.cases)), np.nan)
    known = flight.heard[:count]
    heard[: len(known)] = np.array(known).reshape(-1, *heard.shape[1:])
    return heard


def _told(assembly: Assembly, one: Batch, found: Difference, n_cases: int, *, by_company: bool) -> str:
    """A difference in words, with what to do about it."""
    sample, what, a, b = found
    at = f"in case {assembly.plan.names(one.cases)[0]} at sample {sample}"
    values = f"{what} is {_number(a)}", f"{_number(b)}"
    if by_company:
        return (
            f"depends on its company: {at} its {values[0]} beside {n_cases - 1} other flights and {values[1]} alone. A step "
            "with batched = True may mix rows (axis 0), never flights (the last axis): np.where instead of `if`. Without "
            "batched = True it sees one flight at a time"
        )
    return (
        f"gives another verdict when a flight is flown again: {at} its {values[0]} after and beside other flights, and "
        f"{values[1]} when a new detector flies it alone. It keeps something outside its state (in itself, in its module, in "
        "one object that `start` gives to every flight), draws random numbers of its own, or reads a clock or a file. Keep it "
        "in the state, which `start` makes anew for each flight; random numbers come by `draws`"
    )


def _number(value: float) -> str:
    return "not given, since it raised," if np.isnan(value) else f"{value:.6g}"
