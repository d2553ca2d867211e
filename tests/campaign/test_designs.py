from dataclasses import replace

import pytest
from tests.campaign.conftest import Toy

from fddbench.campaign.load import read_campaign
from fddbench.designs.building import build_detectors
from fddbench.errors import CampaignError
from fddbench.interfaces import Bus

BUS = Bus(sample_s=0.01, sites=Toy.sites, signals={"r_deg_s": 3, "rudder_deg": 0})
PLUGIN = """
from fddbench.blocks.layout import Layout, Nothing
from fddbench.interfaces import Verdict
from pydantic import BaseModel
class Mine:
    class Gains(BaseModel):
        level: float
    def __init__(self, level):
        self.level = level
    @classmethod
    def from_design(cls, gains, bus):
        return cls(gains.level)

    states, recorded, watches = Layout(Nothing()), (), ("r1",)

    def start(self):
        return Nothing()

    def step(self, x, measured):
        return x, Verdict(measured.r_deg_s[:1] > self.level, measured.r_deg_s[0] / self.level)
"""
USES_PLUGIN = "kind: plugin.py:Mine\nsource: me\ntuned_on: null\ngains: {level: 3}\n"


def test_builds_detectors_in_order(write):
    text = "kind: watcher\nsource: made up\ntuned_on: null\ngains: {threshold_deg_s: 2}\n"
    path = write(designs={"other": text}, **{"[plain]": "[other, plain]"})
    found = build_detectors(read_campaign(path).designs, BUS)
    assert list(found) == ["other", "plain"]
    assert found["plain"].detector.gains.weights == (1.0, 2.5)


def test_a_design_that_makes_no_detector_is_located(write):
    campaign = read_campaign(write())
    bus = replace(BUS, sample_s=0.5)
    with pytest.raises(CampaignError, match=r"campaign.yaml:16:13: design 'plain' \(.*shorter than a sample of 0.5 s"):
        build_detectors(campaign.designs, bus)


def test_plugins_lie_beside_their_design(write):
    path = write(designs={"mine": USES_PLUGIN, "plugin.py": PLUGIN}, **{"[plain]": "[mine]"})
    campaign = read_campaign(path)
    assert build_detectors(campaign.designs, BUS)["mine"].detector.level == 3.0
    assert campaign.files()["detectors/plugin.py"] == PLUGIN.encode()
    assert read_campaign(path).designs[0].gains == campaign.designs[0].gains


@pytest.mark.parametrize(
    ("plugin", "message"),
    [
        ("x = 1 / 0\n", r"mine.yaml:1:7: .*plugin.py:1 does not run: ZeroDivisionError"),
        ("def (:\n", r"mine.yaml:1:7: .*plugin.py does not run: SyntaxError"),
        ("class Other: pass\n", r"plugin.py has no 'Mine'. It has: Other"),
        ("class Mine: pass\n", r"'plugin.py:Mine' \(.*plugin.py\) is no detector: it has no Gains and no from_design"),
    ],
)
def test_broken_plugins_are_told(write, plugin, message):
    path = write(designs={"mine": USES_PLUGIN, "plugin.py": plugin}, **{"[plain]": "[mine]"})
    with pytest.raises(CampaignError, match=message):
        read_campaign(path)


def test_the_hash_follows_the_plugin(write):
    changes = {"[plain]": "[mine]"}
    first = read_campaign(write(designs={"mine": USES_PLUGIN, "plugin.py": PLUGIN}, **changes)).sha256
    other = read_campaign(write(designs={"mine": USES_PLUGIN, "plugin.py": PLUGIN + "# x\n"}, **changes)).sha256
    assert first != other


def test_designs_do_not_leave_their_folder(write, tmp_path):
    (tmp_path / "secret.yaml").write_text("kind: watcher\n")
    path = write(**{"[plain]": "[link]"})
    (tmp_path / "detectors" / "link.yaml").symlink_to(tmp_path / "secret.yaml")
    with pytest.raises(CampaignError, match="no design is called 'link'"):
        read_campaign(path)


def test_tuning_may_use_what_it_tunes(write):
    changes = {"name: good": "name: tuning", "seed: 7": "seed: 3"}
    with pytest.raises(CampaignError, match="was tuned on campaign 'tuning' with seed 3"):
        read_campaign(write(**changes))
    assert read_campaign(write(**changes), ["purpose=tuning"]).purpose == "tuning"
    assert read_campaign(write(**changes), ["seed=4"]).seed == 4
