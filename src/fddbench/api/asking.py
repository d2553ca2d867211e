"""What there is to choose: benchmarks with all their names, faults, detectors, campaigns."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from textwrap import wrap
from typing import Any

from fddbench import gallery, kinds
from fddbench.api.manoeuvre_sketches import sketches
from fddbench.campaign.in_words import options_in_words, parameter_in_words, said, site_in_words
from fddbench.designs.design import read_design
from fddbench.errors import FddbenchError, did_you_mean
from fddbench.interfaces import Benchmark, Loop, Options, Plant
from fddbench.interfaces.benchmark import default_choices

__all__ = ["SUBJECTS", "ask", "fitting_designs"]

_WIDTH = 80
SUBJECTS = ("benchmarks", "faults", "voters", "detectors", "schedulings", "recipes", "campaigns", "designs")
"""What `ask` lists beside a benchmark by its name."""


def ask(subject: str = "") -> str:
    """Text of everything that campaigns can name, of one family of it, or of one benchmark with all its names.

    Parameters
    ----------
    subject : str
        "", one of `SUBJECTS`, or the name of a benchmark.

    Raises
    ------
    FddbenchError
        There is no such thing; the message lists what there is.
    """
    if not subject:
        families = [family for family in kinds.FAMILIES if kinds.known(family)]
        parts = [_family(family) for family in families] + [_shipped(name) for name in ("campaigns", "detectors")]
        return "\n".join(parts) + "\nfddbench list BENCHMARK shows all its names"
    if subject == "campaigns":
        return _shipped("campaigns")
    if subject == "designs":
        return _shipped("detectors")
    if subject == "detectors":
        return f"{_family('detector')}\n{_shipped('detectors')}"
    if subject.removesuffix("s") in kinds.FAMILIES and subject in SUBJECTS:
        return _family(subject.removesuffix("s"))
    if subject in kinds.known("benchmark"):
        return _benchmark(kinds.load("benchmark", subject)())
    known = [*kinds.known("benchmark"), *SUBJECTS]
    hint = did_you_mean(subject, known)
    raise FddbenchError(" ".join(filter(None, [f"nothing is called {subject!r}.", hint, f"Known: {', '.join(known)}"])))


def _family(family: str) -> str:
    return "\n".join([f"{family}s", *_aligned({name: _about(family, name) for name in kinds.known(family)})])


def _shipped(folder: str) -> str:
    """Shipped files with their first lines."""
    paths = sorted(gallery.folder(folder).glob("*.yaml"))
    first = {path.stem: _first_comment(path) for path in paths}
    return "\n".join(["shipped campaigns" if folder == "campaigns" else "shipped designs", *_aligned(first)])


def _first_comment(path: Path) -> str:
    """First comment of a file that is none for an editor."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return next((line.lstrip("# ") for line in lines if not line.startswith("# yaml-language-server")), "")


def _about(family: str, name: str) -> str:
    """What a registered member says of itself; of one that cannot be imported, why."""
    try:
        kind = kinds.load(family, name)
    except FddbenchError as error:
        return f"(broken) {error}"
    return said(kind)


def _aligned(about: Mapping[str, str]) -> Iterator[str]:
    """Names in a column as wide as the longest, and what they are beside them."""
    width = max(map(len, about), default=0) + 2
    for name, text in about.items():
        yield f"  {name:<{width}}{text}".rstrip()


def _benchmark(bench: Benchmark) -> str:
    """All names of a benchmark, those of each of its plants."""
    chosen = default_choices(bench)
    plants = dict(bench.choices["plant"].options) if "plant" in bench.choices else {}
    lines = [f"{bench.name}: {bench.about}", ""]
    for key, choice in bench.choices.items():
        more = "; or a file of your own, mine.py:Mine" if choice.family else ""
        lines += [f"{key}: {choice.about} (the first is the default{more})"]
        lines += _aligned(options_in_words(choice))
    alike: dict[str, list[str]] = {}  # plants by what they have, for those that have the same stand together
    for name, member in (plants or {"": None}).items():
        own = {**chosen, "plant": member} if name else chosen
        besides = list(_more_sites(bench, own))
        text = "\n".join(_plant(bench, bench.plant(own), bench.loop(Options(chosen=own)), name, besides))
        alike.setdefault(text, []).append(name)
    for text, names in alike.items():
        lines += ["", *([f"with plant: {', '.join(names)}"] if names[0] else []), text]
    return "\n".join(lines)


def _more_sites(bench: Benchmark, chosen: Mapping[str, Any]) -> Iterator[str]:
    """Lines of the fault sites that other options than the defaults bring."""
    there = {site.name for site in bench.plant(chosen).sites}
    for key, choice in bench.choices.items():
        for name in choice.options if key != "plant" else ():
            sites = bench.plant({**chosen, key: choice.options[name]}).sites
            more = [site.name for site in sites if site.name not in there]
            if more:
                yield f"  with {key}: {name} besides {', '.join(more)}"


def _plant(bench: Benchmark, plant: Plant, loop: Loop, name: str, besides: list[str]) -> Iterator[str]:
    """Sites, manoeuvres, parameters and signals of a plant, and the designs that fit it."""
    yield f"fault sites (limits are {bench.limits_from})"
    yield from _aligned({site.name: site_in_words(site) for site in plant.sites})
    yield from besides
    yield "manoeuvres, with the length of a healthy flight"
    drawn, fitting = sketches(bench, plant, name), list(fitting_designs(loop))
    width = max(map(len, plant.manoeuvres)) + 2
    for manoeuvre, length_s in plant.manoeuvres.items():
        yield f"  {manoeuvre:<{width}}{length_s:>6g} s  {drawn.get(manoeuvre, '')}".rstrip()
    yield "parameters: default, range, meaning"
    yield from _aligned({each.name: parameter_in_words(each) for each in plant.parameters})
    if plant.refused_parameters:
        yield "refused"
        yield from _aligned(plant.refused_parameters)
    yield "measured signals, what detectors see (rows)"
    rows = [f"{name} ({n})" if n > 1 else name for name, n in loop.bus.signals.items()]
    yield from _wrapped(", ".join(rows))
    yield "true signals, what replays show besides"
    yield from _wrapped(", ".join(loop.truth))
    yield "shipped designs that fit"
    yield from _wrapped(", ".join(fitting) or "none")


def _wrapped(text: str) -> list[str]:
    return wrap(text, _WIDTH, initial_indent="  ", subsequent_indent="  ", break_on_hyphens=False)


def fitting_designs(loop: Loop) -> Iterator[str]:
    """Names of the shipped designs that make a detector for the signals of a loop."""
    for path in sorted(gallery.folder("detectors").glob("*.yaml")):
        try:
            read_design(path).build(loop.bus)
        except FddbenchError:
            continue
        yield path.stem
