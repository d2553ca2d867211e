"""JSON schema of a campaign on any benchmark, so that an editor completes its keys."""

from collections.abc import Iterator
from typing import Any

from fddbench import kinds
from fddbench.campaign.rules.model import CampaignFile
from fddbench.campaign.schema.fault_entries import fault_kind, registered_faults
from fddbench.campaign.schema.on_benchmark import HEALTHY_WITHOUT_LIMIT, written_schema
from fddbench.campaign.schema.parts import DIALECT, FILE_KIND, when
from fddbench.interfaces import Benchmark, Plant
from fddbench.interfaces.benchmark import default_choices
from fddbench.units import UNITS

__all__ = ["campaign_schema"]


def campaign_schema() -> dict[str, Any]:
    """JSON schema with the choices of every registered benchmark and the keys of every registered fault.

    Sizes are in the units of the benchmarks' sites. A package that cannot be imported is left out. That of one benchmark
    knows its names too, see `fddbench.campaign.schema.on_benchmark`.
    """
    keys: dict[str, None] = {}
    units: set[str] = set()
    without: list[str] = []
    for name in kinds.known("benchmark"):
        try:
            benchmark = kinds.load("benchmark", name)()
            plants = list(_plants(benchmark))
            found = {site.unit_name for plant in plants for site in plant.sites}
        except Exception:  # a package of somebody else's may raise anything
            continue
        keys |= dict.fromkeys(key for key in benchmark.choices if key not in CampaignFile.model_fields)
        units |= found & UNITS.keys()
        without += [] if any(hasattr(plant, "labelled") for plant in plants) else [name]
    schema = written_schema(tuple(keys))
    faults = [
        fault_kind(name, kind, unit, schema["$defs"])
        for unit in sorted(units)
        for name, kind in registered_faults().items()
    ]
    faults.append({"properties": {"kind": {"type": "string", "pattern": FILE_KIND}}, "required": ["kind"]})
    schema["$defs"]["ScenarioEntry"]["properties"]["faults"]["items"] = {"anyOf": faults}
    on_them = {"properties": {"benchmark": {"enum": without}}, "required": ["benchmark"]}
    schema["allOf"].append(when(on_them, {"properties": {"scenarios": {"items": HEALTHY_WITHOUT_LIMIT}}}))
    return {"$schema": DIALECT, "$id": "urn:fddbench:campaign", "title": "fddbench campaign", **schema}


def _plants(benchmark: Benchmark) -> Iterator[Plant]:
    """What flies with the defaults, and with every other option by itself: sites may differ."""
    usual = default_choices(benchmark)
    yield benchmark.plant(usual)
    for key, choice in benchmark.choices.items():
        for name in list(choice.options)[1:]:
            yield benchmark.plant({**usual, key: choice.options[name]})
