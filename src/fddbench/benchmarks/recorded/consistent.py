"""What in a mapping does not fit together."""

from collections.abc import Iterator

from fddbench.benchmarks.recorded.mapping import ChannelMap
from fddbench.errors import did_you_mean
from fddbench.units import UNITS, unit_of_name

__all__ = ["inconsistent"]


def inconsistent(mapping: ChannelMap) -> Iterator[str]:
    """Every contradiction in a mapping whose keys are right."""
    logs, sites = [log.name for log in mapping.logs], [name for on in mapping.sites for name in on.names]
    for what, names in (("log", logs), ("site", sites), ("log's file or piece", _pieces(mapping))):
        for name in sorted({name for name in names if names.count(name) > 1}):
            yield f"the {what} {name} is there twice; give each its own"
    yield from _signals(mapping)
    placed = [on.signal for on in mapping.sites]
    for on in mapping.sites:
        own = mapping.signals.get(on.signal)
        if own is None:
            hint = did_you_mean(on.signal, mapping.signals)
            yield " ".join(
                filter(
                    None, [f"sites: no signal is called {on.signal}.", hint, f"Signals: {', '.join(mapping.signals)}"]
                )
            )
        elif own.vote is not None:
            yield f"sites: {on.signal} is voted; faults sit on the signal that is voted, {own.vote}"
        elif len(on.names) > max(own.rows, 1):
            rows = max(own.rows, 1)
            yield f"sites: {on.signal} has {rows} rows and cannot have the {len(on.names)} sites {', '.join(on.names)}"
        if placed.count(on.signal) > 1:
            yield f"sites: {on.signal} is there twice; name all its sites in one entry"
        if unit_of_name(on.signal) not in UNITS:
            yield f"sites: {on.signal} carries no unit that fault sites may have; known: {', '.join(filter(None, UNITS))}"


def _signals(mapping: ChannelMap) -> Iterator[str]:
    for name in mapping.signals.keys() & mapping.truth.keys():
        yield f"{name} is a signal and a truth; rename one (what is true is called as r_true_deg_s)"
    if not any(own.columns for own in mapping.signals.values()):
        yield "signals: nothing comes from a log; map at least one channel"
    for name, own in mapping.truth.items():
        if not own.columns or own.rows:
            yield f"truth.{name}: what is true comes from one column of the log each"
    for name, own in mapping.signals.items():
        if own.vote is not None:
            voted = mapping.signals.get(own.vote)
            if voted is None or voted.rows < 2:
                yield f"signals.{name}: votes {own.vote}, which must be a signal of two or more rows"
            if own.true is not None and own.true not in mapping.truth:
                yield f"signals.{name}: true says {own.true}, which truth does not have"


def _pieces(mapping: ChannelMap) -> list[str]:
    return [f"{log.file} from {log.start_s} to {log.end_s} s" for log in mapping.logs]
