"""Golden: the smoke campaign gives the scores that are kept in reports/smoke/scores.yaml."""

import yaml

from fddbench import gallery
from fddbench.campaign.load import read_campaign
from fddbench.metrics.alarms import summarize_alarms
from fddbench.metrics.summary import summarize
from fddbench.reporting.scores import false_alarms, scores
from fddbench.results.table import load
from fddbench.runner.run import run_campaign


def test_smoke_scores(tmp_path):
    campaign = read_campaign(gallery.folder("campaigns") / "smoke.yaml")
    run_campaign(campaign, tmp_path / "smoke", jobs=2)
    kept = yaml.safe_load((gallery.folder("reports") / "smoke" / "scores.yaml").read_text(encoding="utf-8"))
    assert kept["provenance"]["campaign_sha256"] == campaign.sha256, (
        "campaign or designs have changed: run `make scores` and read the difference"
    )
    rows = load(tmp_path / "smoke")
    assert scores(summarize(rows)) == kept["scores"]
    assert false_alarms(summarize_alarms(rows)) == kept["false_alarms"]


def test_kept_scores_belong_to_the_shipped_campaigns():
    for path in sorted(gallery.folder("reports").glob("*/scores.yaml")):
        kept = yaml.safe_load(path.read_text(encoding="utf-8"))["provenance"]
        campaign = read_campaign(gallery.folder("campaigns") / f"{path.parent.name}.yaml")
        assert kept["campaign_sha256"] == campaign.sha256, f"{path} is of an older campaign: run `make scores`"
