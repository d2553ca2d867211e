"""Faults of a campaign file, each checked by the class that is registered for its kind or stands in a file beside it."""

import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, get_args

from pydantic import ValidationError

from fddbench import kinds
from fddbench.campaign.reading.document import Address, Document
from fddbench.campaign.rules.messages import mistakes_of
from fddbench.errors import FddbenchError, Mistake, reason_of
from fddbench.faults.specification import FaultSpecification
from fddbench.interfaces import Site

__all__ = ["ReadFaults", "read_faults"]

_WORD = re.compile(r"([A-Z])")
_SIZES = ("amplitude", "rate", "variance", "hold_value", "quantum")
_LARGEST = 200_000_000
"""Bytes of a file beside the campaign that is carried along."""


@dataclass
class ReadFaults:
    """Faults by the position of their scenario, the files their kinds came from, and what is wrong."""

    lists: dict[int, tuple[FaultSpecification, ...]] = field(default_factory=dict)
    files: dict[str, bytes] = field(default_factory=dict)
    mistakes: list[Mistake] = field(default_factory=list)


def read_faults(document: Document, sites: Sequence[Site], folder: Path) -> ReadFaults:
    """Faults of every scenario, and what is wrong with them; entries that are no mappings are left to the schema.

    The sites that a fault names say in which unit its sizes are written; when none is known, the unit of the first site of
    the benchmark, or deg/s.
    """
    found = ReadFaults()
    for scenario in range(len(document.items("scenarios"))):
        faults = []
        for number, entry in enumerate(document.items("scenarios", scenario, "faults")):
            if isinstance(entry, dict):
                fault = _read_fault(document, ("scenarios", scenario, "faults", number), entry, sites, folder, found)
                faults += [fault] if fault is not None else []
        found.lists[scenario] = tuple(faults)
    return found


def _read_fault(
    document: Document, address: Address, entry: dict[str, Any], sites: Sequence[Site], folder: Path, found: ReadFaults
) -> FaultSpecification | None:
    kind = entry.get("kind")
    if not isinstance(kind, str):
        known = ", ".join(kinds.known("fault"))
        found.mistakes.append(document.mistake((*address, "kind"), f"every fault needs a kind: one of {known}"))
        return None
    units = _units(entry, sites)
    try:
        member = kinds.find("fault", kind, beside=folder)
        model = member.member.in_unit(units[0])
    except FddbenchError as error:
        found.mistakes.append(document.mistake((*address, "kind"), str(error)))
        return None
    found.files |= member.files
    try:
        # a kind in a file is called as the file calls it; its model knows it by its own name
        fault: FaultSpecification = model.model_validate_json(json.dumps({**entry, **_own_kind(model)}), strict=True)
    except ValidationError as error:
        found.mistakes += mistakes_of(error, document, model=model, at=address)
        return None
    except (Exception, SystemExit) as error:  # a kind of somebody else's may raise anything
        found.mistakes.append(document.mistake(address, f"the fault {kind!r} cannot be read: {reason_of(error)}"))
        return None
    wrong, fault = _with_files(document, address, fault, folder, found)
    if wrong:
        found.mistakes += wrong
        return None
    if len(units) > 1 and (fault.files or any(getattr(fault, size, None) is not None for size in _SIZES)):
        message = (
            f"the sites {', '.join(fault.sites)} have different units ({', '.join(units)}): give sizes in percent, or a "
            "fault for each unit"
        )
        found.mistakes.append(document.mistake((*address, "sites"), message))
    found.mistakes += _unfit_sites(document, address, fault, sites)
    return fault


def _with_files(
    document: Document, address: Address, fault: FaultSpecification, folder: Path, found: ReadFaults
) -> tuple[list[Mistake], FaultSpecification]:
    """What is wrong with the files that a fault names, and the fault that has read them; they travel with the campaign."""
    contents: dict[str, bytes] = {}
    for key in fault.files:
        name = str(getattr(fault, key))
        path = folder / name
        inside = path.is_file() and path.resolve().is_relative_to(folder.resolve())
        if not inside or path.stat().st_size > _LARGEST:
            wrong = f"larger than {_LARGEST / 1e6:g} MB; it cannot travel with the results" if inside else ""
            message = f"{path} is {wrong}" if wrong else f"no file {name} in {folder}; put it beside the campaign"
            return [document.mistake((*address, key), message)], fault
        contents[key] = path.read_bytes()
        found.files[name] = contents[key]
    try:
        return [], fault.with_files(contents) if contents else fault
    except FddbenchError as error:
        return [document.mistake((*address, fault.files[0]), str(error))], fault
    except (Exception, SystemExit) as error:  # a kind of somebody else's may raise anything
        message = f"the files of the fault {fault.kind!r} cannot be read: {reason_of(error)}"
        return [document.mistake((*address, fault.files[0]), message)], fault


def _unfit_sites(
    document: Document, address: Address, fault: FaultSpecification, sites: Sequence[Site]
) -> Iterator[Mistake]:
    """Sites that a fault names and cannot act on, each with those that it can."""
    fit = [site.name for site in sites if not fault.unfit_on(site)]
    named = {site.name: site for site in sites}
    for position, name in enumerate(fault.sites):
        reason = fault.unfit_on(named[name]) if name in named else ""
        if reason:
            message = (
                f"{fault.kind} cannot act on {name}: {reason}. Sites where it can: {', '.join(fit) or 'none here'}"
            )
            yield document.mistake((*address, "sites", position), message)


def _own_kind(model: type[FaultSpecification]) -> dict[str, str]:
    """The name by which a model knows itself, for kinds whose file has another: its only choice, else that of its class."""
    own = get_args(model.model_fields["kind"].annotation)
    return {"kind": str(own[0]) if own else _WORD.sub(r"_\1", model.__name__).lower().lstrip("_")}


def _units(entry: dict[str, Any], sites: Sequence[Site]) -> list[str]:
    """Units of the sites that a fault names, at least one."""
    named = entry.get("sites")
    names = named if isinstance(named, list) else []
    units = [site.unit_name for site in sites if site.name in names] or [site.unit_name for site in sites[:1]]
    return list(dict.fromkeys(units)) or ["deg/s"]
