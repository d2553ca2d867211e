"""Names in a campaign that must exist in its benchmark: choices, manoeuvres, sites, parameters."""

from collections.abc import Iterable, Iterator

from fddbench.campaign.document import Address, Document
from fddbench.errors import Mistake, did_you_mean
from fddbench.interfaces import Benchmark

__all__ = ["CHOICES", "default_choice", "unknown_names"]

CHOICES = {"plant": "plants", "voter": "voters", "sensors": "sensors", "wind": "winds"}
"""Key of a campaign → attribute of the benchmark with its options, the default first; empty: nothing to choose."""


def default_choice(benchmark: Benchmark, key: str) -> str:
    """What a campaign flies that does not say, "" where there is nothing to choose."""
    options: tuple[str, ...] = getattr(benchmark, CHOICES[key])
    return options[0] if options else ""


def unknown_names(document: Document, benchmark: Benchmark) -> Iterator[Mistake]:
    """Every name that the benchmark does not know; reads the raw data, so that other mistakes do not hide these."""
    for key, options in CHOICES.items():
        known: tuple[str, ...] = getattr(benchmark, options)
        if not known and document.get(key) is not None:
            message = f"benchmark {benchmark.name!r} has no {key} to choose; remove this key"
            yield document.mistake((key,), message, key=True)
            continue
        yield from _unknown(document, (key,), known, f"{key} of benchmark {benchmark.name!r}")
    for scenario in range(len(document.items("scenarios"))):
        address: Address = ("scenarios", scenario)
        yield from _unknown(document, (*address, "manoeuvre"), benchmark.manoeuvres, "manoeuvre")
        for fault in range(len(document.items(*address, "faults"))):
            sites: Address = (*address, "faults", fault, "sites")
            for site in range(len(document.items(*sites))):
                yield from _unknown(document, (*sites, site), benchmark.sites, "fault site")
    yield from _unknown_parameters(document, benchmark)


def _unknown(document: Document, address: Address, known: Iterable[str], what: str) -> Iterator[Mistake]:
    name = document.get(*address)
    if isinstance(name, str) and name not in known:
        parts = [f"no {what} is called {name!r}.", did_you_mean(name, known), f"Known: {', '.join(known)}"]
        yield document.mistake(address, " ".join(filter(None, parts)))


def _unknown_parameters(document: Document, benchmark: Benchmark) -> Iterator[Mistake]:
    known = [entry.name for entry in benchmark.parameters]
    first: dict[str, str] = {}
    for block in ("grid", "sequence", "monte_carlo"):
        for name in document.mapping("dispersions", block):
            address: Address = ("dispersions", block, name)
            if (block, name) == ("monte_carlo", "runs"):
                continue
            if name in benchmark.refused_parameters:
                reason = benchmark.refused_parameters[name]
                yield document.mistake(address, f"{name} cannot be dispersed: {reason}", key=True)
            elif name not in known:
                hint = " ".join(filter(None, [did_you_mean(name, known), f"Known: {', '.join(known)}"]))
                yield document.mistake(
                    address, f"benchmark {benchmark.name!r} has no parameter {name!r}. {hint}", key=True
                )
            elif name in first:
                message = f"{name} is dispersed twice, first in {first[name]}; keep it in one block"
                yield document.mistake(address, message, key=True)
            first.setdefault(name, block)
