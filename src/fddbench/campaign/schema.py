"""JSON schema of a campaign file, so that an editor completes its keys."""

from typing import Any

from fddbench import registry
from fddbench.campaign.model import CampaignFile

__all__ = ["campaign_schema"]


def campaign_schema() -> dict[str, Any]:
    """JSON schema with the keys of every registered fault."""
    schema = CampaignFile.model_json_schema()
    faults = [registry.load("fault", name).model_json_schema() for name in registry.kinds("fault")]
    for fault in faults:
        schema["$defs"] |= fault.pop("$defs", {})
    schema["$defs"]["ScenarioEntry"]["properties"]["faults"]["items"] = {"anyOf": faults}
    return schema
