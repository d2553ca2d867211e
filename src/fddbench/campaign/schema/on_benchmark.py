"""JSON schema of the campaigns on one benchmark: every name, range and unit that it knows."""

from collections.abc import Iterator, Sequence
from typing import Any

from fddbench import kinds
from fddbench.campaign.in_words import options_in_words
from fddbench.campaign.rules.consistency import MOST_CASES
from fddbench.campaign.rules.dispersions import Dispersions, Distribution, MonteCarlo, Normal, TruncatedNormal
from fddbench.campaign.rules.keys import NAME_PATTERN
from fddbench.campaign.rules.model import CampaignFile, ReportEntry, RequirementEntry, ScenarioEntry, campaign_file
from fddbench.campaign.rules.references import default_of
from fddbench.campaign.rules.swept import Sweep, SweptDesign
from fddbench.campaign.schema.described import described, titled
from fddbench.campaign.schema.names import name_rules
from fddbench.campaign.schema.parts import DIALECT, FILE_KIND, Schema, one_of_names, when
from fddbench.interfaces import Benchmark, Choice
from fddbench.interfaces.benchmark import default_choices
from fddbench.metrics.requirements import MEASURES

__all__ = ["HEALTHY_WITHOUT_LIMIT", "benchmark_schema", "written_schema"]

_MODELS = (
    Dispersions, Distribution, MonteCarlo, Normal, TruncatedNormal, ReportEntry, RequirementEntry, ScenarioEntry, Sweep,
    SweptDesign,
)  # fmt: skip
_DATA_FILE = r"\.ya?ml$"

HEALTHY_WITHOUT_LIMIT: Schema = when(
    {"not": {"required": ["faults"], "properties": {"faults": {"minItems": 1}}}},
    {"properties": {"detection_time_limit_s": {"type": "null"}}},
)
"""A scenario without faults has no limit, where what flies brings no faults of its own."""


def benchmark_schema(benchmark: Benchmark, *, called: str = "", designs: Sequence[str] = ()) -> dict[str, Any]:
    """JSON schema (2020-12) of a campaign on a benchmark.

    It refuses what JSON Schema can express: unknown keys and names, values outside of their range, keys of another unit,
    keys that exclude each other. What needs arithmetic, other files or other keys of the same name is left to
    `fddbench.read`.

    Parameters
    ----------
    called : str
        How campaigns name it, where that is not its own name: ``mine.py:Mine``.
    designs : sequence of str
        Shipped designs that fit it, to be offered; others are files of one's own.
    """
    named = called or benchmark.name
    schema = written_schema(tuple(benchmark.choices))
    properties = schema["properties"]
    properties["benchmark"] |= {"const": named, "description": benchmark.about}
    for key, choice in benchmark.choices.items():
        properties[key] = {**titled(key, f"{choice.about}; default {default_of(choice)}"), **_options(choice)}
    definitions = schema["$defs"]
    definitions["design"] = one_of_names(designs, None, NAME_PATTERN)
    definitions["SweptDesign"]["properties"]["design"] = {"$ref": "#/$defs/design", **titled("design")}
    properties["detectors"]["items"] = {
        "anyOf": [{"$ref": "#/$defs/design"}, {"$ref": "#/$defs/SweptDesign"}],
    }
    if not hasattr(benchmark.plant(default_choices(benchmark)), "labelled"):
        definitions["ScenarioEntry"]["allOf"] = [HEALTHY_WITHOUT_LIMIT]
    rules = list(name_rules(benchmark, definitions))
    del schema["description"]
    return {
        "$schema": DIALECT,
        "$id": f"urn:fddbench:campaign:{benchmark.name}",
        "title": f"fddbench campaign on {named}",
        "description": benchmark.about,
        **schema,
        "allOf": [*schema["allOf"], *rules],
    }


def written_schema(choices: tuple[str, ...]) -> Schema:
    """Schema of the keys of a campaign with these choices, whatever their benchmark knows."""
    model = campaign_file(choices)
    schema = described(model.model_json_schema(), CampaignFile)
    definitions = schema["$defs"]
    for one in _MODELS:
        if one.__name__ in definitions:
            described(definitions[one.__name__], one)
    for name in ("Distribution", "Sweep"):
        definitions[name] |= {"minProperties": 1, "maxProperties": 1}
    definitions["MonteCarlo"]["properties"]["runs"]["maximum"] = MOST_CASES
    definitions["RequirementEntry"]["allOf"] = list(_limits())
    schema["properties"]["detectors"]["uniqueItems"] = True
    tuning = {"properties": {"purpose": {"const": "tuning"}}, "required": ["purpose"]}
    schema["allOf"] = [when(tuning, {"properties": {"reconfigure": {"type": "null"}}})]
    return schema


def _limits() -> Iterator[Schema]:
    """Which limit each measure is required with."""
    null = {"type": "null"}
    least = {"required": ["at_least"], "properties": {"at_most": null, "share": null, "at_least": _SHARE}}
    timed = {"required": ["at_most", "share"], "properties": {"at_least": null, "at_most": {"exclusiveMinimum": 0}}}
    share = {"required": ["at_most"], "properties": {"at_least": null, "share": null, "at_most": _SHARE}}
    rate = {
        "required": ["at_most"],
        "properties": {"at_least": null, "share": null, "at_most": {"exclusiveMinimum": 0}},
    }
    of = {"right_share": least, "normalized_detection_time": timed, "false_alarms_per_hour": rate}
    for name in MEASURES:
        yield when({"properties": {"of": {"const": name}}, "required": ["of"]}, of.get(name, share))


_SHARE: Schema = {"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1}


def _options(choice: Choice) -> Schema:
    """What a campaign may choose: the options, registered members of the family, and files."""
    known = dict.fromkeys((*choice.options, *(kinds.known(choice.family) if choice.family else ())))
    patterns = [FILE_KIND] if choice.family else []
    patterns += [_DATA_FILE] if choice.reads else []
    found = one_of_names(known, options_in_words(choice), *patterns)
    found["anyOf"].append({"type": "null"})
    return found
