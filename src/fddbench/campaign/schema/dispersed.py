"""Parameters that a campaign disperses: their ranges, one block for each, and why some are refused."""

from collections.abc import Mapping
from itertools import combinations

from fddbench.campaign.in_words import parameter_in_words
from fddbench.campaign.rules.dispersions import MonteCarlo
from fddbench.campaign.schema.described import titled
from fddbench.campaign.schema.parts import Schema, reference, when
from fddbench.interfaces import Parameter

__all__ = ["dispersions"]

_BLOCKS = ("grid", "sequence", "monte_carlo")


def dispersions(
    parameters: Mapping[str, Parameter], refused: Mapping[str, str], where: str, definitions: Schema
) -> Schema:
    """Schema of the dispersions with these parameters; `where` is part of the names of its definitions."""
    ends = {name: {"minimum": one.low, "maximum": one.high} for name, one in parameters.items()}
    for name, one in parameters.items():
        said = titled(name, parameter_in_words(one))
        definitions[f"values_{name}_{where}"] = {**said, "type": "array", "items": {"type": "number", **ends[name]}}
        definitions[f"draw_{name}_{where}"] = {**said, **_draw(ends[name])}
    never = {name: {"not": {}, "description": reason, "doNotSuggest": True} for name, reason in refused.items()}
    values = {name: reference(f"values_{name}_{where}") for name in parameters} | never
    drawn = {name: reference(f"draw_{name}_{where}") for name in parameters} | never
    names: Schema = {"enum": list(parameters)}
    apart = {"exclusiveMinimum": -1, "exclusiveMaximum": 1}
    own: Schema = dict.fromkeys(MonteCarlo.model_fields, True)
    own["correlation"] = {"items": {"prefixItems": [names, names, apart]}}
    once = {name: {"uniqueItems": True} for name in parameters}
    return {
        "properties": {
            "grid": {"properties": values, "additionalProperties": False, "allOf": [{"properties": once}]},
            "sequence": {"properties": values, "additionalProperties": False},
            "monte_carlo": {"properties": own | drawn, "additionalProperties": False},
        },
        "allOf": [_once(name, first, second) for name in parameters for first, second in combinations(_BLOCKS, 2)],
    }


def _draw(ends: Schema) -> Schema:
    """Distribution within the range of a parameter."""
    return {
        "properties": {
            "uniform": {"items": ends},
            "normal": {"properties": {"mean": ends}},
            "truncated_normal": {"properties": {"low": ends, "high": ends}},
        }
    }


def _once(name: str, first: str, second: str) -> Schema:
    """A parameter that stands in one block is not in another."""
    there = {"properties": {first: {"type": "object", "required": [name]}}, "required": [first]}
    return when(there, {"properties": {second: {"properties": {name: False}}}})
