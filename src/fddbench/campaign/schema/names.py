"""What a campaign can name on a benchmark, by what it chooses there."""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from fddbench.campaign.in_words import parameter_in_words, site_in_words
from fddbench.campaign.rules.references import default_of
from fddbench.campaign.schema.described import titled
from fddbench.campaign.schema.dispersed import dispersions
from fddbench.campaign.schema.fault_entries import fault_entry
from fddbench.campaign.schema.parts import Schema, reference, when
from fddbench.interfaces import Benchmark, Parameter, Plant, Site
from fddbench.interfaces.benchmark import default_choices

__all__ = ["name_rules"]


@dataclass(frozen=True, kw_only=True)
class Named:
    """What there is to name with some plants.

    Attributes
    ----------
    sites : mapping of str to (Site, tuple of (key, option))
        By name the site, and the options that bring it; none: it is always there.
    manoeuvres, parameters, refused : mappings
        Of the plants, with the defaults and with every other option by itself.
    """

    sites: Mapping[str, tuple[Site, tuple[tuple[str, str], ...]]]
    manoeuvres: Mapping[str, float]
    parameters: Mapping[str, Parameter]
    refused: Mapping[str, str]

    @property
    def told(self) -> str:
        """Text that is the same for plants on which the same can be named."""
        sites = {name: (site_in_words(site), bringers) for name, (site, bringers) in self.sites.items()}
        parameters = {name: parameter_in_words(one) for name, one in self.parameters.items()}
        return json.dumps([sites, dict(self.manoeuvres), parameters, dict(self.refused)])


def name_rules(benchmark: Benchmark, definitions: Schema) -> Iterator[Schema]:
    """What holds of manoeuvres, faults and dispersions for what a campaign chooses; nothing for a plant of one's own."""
    alike: dict[str, tuple[Named, list[str]]] = {}
    plants = benchmark.choices["plant"].options if "plant" in benchmark.choices else {"": None}
    for name in plants:
        named = _named(benchmark, name)
        alike.setdefault(named.told, (named, []))[1].append(name)
    for named, names in alike.values():
        where = names[0] or benchmark.name
        condition = _chosen(benchmark, {"plant": names} if names[0] else {})
        yield when(condition, _then(named, where, definitions))
        groups: dict[tuple[tuple[str, str], ...], list[str]] = {}
        for site, (_, bringers) in named.sites.items():
            groups.setdefault(bringers, []).append(site)
        for bringers, sites in groups.items():
            if bringers:
                without = [{"not": _chosen(benchmark, {key: [option]})} for key, option in bringers]
                yield when({"allOf": [condition or {}, *without]}, _in_faults({"not": {"enum": sites}}))


def _named(benchmark: Benchmark, plant: str) -> Named:
    """What can be named with a plant, and with every other option besides."""
    usual = default_choices(benchmark)
    if plant:
        usual["plant"] = benchmark.choices["plant"].options[plant]
    base = benchmark.plant(usual)
    sites: dict[str, tuple[Site, tuple[tuple[str, str], ...]]] = {site.name: (site, ()) for site in base.sites}
    manoeuvres, parameters, refused = dict(base.manoeuvres), _parameters(base), dict(base.refused_parameters)
    for key, choice in benchmark.choices.items():
        for name in choice.options if key != "plant" else ():
            other = benchmark.plant({**usual, key: choice.options[name]})
            manoeuvres |= other.manoeuvres
            parameters |= _parameters(other)
            for site in other.sites:
                if site.name not in {one.name for one in base.sites}:
                    sites[site.name] = (site, (*sites.get(site.name, (site, ()))[1], (key, name)))
    refused = {name: reason for name, reason in refused.items() if name not in parameters}
    return Named(sites=sites, manoeuvres=manoeuvres, parameters=parameters, refused=refused)


def _parameters(plant: Plant) -> dict[str, Parameter]:
    return {one.name: one for one in plant.parameters}


def _chosen(benchmark: Benchmark, wanted: Mapping[str, Sequence[str]]) -> Schema | None:
    """Condition that a campaign chooses so, and of the rest nothing of its own; None where that is always so."""
    properties: Schema = {}
    required = []
    for key, choice in benchmark.choices.items():
        names = list(wanted.get(key, choice.options))
        if len(names) == len(choice.options) and not (choice.family or choice.reads):
            continue
        usual = default_of(choice) in names
        properties[key] = {"enum": [*names, None] if usual else names}
        required += [] if usual else [key]
    return {"properties": properties, **({"required": required} if required else {})} if properties else None


def _then(named: Named, where: str, definitions: Schema) -> Schema:
    """Names of manoeuvres, sites and parameters."""
    faults = fault_entry([site for site, _ in named.sites.values()], f"fault_on_{where}", definitions)
    lengths = ", ".join(f"{name} {length_s:g} s" for name, length_s in named.manoeuvres.items())
    sites = "; ".join(f"{name}: {site_in_words(site)}" for name, (site, _) in named.sites.items())
    definitions[f"fault_on_{where}"]["properties"]["sites"] |= titled("sites", sites)
    definitions[f"dispersions_on_{where}"] = dispersions(named.parameters, named.refused, where, definitions)
    manoeuvre = {
        **titled("manoeuvre", f"what is flown; a healthy flight lasts {lengths}"),
        "enum": list(named.manoeuvres),
    }
    scenario: Schema = {"properties": {"manoeuvre": manoeuvre, "faults": {"items": faults}}}
    found: Schema = {
        "properties": {"scenarios": {"items": scenario}, "dispersions": reference(f"dispersions_on_{where}")}
    }
    limitless = [name for name, (site, _) in named.sites.items() if not site.limits_s]
    return {**found, "allOf": [_with_limit(limitless)]} if limitless else found


def _with_limit(limitless: Sequence[str]) -> Schema:
    """A scenario states the limit itself where none of its sites does and no flight has a length."""
    on = {"items": {"properties": {"sites": {"items": {"enum": list(limitless)}}}}, "minItems": 1}
    alone = {"properties": {"faults": on}, "required": ["faults"], "not": {"required": ["duration_s"]}}
    stated = when(alone, {"required": ["detection_time_limit_s"]})
    return when({"not": {"required": ["duration_s"]}}, {"properties": {"scenarios": {"items": stated}}})


def _in_faults(site: Schema) -> Schema:
    """What holds of every site that a fault names."""
    fault: Any = {"properties": {"sites": {"items": site}}}
    return {"properties": {"scenarios": {"items": {"properties": {"faults": {"items": fault}}}}}}
