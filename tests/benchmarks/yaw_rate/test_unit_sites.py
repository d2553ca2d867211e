"""Fault sites that depend on what a campaign chooses: read, refused with a word where they are, in the schema."""

import json

import pytest
import yaml

from fddbench.campaign.load import read_campaign
from fddbench.campaign.schema.anywhere import campaign_schema
from fddbench.errors import CampaignError

LOST = {"kind": "jam", "sites": ["phi1", "p1", "r1"], "onset_s": 6.0, "amplitude_percent": 2.0}
CAMPAIGN = {
    "name": "lost", "benchmark": "yaw_rate", "seed": 1, "detectors": ["voting_monitor"],
    "scenarios": [{"name": "unit", "manoeuvre": "cruise", "faults": [LOST]}],
}  # fmt: skip


def test_a_site_that_another_option_would_bring_is_refused_with_the_option(tmp_path):
    path = tmp_path / "lost.yaml"
    path.write_text(yaml.safe_dump(CAMPAIGN))
    expected = r"no fault site is called 'phi1'. Known: r1, r2, r3. There is one with `sensors: iru`"
    with pytest.raises(CampaignError, match=expected):
        read_campaign(path)
    campaign = read_campaign(path, ["sensors=iru"])
    assert [site.name for site in campaign.plant.sites][3:] == ["phi1", "phi2", "phi3", "p1", "p2", "p3"]
    with pytest.raises(CampaignError, match=r"no fault site is called 'nowhere'. Known: .*p3$"):
        read_campaign(path, ["sensors=iru", "scenarios.0.faults.0.sites=[nowhere]"])


def test_keys_of_their_units_are_in_the_schema():
    faults = campaign_schema()["$defs"]["ScenarioEntry"]["properties"]["faults"]["items"]["anyOf"]
    assert "amplitude_deg" in json.dumps(faults)
