"""Faults of a campaign: their keys by kind, in the unit of the sites that they name."""

from collections.abc import Sequence
from typing import Any

from fddbench import kinds
from fddbench.campaign.in_words import said
from fddbench.campaign.rules.model import LONGEST_FLIGHT_S
from fddbench.campaign.schema.described import described, titled
from fddbench.campaign.schema.parts import FILE_KIND, Schema, embedded, one_of_names, reference, when
from fddbench.errors import FddbenchError
from fddbench.faults.specification import FaultSpecification
from fddbench.interfaces import Site
from fddbench.units import UNITS

__all__ = ["fault_entry", "fault_kind", "registered_faults"]

_ON_THE_FLIGHT = ("onset_s", "end_s", "delay_s")
_SIZES = ("amplitude", "rate", "variance", "hold_value", "quantum")
_SHORT = 120
"""Characters of a value that is not worth a definition."""
_REQUIRED = ["kind", "sites", "onset_s"]


def registered_faults() -> dict[str, Any]:
    """Registered kinds of faults that can be imported, by name."""
    found = {}
    for name in kinds.known("fault"):
        try:
            found[name] = kinds.load("fault", name)
        except FddbenchError:
            continue
    return found


def fault_kind(name: str, kind: type[FaultSpecification], unit: str, definitions: Schema) -> Schema:
    """Schema of a fault of a kind on sites of a unit; what it shares with others goes into the definitions."""
    model = kind.in_unit(unit)
    found = described(embedded(model.model_json_schema(), f"{name}_", definitions), model)
    properties = found["properties"]
    for key in properties:
        properties[key] = _shared(properties[key], definitions)
    for key in _ON_THE_FLIGHT:
        properties[key]["maximum"] = LONGEST_FLIGHT_S
    properties["sites"]["uniqueItems"] = True
    properties["kind"]["const"] = name
    rules = list(model.key_rules())
    found["properties"] = {key: _once(f"key_{key}", value, definitions) for key, value in properties.items()}
    return {**found, "allOf": [_once("held", rule, definitions) for rule in rules]} if rules else found


def _once(name: str, value: Schema, definitions: Schema) -> Schema:
    """Reference to a definition; the value itself where that name means something else."""
    return reference(name) if len(str(value)) > _SHORT and definitions.setdefault(name, value) == value else value


def _shared(value: Schema, definitions: Schema) -> Schema:
    """Value whose ways to vary are a definition, because most numbers have the same."""
    ways = [one for one in value.get("anyOf", ()) if "grid" in one.get("properties", {})]
    for way in ways:
        name = _name(way["properties"])
        definitions[name] = {
            "description": "How it differs from flight to flight: drawn for every run, or swept.",
            **way,
        }
        value["anyOf"] = [reference(name) if one is way else one for one in value["anyOf"]]
    return value


def _name(ways: Schema) -> str:
    """Name of the ways to vary a number, by its bounds."""
    number = ways["grid"]["items"]
    kind = "time" if "log_uniform" not in ways and number["type"] == "number" else number["type"]
    words = {"minimum": "from", "exclusiveMinimum": "above", "maximum": "to"}
    return "_".join(["varied", kind, *(f"{words[word]}_{number[word]:g}" for word in words if word in number)])


def fault_entry(sites: Sequence[Site], where: str, definitions: Schema) -> Schema:
    """Schema of a fault on these sites; `where` names the definitions of their kinds."""
    faults = registered_faults()
    units = list(dict.fromkeys(site.unit_name for site in sites if site.unit_name in UNITS))
    rules = [_of_kind(name, kind, sites, units, definitions) for name, kind in faults.items()]
    names = [site.name for site in sites]
    definitions[where] = {
        "type": "object",
        "required": _REQUIRED,
        "properties": {
            "kind": {
                **titled("kind", "what breaks; or a class in a file beside the campaign, mine.py:Mine"),
                **one_of_names(faults, {name: said(kind) for name, kind in faults.items()}, FILE_KIND),
            },
            "sites": {
                **titled("sites", "faulty sites"),
                "type": "array",
                "minItems": 1,
                "uniqueItems": True,
                "items": {"enum": names},
            },
        },
        "allOf": rules,
    }
    return reference(where)


def _of_kind(
    name: str, kind: type[FaultSpecification], sites: Sequence[Site], units: Sequence[str], definitions: Schema
) -> Schema:
    """What holds of a fault of a kind: the keys of the unit of its sites, and sites that it can act on."""
    rules = []
    for unit in units:
        made = f"{name}_{UNITS[unit].suffix.lstrip('_') or 'number'}"
        if made not in definitions:
            definitions[made] = fault_kind(name, kind, unit, definitions)
        rules.append(when(_all_of(sites, unit) if len(units) > 1 else None, reference(made)))
    if len(units) > 1:
        if f"{name}_percent" not in definitions:
            definitions[f"{name}_percent"] = _in_percent(name, kind, units[0], definitions)
        mixed = {"not": {"anyOf": [_all_of(sites, unit) for unit in units]}}
        rules.append(when(mixed, reference(f"{name}_percent")))
    fit = [site.name for site in sites if not _unfit(kind, site)]
    if len(fit) < len(sites):
        rules.append({"properties": {"sites": {"items": {"enum": fit}}}})
    condition = {"properties": {"kind": {"const": name}}, "required": ["kind"]}
    return when(condition, rules[0] if len(rules) == 1 else {"allOf": rules})


def _all_of(sites: Sequence[Site], unit: str) -> Schema:
    """All named sites have a unit, as far as they are known."""
    others = [site.name for site in sites if site.unit_name != unit]
    return {"properties": {"sites": {"items": {"not": {"enum": others}}}}}


def _in_percent(name: str, kind: type[FaultSpecification], unit: str, definitions: Schema) -> Schema:
    """Schema of a fault on sites of several units: sizes in percent only."""
    found = fault_kind(name, kind, unit, definitions)
    model = kind.in_unit(unit)
    for field in model.model_fields.keys() & {*_SIZES, *model.files}:
        found["properties"][model.key(field)] = {"type": "null"}
    return found


def _unfit(kind: type[FaultSpecification], site: Site) -> str:
    """Why a kind cannot act on a site; "" where that depends on more than the kind."""
    entry: Any = kind.model_construct
    try:
        return str(entry().unfit_on(site))
    except Exception:  # a kind of somebody else's may raise anything; what it refuses, loading tells
        return ""
