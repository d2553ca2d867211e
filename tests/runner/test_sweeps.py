"""A swept gain flies as a design with that value would, and what variants share is flown once."""

import pandas as pd
import pytest
import yaml

import fddbench
from fddbench import gallery, load, operating_curve
from fddbench.api.tables import overview
from fddbench.blocks.accounting import cost
from fddbench.blocks.merge import merged
from fddbench.campaign.load import read_campaign
from fddbench.errors import FddbenchError
from fddbench.reporting.scores import scores_text
from fddbench.results.folder import provenance_of
from fddbench.runner.assembling import assemble
from fddbench.runner.fused import Fused
from fddbench.runner.run import run_campaign

TEXT = """\
name: swept
benchmark: yaw_rate
seed: 5
duration_s: 3.0
detectors: DETECTORS
dispersions: {monte_carlo: {runs: 6, mass_kg: {uniform: [180000, 220000]}}}
scenarios:
  - {name: healthy, manoeuvre: roll_doublet}
  - {name: jam, manoeuvre: cruise, faults: [{kind: jam, sites: [r1, r2], onset_s: 1, amplitude_percent: {uniform: [0.2, 3]}}]}
"""
SWEPT = (
    "[voting_monitor, {design: sliding_mode_published, sweep: {threshold_floor_deg_s: [0.1, 0.4], k: {scale: [2]}}}, "
    "{design: cusum_example, sweep: {limit_deg_s: [1, 4]}}]"
)
APART = "[voting_monitor, one, two, three, four, five]"


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """Results of the sweep, and of designs that have the same values."""
    folder = tmp_path_factory.mktemp("swept")
    shipped = gallery.folder("detectors")
    (folder / "detectors").mkdir()
    (folder / "detectors" / "cusum_example.py").write_bytes((shipped / "cusum_example.py").read_bytes())
    published = yaml.safe_load((shipped / "sliding_mode_published.yaml").read_text(encoding="utf-8"))
    cusum = yaml.safe_load((shipped / "cusum_example.yaml").read_text(encoding="utf-8"))
    doubled = [2.0 * k for k in published["gains"]["k"]]
    for name, design, gain in [
        ("one", published, {"threshold_floor_deg_s": 0.1}), ("two", published, {"threshold_floor_deg_s": 0.4}),
        ("three", published, {"k": doubled}), ("four", cusum, {"limit_deg_s": 1}), ("five", cusum, {"limit_deg_s": 4}),
    ]:  # fmt: skip
        content = {**design, "gains": {**design["gains"], **gain}}
        (folder / "detectors" / f"{name}.yaml").write_text(yaml.safe_dump(content), encoding="utf-8")
    for name, detectors in (("swept", SWEPT), ("apart", APART)):
        (folder / f"{name}.yaml").write_text(TEXT.replace("DETECTORS", detectors), encoding="utf-8")
        run_campaign(read_campaign(folder / f"{name}.yaml"), folder / name, jobs=1)
    return folder


def test_flies_as_a_design_of_that_value(folders):
    swept, apart = load(folders / "swept"), load(folders / "apart")
    gains = ["gain_threshold_floor_deg_s", "factor_k", "gain_limit_deg_s"]
    assert list(dict.fromkeys(swept["detector"]))[:2] == [
        "voting_monitor",
        "sliding_mode_published.threshold_floor_deg_s.1",
    ]
    pd.testing.assert_frame_equal(
        swept.drop(columns=[*gains, "detector"]), apart.drop(columns=["detector"]), check_exact=True
    )
    assert swept["outcome"].nunique() > 2


def test_the_value_stands_in_a_column_of_its_own(folders):
    swept = load(folders / "swept")
    by = swept.groupby("detector", sort=False)[["gain_threshold_floor_deg_s", "factor_k", "gain_limit_deg_s"]].first()
    assert by.notna().sum(axis=1).tolist() == [0, 1, 1, 1, 1, 1]
    assert by["gain_threshold_floor_deg_s"].dropna().tolist() == [0.1, 0.4]
    assert by["factor_k"].dropna().to_dict() == {"sliding_mode_published.k.1": 2.0}
    assert "factor on k [-]" in swept.attrs["columns"]["factor_k"]


