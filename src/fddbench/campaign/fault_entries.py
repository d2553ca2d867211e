"""Faults of a campaign file, each checked by the class that is registered for its kind."""

import json
from typing import Any

from pydantic import ValidationError

from fddbench import registry
from fddbench.campaign.document import Address, Document
from fddbench.campaign.messages import mistakes_of
from fddbench.errors import FddbenchError, Mistake, UnknownNameError
from fddbench.faults.specification import FaultSpecification
from fddbench.interfaces import Benchmark

__all__ = ["Faults", "load_kind", "read_faults"]

Faults = dict[int, tuple[FaultSpecification, ...]]
"""Faults by the position of their scenario in the file."""


def read_faults(document: Document, benchmark: Benchmark | None) -> tuple[Faults, list[Mistake]]:
    """Faults of every scenario, and what is wrong with them; entries that are no mappings are left to the schema.

    The benchmark says in which unit sizes are written; when it is not known, deg/s.
    """
    unit = benchmark.fault_units.unit if benchmark else "deg/s"
    found: Faults = {}
    mistakes: list[Mistake] = []
    for scenario in range(len(document.items("scenarios"))):
        faults = []
        for number, entry in enumerate(document.items("scenarios", scenario, "faults")):
            if isinstance(entry, dict):
                fault = _read_fault(document, ("scenarios", scenario, "faults", number), entry, unit)
                faults += [fault] if isinstance(fault, FaultSpecification) else []
                mistakes += fault if isinstance(fault, list) else []
        found[scenario] = tuple(faults)
    return found, mistakes


def _read_fault(
    document: Document, address: Address, entry: dict[str, Any], unit: str
) -> FaultSpecification | list[Mistake]:
    kind = entry.get("kind")
    if not isinstance(kind, str):
        known = ", ".join(registry.kinds("fault"))
        return [document.mistake((*address, "kind"), f"every fault needs a kind: one of {known}")]
    try:
        model = load_kind("fault", kind).in_unit(unit)
    except FddbenchError as error:
        return [document.mistake((*address, "kind"), str(error))]
    try:
        fault: FaultSpecification = model.model_validate_json(json.dumps(entry), strict=True)
    except ValidationError as error:
        return mistakes_of(error, document, model=model, at=address)
    return fault


def load_kind(family: str, name: str) -> Any:
    """Class of a registered kind.

    Raises
    ------
    FddbenchError
        Nobody registered it, or its package is broken; the message has one line.
    """
    try:
        return registry.load(family, name)
    except UnknownNameError as error:
        raise FddbenchError(str(error).replace("\n", " ")) from None
    except (ImportError, AttributeError) as error:
        point = registry.kinds(family)[name]
        raise FddbenchError(
            f"the {family} {name!r} is registered as {point.value} and cannot be imported: {error}"
        ) from error
