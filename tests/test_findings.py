"""What is kept of a campaign's findings was flown with the campaign as it stands."""

import re
from pathlib import Path

import pytest

from fddbench import gallery
from fddbench.campaign.load import read_campaign

KEPT = sorted(gallery.folder("reports").glob("*/finding.md"))


@pytest.mark.parametrize("path", KEPT, ids=lambda path: path.parent.name)
def test_a_finding_is_of_the_campaign_as_it_stands(path):
    text, campaign = path.read_text(encoding="utf-8"), read_campaign(Path(path.parent.name))
    assert re.search(r"campaign ([0-9a-f]{16})", text)[1] == campaign.sha256[:16], "fly it again: make findings"
    assert f"seed {campaign.seed}," in text
