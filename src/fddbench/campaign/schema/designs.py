"""JSON schema of a design file: the gains of every registered kind of detector."""

from typing import Any

from fddbench import kinds
from fddbench.campaign.schema.described import described
from fddbench.campaign.schema.parts import DIALECT, FILE_KIND, Schema, embedded, one_of_names, when
from fddbench.designs.design_file import DesignFile, TunedOn
from fddbench.errors import FddbenchError

__all__ = ["design_schema"]


def design_schema() -> dict[str, Any]:
    """JSON schema (2020-12) of a design; gains of a kind in a file of one's own may be any."""
    schema = described(DesignFile.model_json_schema(), DesignFile)
    definitions: Schema = schema["$defs"]
    described(definitions["TunedOn"], TunedOn)
    rules, about = [], {}
    for name in kinds.known("detector"):
        try:
            kind = kinds.load("detector", name)
        except FddbenchError:
            continue
        about[name] = str(getattr(kind, "about", ""))
        gains = described(embedded(kind.Gains.model_json_schema(), f"{name}_", definitions), kind.Gains)
        condition = {"properties": {"kind": {"const": name}}, "required": ["kind"]}
        rules.append(when(condition, {"properties": {"gains": gains}}))
    schema["properties"]["kind"] |= one_of_names(about, about, FILE_KIND)
    head = {"$schema": DIALECT, "$id": "urn:fddbench:design", "title": "fddbench design"}
    return {**head, **schema, "allOf": rules}
