"""JSON schema of a campaign file, so that an editor completes its keys."""

from collections.abc import Iterator
from typing import Any

from fddbench import kinds
from fddbench.campaign.rules.model import CampaignFile, campaign_file
from fddbench.errors import FddbenchError
from fddbench.interfaces import Benchmark, Plant
from fddbench.interfaces.benchmark import default_choices
from fddbench.units import UNITS

__all__ = ["campaign_schema"]


def campaign_schema() -> dict[str, Any]:
    """JSON schema with the choices of every registered benchmark and the keys of every registered fault.

    Sizes are in the units of the benchmarks' sites. A package that cannot be imported is left out.
    """
    keys: dict[str, None] = {}
    units: set[str] = set()
    for name in kinds.known("benchmark"):
        try:
            benchmark = kinds.load("benchmark", name)()
            found = {site.unit_name for plant in _plants(benchmark) for site in plant.sites}
        except Exception:  # a package of somebody else's may raise anything
            continue
        keys |= dict.fromkeys(key for key in benchmark.choices if key not in CampaignFile.model_fields)
        units |= found & UNITS.keys()
    schema = campaign_file(tuple(keys)).model_json_schema()
    faults = [kind.in_unit(unit).model_json_schema() for unit in sorted(units) for kind in _faults()]
    for fault in faults:
        schema["$defs"] |= fault.pop("$defs", {})
    schema["$defs"]["ScenarioEntry"]["properties"]["faults"]["items"] = {"anyOf": faults}
    return schema


def _plants(benchmark: Benchmark) -> Iterator[Plant]:
    """What flies with the defaults, and with every other option by itself: sites may differ."""
    usual = default_choices(benchmark)
    yield benchmark.plant(usual)
    for key, choice in benchmark.choices.items():
        for name in list(choice.options)[1:]:
            yield benchmark.plant({**usual, key: choice.options[name]})


def _faults() -> list[Any]:
    """Registered kinds of faults that can be imported."""
    found = []
    for name in kinds.known("fault"):
        try:
            found.append(kinds.load("fault", name))
        except FddbenchError:
            continue
    return found
