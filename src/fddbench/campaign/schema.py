"""JSON schema of a campaign file, so that an editor completes its keys."""

from typing import Any

from fddbench import registry
from fddbench.campaign.model import CampaignFile

__all__ = ["campaign_schema"]


def campaign_schema() -> dict[str, Any]:
    """JSON schema with the keys of every registered fault, in the units of every registered benchmark."""
    schema = CampaignFile.model_json_schema()
    units = sorted({registry.load("benchmark", name).fault_units.unit for name in registry.kinds("benchmark")})
    kinds = [registry.load("fault", name) for name in registry.kinds("fault")]
    faults = [kind.in_unit(unit).model_json_schema() for unit in units for kind in kinds]
    for fault in faults:
        schema["$defs"] |= fault.pop("$defs", {})
    schema["$defs"]["ScenarioEntry"]["properties"]["faults"]["items"] = {"anyOf": faults}
    return schema