def test_goes_on_where_it_stopped(folders):
    campaign = read_campaign(folders / "swept.yaml")
    assert run_campaign(campaign, folders / "swept", jobs=1).flights == 0
    frozen = read_campaign(folders / "swept" / "campaign.yaml")
    assert frozen.sha256 == campaign.sha256
    names = [design.name for design in campaign.designs]
    assert list(provenance_of(folders / "swept")["designs_sha256"]) == names
    scores = scores_text(*overview(folders / "swept"), provenance_of(folders / "swept"))
    assert all(name in scores for name in names)


def test_operating_curves_have_the_points_of_their_designs_in_order(folders):
    curve = operating_curve(folders / "swept")
    assert list(dict.fromkeys(zip(curve["design"], curve["gain"], strict=True))) == [
        ("sliding_mode_published", "threshold_floor_deg_s"), ("sliding_mode_published", "k"), ("cusum_example", "limit_deg_s"),
    ]  # fmt: skip
    assert curve["value"].tolist() == [0.1, 0.4, 2.0, 1.0, 4.0]
    assert set(curve["scenario"]) == {"jam"}
    assert not curve["as_designed"].any()
    rows, alarms = load(folders / "swept"), fddbench.alarms(folders / "swept").set_index("detector")
    for line in curve.itertuples():
        assert line.false_alarm_per_hour == alarms.loc[line.detector, "false_alarm_per_hour"]
        own = rows[(rows["detector"] == line.detector) & (rows["scenario"] == "jam")]
        assert line.missed_percent == pytest.approx(100 * own["outcome"].isin(["missed", "late"]).mean())
        assert line.detections == own["detection_time_s"].notna().sum()
    assert curve["missed_percent"].iloc[0] <= curve["missed_percent"].iloc[1]  # a higher floor misses more
    assert operating_curve(folders / "swept", gain="k").shape[0] == 1
    assert set(fddbench.columns("operating")) == set(curve.columns)


def test_an_operating_curve_that_is_not_there_is_told(folders):
    with pytest.raises(FddbenchError, match="no such operating curve. It has those of sliding_mode_published"):
        operating_curve(folders / "swept", design="voting_monitor")
    with pytest.raises(FddbenchError, match="apart has no operating curve. A campaign sweeps a gain as"):
        operating_curve(folders / "apart")


def test_the_design_itself_is_a_point_of_its_curve(folders):
    swept = "{design: sliding_mode_published, sweep: {threshold_floor_deg_s: [0.1, 0.4], k: {scale: [2]}}}"
    detectors = f"detectors=[sliding_mode_published, {swept}]"
    run_campaign(read_campaign(folders / "swept.yaml", [detectors]), folders / "beside", jobs=1)
    curve = operating_curve(folders / "beside")
    assert curve["value"].tolist() == [0.1, 0.25, 0.4, 1.0, 2.0]
    assert curve["as_designed"].tolist() == [False, True, False, True, False]


def test_variants_share_what_does_not_differ():
    counts = []
    for values in ("[0.1]", "[0.1, 0.2, 0.3]"):
        swept = f"detectors=[{{design: sliding_mode_published, sweep: {{threshold_floor_deg_s: {values}}}}}]"
        assembly = assemble(read_campaign(gallery.folder("campaigns") / "smoke.yaml", [swept]))
        fused = Fused.of(assembly, tuple(assembly.detectors))
        counts.append(cost(merged(fused.program().keep("state", "finished"), fused.merge_keys())[0]).flops)
    # a detector more is its decision and its score, not its observer again
    assert (counts[1] - counts[0]) / 2 < 0.12 * counts[0]
