"""What an editor says of campaigns on logs."""

import pytest
from jsonschema import Draft202012Validator

from fddbench import kinds
from fddbench.campaign.schema.anywhere import campaign_schema
from fddbench.campaign.schema.on_benchmark import benchmark_schema
from fddbench.interfaces.benchmark import default_choices


@pytest.mark.parametrize(("name", "good"), [("recorded", True), ("yaw_rate", False)])
def test_a_limit_without_faults_is_for_flights_that_bring_their_own(name, good):
    benchmark = kinds.load("benchmark", name)()
    manoeuvre = next(iter(benchmark.plant(default_choices(benchmark)).manoeuvres))
    entry = {"name": "a", "manoeuvre": manoeuvre}
    campaign = {"name": "a", "benchmark": name, "seed": 1, "detectors": ["voting_monitor"], "scenarios": [entry]}
    limited = campaign | {"scenarios": [entry | {"detection_time_limit_s": 2.0}]}
    for schema in (benchmark_schema(benchmark, designs=["voting_monitor"]), campaign_schema()):
        checks = Draft202012Validator(schema)
        assert checks.is_valid(campaign)
        assert checks.is_valid(limited) == good
