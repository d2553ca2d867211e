"""Names in a campaign that must exist in its benchmark: choices, manoeuvres, sites, parameters."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fddbench import kinds
from fddbench.campaign.reading.document import Address, Document
from fddbench.campaign.rules.dispersions import MonteCarlo
from fddbench.errors import FddbenchError, Mistake, did_you_mean
from fddbench.interfaces import Benchmark, Choice, Plant

__all__ = ["Chosen", "choose", "default_of", "unknown_names"]

_DATA = (".yaml", ".yml")


@dataclass(frozen=True, kw_only=True)
class Chosen:
    """What a campaign has chosen on its benchmark.

    Attributes
    ----------
    names : mapping of str to str
        Name of what was chosen, by the key of the choice.
    members : mapping of str to object
        What was chosen.
    files : mapping of str to bytes
        Files beside the campaign that it came from.
    """

    names: Mapping[str, str]
    members: Mapping[str, Any]
    files: Mapping[str, bytes] = field(default_factory=dict)


def default_of(choice: Choice) -> str:
    """What a campaign flies that does not say."""
    return next(iter(choice.options))


def choose(document: Document, benchmark: Benchmark, folder: Path) -> tuple[Chosen | None, list[Mistake]]:
    """What a campaign chooses on a benchmark, None with the mistakes when something is not to be had."""
    names: dict[str, str] = {}
    members: dict[str, Any] = {}
    files: dict[str, bytes] = {}
    mistakes: list[Mistake] = []
    for key, choice in benchmark.choices.items():
        given = document.get(key)
        names[key] = default_of(choice) if given is None else given
        if not isinstance(names[key], str):
            return None, mistakes  # the schema tells it
        try:
            members[key], found = _member(key, choice, names[key], benchmark, folder)
            files |= found
        except FddbenchError as error:
            mistakes.append(document.mistake((key,), str(error)))
    return (None if mistakes else Chosen(names=names, members=members, files=files)), mistakes


def _member(key: str, choice: Choice, name: str, benchmark: Benchmark, folder: Path) -> tuple[Any, Mapping[str, bytes]]:
    """What an option is, and the files it came from."""
    if name in choice.options:
        return choice.options[name], {}
    if choice.reads is not None and name.endswith(_DATA):
        return _of_data(choice.reads, name, folder)
    own = kinds.known(choice.family) if choice.family else ()
    if name not in own and not (choice.family and kinds.is_file_kind(name)):
        raise FddbenchError(
            _no_such(f"{key} of benchmark {benchmark.name!r}", name, dict.fromkeys((*choice.options, *own)))
        )
    kind = kinds.find(choice.family, name, beside=folder)
    missing = [part for part in choice.needs if part not in dir(kind.member)]
    if missing:
        raise FddbenchError(
            f"{name!r} cannot be the {key} of benchmark {benchmark.name!r}: it has no {' and no '.join(missing)}"
        )
    return kind.member, kind.files


def _of_data(reads: Callable[[Path], Any], name: str, folder: Path) -> tuple[Any, Mapping[str, bytes]]:
    """What a file of data beside the campaign says, and the file."""
    path = folder / name
    if not path.is_file() or not path.resolve().is_relative_to(folder.resolve()):
        raise FddbenchError(f"no file {name} in {folder}; a file of data lies beside the campaign that names it")
    member, beside = reads(path), Path(name).parent
    return member, {name: path.read_bytes()} | {
        str(beside / own): content for own, content in getattr(member, "files", {}).items()
    }


def unknown_names(
    document: Document, benchmark: Benchmark, plant: Plant, chosen: Mapping[str, Any]
) -> Iterator[Mistake]:
    """Every name that the benchmark does not know; reads the raw data, so that other mistakes do not hide these.

    `chosen` are the members by the keys of the choices: a site that another option would bring is named with it.
    """
    sites = [site.name for site in plant.sites]
    for scenario in range(len(document.items("scenarios"))):
        address: Address = ("scenarios", scenario)
        yield from _unknown(document, (*address, "manoeuvre"), plant.manoeuvres, "manoeuvre")
        for fault in range(len(document.items(*address, "faults"))):
            named: Address = (*address, "faults", fault, "sites")
            for site in range(len(document.items(*named))):
                yield from _unknown(
                    document, (*named, site), sites, "fault site", lambda name: _elsewhere(name, benchmark, chosen)
                )
    yield from _unknown_parameters(document, benchmark, plant)


def _no_such(what: str, name: str, known: Iterable[str]) -> str:
    names = list(known)
    return " ".join(
        filter(None, [f"no {what} is called {name!r}.", did_you_mean(name, names), f"Known: {', '.join(names)}"])
    )


def _unknown(
    document: Document,
    address: Address,
    known: Iterable[str],
    what: str,
    elsewhere: Callable[[str], str] | None = None,
) -> Iterator[Mistake]:
    name, names = document.get(*address), list(known)
    if isinstance(name, str) and name not in names:
        message = ". ".join(filter(None, [_no_such(what, name, names), elsewhere(name) if elsewhere else ""]))
        yield document.mistake(address, message)


def _elsewhere(site: str, benchmark: Benchmark, chosen: Mapping[str, Any]) -> str:
    """With which other option there is such a fault site; "" for none."""
    for key, choice in benchmark.choices.items():
        for name in choice.options:
            try:
                sites = benchmark.plant({**chosen, key: choice.options[name]}).sites
            except Exception:  # a benchmark of somebody else's may raise anything; this is only a hint
                continue
            if any(one.name == site for one in sites):
                return f"There is one with `{key}: {name}`"
    return ""


def _unknown_parameters(document: Document, benchmark: Benchmark, plant: Plant) -> Iterator[Mistake]:
    known = [entry.name for entry in plant.parameters]
    first: dict[str, str] = {}
    for block in ("grid", "sequence", "monte_carlo"):
        for name in document.mapping("dispersions", block):
            address: Address = ("dispersions", block, name)
            if block == "monte_carlo" and name in MonteCarlo.model_fields:
                continue
            if name in plant.refused_parameters:
                reason = plant.refused_parameters[name]
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
