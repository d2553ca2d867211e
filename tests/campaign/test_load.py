import contextlib
import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench import gallery
from fddbench.campaign.load import read_campaign
from fddbench.campaign.schema.anywhere import campaign_schema
from fddbench.errors import CampaignError
from fddbench.voting.median import Median


def test_fills_in_the_defaults(write):
    campaign = read_campaign(write())
    assert campaign.choices == {"plant": "lateral_lpv", "voter": "median", "sensors": "white", "wind": "none"}
    assert campaign.chosen == {"plant": "moving", "voter": Median, "sensors": 0.01, "wind": 0.0}
    assert (campaign.benchmark, campaign.bench.name, campaign.plant) == ("toy", "toy", campaign.bench)
    assert (campaign.purpose, campaign.sample_s, campaign.substeps, campaign.duration_s) == (
        "evaluation",
        0.01,
        1,
        None,
    )
    assert [scenario.name for scenario in campaign.scenarios] == ["healthy", "jam_a"]
    assert campaign.scenarios[1].faults[0].sites == ("r1",)
    assert campaign.dispersions.monte_carlo.parameters["mass_kg"].uniform == (150e3, 200e3)


def test_overrides_take_effect(write):
    overrides = [
        "dispersions.monte_carlo.runs=9",
        "scenarios.jam_a.faults.0.onset_s=6",
        "scenarios.0.duration_s=30",
        "detectors=[plain]",
        "dispersions.grid.speed_kt=[200, 250]",
    ]
    campaign = read_campaign(write(), overrides)
    assert campaign.dispersions.monte_carlo.runs == 9
    assert campaign.scenarios[1].faults[0].onset_s == 6.0
    assert campaign.scenarios[0].entry.duration_s == 30.0
    assert campaign.dispersions.grid == {"speed_kt": (200.0, 250.0)}


def test_overrides_do_not_mend_what_they_replace_twice(write):
    assert read_campaign(write(), ["seed=1", "seed=2"]).seed == 2


def test_frozen_text_means_the_same(write, tmp_path):
    campaign = read_campaign(write(), ["dispersions.monte_carlo.runs=9", 'about="1e-3"'])
    folder = tmp_path / "results"
    for name, content in campaign.files().items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    again = read_campaign(folder / "campaign.yaml")
    assert (again.sha256, again.text, again.scenarios) == (campaign.sha256, campaign.text, campaign.scenarios)


@pytest.mark.parametrize(
    ("override", "same"),
    [
        ("about=another question", True),
        ("requirements=[{of: right_share, at_least: 0.9}]", True),
        ("sample_s=0.010", True),
        ("plant=lateral_lpv", True),
        ("purpose=evaluation", True),
        ("seed=8", False),
        ("plant=frozen", False),
        ("scenarios.jam_a.faults.0.amplitude_percent=11", False),
        ("scenarios.jam_a.name=jam_b", False),
    ],
)
def test_hash_follows_the_meaning(write, override, same):
    path = write()
    assert (read_campaign(path).sha256 == read_campaign(path, [override]).sha256) is same


def test_hash_follows_the_designs(write):
    before = read_campaign(write()).sha256
    text = "kind: watcher\nsource: made up\ntuned_on: null\ngains: {threshold_deg_s: 2}\n"
    assert read_campaign(write(designs={"plain": text})).sha256 != before


def test_an_old_place_is_forgotten(write):
    with pytest.raises(
        CampaignError, match=r"\n--set scenarios.jam_a.faults=\[\{kind: jam\}\]: key 'sites' is missing"
    ):
        read_campaign(write(), ["scenarios.jam_a.faults=[{kind: jam}]"])


def test_bare_names_are_shipped_campaigns(write, monkeypatch, tmp_path):
    shipped = gallery.folder("campaigns") / "shipped.yaml"
    shipped.write_text(write().read_text())
    (gallery.folder("detectors") / "plain.yaml").write_text((tmp_path / "detectors/plain.yaml").read_text())
    empty = tmp_path / "empty"
    empty.mkdir()
    monkeypatch.chdir(empty)
    assert read_campaign(Path("shipped")).name == read_campaign(Path("shipped.yaml")).name == "good"
    with pytest.raises(CampaignError, match="no such file. Did you mean 'shipped'"):
        read_campaign(Path("shiped"))
    shipped.unlink()
    (gallery.folder("detectors") / "plain.yaml").unlink()


PATHS = ["seed", "scenarios", "scenarios.0", "dispersions", "detectors", "scenarios.jam_a.faults.0.sites", "x.y"]
VALUES = ["", "1", "-1", "true", "[]", "{}", "[1]", "[[]]", "{a: 1}", "text", "1e9", "[{}]", "~"]


@settings(max_examples=60)
@given(st.sampled_from(PATHS), st.sampled_from(VALUES))
def test_nothing_but_a_campaign_error(path, value):
    base = Path(__file__).parent.parent / "bad_campaigns" / "good_but_set.base"
    with contextlib.suppress(CampaignError):
        read_campaign(base, [f"{path}={value}"])


def test_schema_is_json_and_knows_the_faults():
    text = json.dumps(campaign_schema())
    assert "amplitude_percent" in text
    assert "truncated_normal" in text


@pytest.mark.parametrize(("half_width", "refused"), [(0.125, True), (0.127, False)])
def test_a_window_must_hold_a_tenth_of_the_distribution(write, half_width, refused):
    """Within 0.12566 sigma of its mean a normal distribution has 10 %."""
    window = (
        f"{{truncated_normal: {{mean: 2e5, std: 1e4, low: {2e5 - half_width * 1e4}, high: {2e5 + half_width * 1e4}}}}}"
    )
    path = write(**{"{uniform: [150e3, 200e3]}": window})
    if refused:
        with pytest.raises(CampaignError, match="needs at least 10 %"):
            read_campaign(path)
    else:
        read_campaign(path)


@pytest.mark.parametrize(("end_s", "refused"), [(4.5, True), (4.51, False)])
def test_a_fault_may_not_end_with_its_last_onset(write, end_s, refused):
    jam = "{kind: jam, sites: [r1], onset_s: 4, amplitude_percent: 10}"
    path = write(
        **{jam: f"{{kind: jam, sites: [r1, r2], onset_s: 4, delay_s: 0.5, end_s: {end_s}, amplitude_percent: 10}}"}
    )
    if refused:
        with pytest.raises(CampaignError, match=r"ends at 4.5 s, before its last site fails at 4.5 s"):
            read_campaign(path)
    else:
        read_campaign(path)
