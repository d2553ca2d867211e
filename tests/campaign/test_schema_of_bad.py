"""What an editor says of the bad campaigns: what JSON Schema can express is refused, the rest is listed with the reason."""

from pathlib import Path
from types import SimpleNamespace

import pytest
import yaml
from jsonschema import Draft202012Validator
from tests.campaign.conftest import Toy

from fddbench.campaign.reading.scalars import resolve
from fddbench.campaign.reading.yaml_nodes import parse
from fddbench.campaign.schema.on_benchmark import benchmark_schema
from fddbench.errors import CampaignError

FOLDER = Path(__file__).parent.parent / "bad_campaigns"
LISTED = yaml.safe_load((Path(__file__).parent / "beyond_schemas.yaml").read_text(encoding="utf-8"))
BEYOND = {name for names in LISTED.values() for name in names}
TOYS = Draft202012Validator(benchmark_schema(Toy(), designs=["plain"]))


class Lenient(yaml.SafeLoader):
    """Reads as the YAML 1.2 parser of an editor: words by the core rules, `<<` a key as any other, aliases followed."""

    yaml_implicit_resolvers = {}  # noqa: RUF012


def _scalar(loader, node):
    if node.style is not None:
        return node.value
    try:
        return resolve(node.value)
    except ValueError:
        return float(node.value.replace(".", ""))


Lenient.add_constructor("tag:yaml.org,2002:str", _scalar)


def as_read(text):
    """What a schema is applied to: plain data with words as keys; a YAMLError for what no parser reads."""
    try:
        return parse(text, name="x").data
    except CampaignError:
        pass
    data = yaml.load(text, Lenient)
    return {str(key): value for key, value in data.items()} if isinstance(data, dict) else data


def refused(text):
    try:
        data = as_read(text)
    except (yaml.YAMLError, RecursionError):
        return False  # the parser says it, not the schema
    return next(TOYS.iter_errors(data), None) is not None


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.yaml")), ids=lambda path: path.stem)
def test_the_schema_refuses_what_it_can_and_the_rest_is_listed(path):
    assert refused(path.read_text(encoding="utf-8")) == (path.stem not in BEYOND)


def test_every_listed_file_is_there_once():
    named = [name for names in LISTED.values() for name in names]
    assert len(named) == len(BEYOND)
    assert {path.stem for path in FOLDER.glob("*.yaml")} >= BEYOND


def test_the_schema_itself_is_sound():
    Draft202012Validator.check_schema(TOYS.schema)
    assert TOYS.schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert TOYS.schema["$id"] == "urn:fddbench:campaign:toy"


def accepted(**changes):
    base = parse((FOLDER / "good_but_set.base").read_text(encoding="utf-8"), name="x").data
    return TOYS.is_valid(base | changes)


def scenario(**fault):
    return [{"name": "a", "manoeuvre": "cruise", "faults": [{"onset_s": 4, "sites": ["r1"], "kind": "jam", **fault}]}]


@pytest.mark.parametrize(
    ("changes", "good"),
    [
        ({}, True),
        ({"plant": "frozen", "voter": "mine.py:Mine", "wind": None}, True),
        ({"wind": "mine.py:Mine"}, False),  # nobody can bring a wind of his own here
        ({"detectors": ["plain", "mine", {"design": "plain", "sweep": {"threshold_deg_s": [1, 2]}}]}, True),
        ({"detectors": ["plain", {"design": "plain", "sweep": {"threshold_deg_s": {"log": [1, 2]}}}]}, False),
        ({"dispersions": {"monte_carlo": {"runs": 3, "mass_kg": {"uniform": [150e3, 200e3]}}}}, True),
        ({"dispersions": {"monte_carlo": {"runs": 3, "mass_kg": {"uniform": [100e3, 200e3]}}}}, False),
        ({"dispersions": {"sequence": {"mass_kg": [150e3, 150e3]}, "grid": {"speed_kt": [200]}}}, True),
        ({"scenarios": scenario(amplitude_percent={"grid": [1, 2]})}, True),
        ({"scenarios": scenario(amplitude_deg_s={"normal": {"mean": 0, "std": 1}})}, True),
        ({"scenarios": scenario(mode="replace", freeze=True)}, True),
        ({"scenarios": scenario(mode="replace", hold_value_deg_s=3)}, True),
        ({"scenarios": scenario(mode="replace")}, False),
        ({"scenarios": scenario(mode="replace", freeze=True, hold_value_deg_s=3)}, False),
        ({"scenarios": scenario(freeze=True, amplitude_percent=1)}, False),
        ({"scenarios": scenario(kind="mine.py:Mine", anything=3)}, True),
        ({"scenarios": scenario(kind="oscillatory", amplitude_percent=1, frequency_hz=1, frequency_rad_s=6)}, False),
        ({"scenarios": scenario(sites=["r1", "rudder"], amplitude_percent=10)}, True),
        ({"duration_s": 9, "scenarios": scenario(sites=["rudder"], amplitude_deg=10)}, True),
        ({"scenarios": scenario(sites=["r1", "r1"], amplitude_percent=10)}, False),
    ],
)
def test_what_is_right_passes_and_what_is_not_does_not(changes, good):
    assert accepted(**changes) == good


def test_a_key_says_its_unit_its_range_and_what_it_means():
    definitions = TOYS.schema["$defs"]
    mass = definitions["values_mass_kg_lateral_lpv"]
    assert mass["title"] == "mass_kg [kg]"
    assert mass["description"] == "200000 (120000 … 260000), mass"
    assert definitions["jam_deg_s"]["properties"]["amplitude_deg_s"]["title"] == "amplitude_deg_s [deg/s]"
    assert definitions["key_onset_s"]["description"].startswith("First faulty sample")


def test_a_plant_of_ones_own_may_have_any_names():
    plant = {"plant": SimpleNamespace(about="", options={"one": 1}, family="plant", needs=(), reads=None, says={})}
    own = type("Own", (Toy,), {"choices": plant})()
    free = Draft202012Validator(benchmark_schema(own))
    base = parse((FOLDER / "good_but_set.base").read_text(encoding="utf-8"), name="x").data
    strange = base | {"scenarios": [{"name": "a", "manoeuvre": "own"}], "dispersions": {"grid": {"own": [1]}}}
    assert not free.is_valid(strange)
    assert free.is_valid(strange | {"plant": "mine.py:Mine"})
