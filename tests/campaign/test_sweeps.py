"""A swept gain: which detectors it makes, and what the campaign means by it."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fddbench.campaign.load import read_campaign
from fddbench.campaign.rules.swept import Sweep

SWEPT = "[plain, {design: plain, sweep: {threshold_deg_s: [2, 0.5], weights: {scale: [1, 3]}, confirmation_s: [0.2]}}]"


def read(write, detectors, **changes):
    return read_campaign(write(**{"[plain]": detectors, **changes}))


def test_one_detector_a_value_each_gain_by_itself(write):
    found = {design.name: design for design in read(write, SWEPT).designs}
    assert list(found) == [
        "plain", "plain.threshold_deg_s.1", "plain.threshold_deg_s.2", "plain.weights.1", "plain.weights.2",
        "plain.confirmation_s.1",
    ]  # fmt: skip
    assert found["plain"].swept is None
    first, scaled, left_out = (
        found[f"plain.{name}"] for name in ("threshold_deg_s.1", "weights.2", "confirmation_s.1")
    )
    assert first.gains.model_dump() == {**found["plain"].gains.model_dump(), "threshold_deg_s": 2.0}
    assert scaled.gains.model_dump() == {**found["plain"].gains.model_dump(), "weights": (3.0, 7.5)}
    assert left_out.gains.confirmation_s == 0.2  # the file leaves it to the default
    assert (first.swept.column, first.swept.value) == ("gain_threshold_deg_s", 2.0)
    assert (scaled.swept.column, scaled.swept.value) == ("factor_weights", 3.0)


def test_an_item_of_a_list_is_reached_by_its_number(write):
    design = read(write, "[{design: plain, sweep: {weights.1: [9]}}]").designs[0]
    assert design.name == "plain.weights.1.1"
    assert design.gains.weights == (1.0, 9.0)


def test_what_is_frozen_reads_back(write, tmp_path):
    campaign = read(write, SWEPT)
    for name, content in campaign.files().items():
        path = tmp_path / "frozen" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    assert sorted(campaign.files()) == ["campaign.yaml", "detectors/plain.yaml"]
    again = read_campaign(tmp_path / "frozen" / "campaign.yaml")
    assert again.sha256 == campaign.sha256
    assert [design.gains for design in again.designs] == [design.gains for design in campaign.designs]


def test_the_fingerprint_follows_the_values_and_not_how_they_are_written(write):
    one = read(write, "[{design: plain, sweep: {threshold_deg_s: [1, 2]}}]").sha256
    assert one != read(write, "[{design: plain, sweep: {threshold_deg_s: [1, 3]}}]").sha256
    assert one == read(write, "[{design: plain, sweep: {threshold_deg_s: [1.0, 2]}}]").sha256


def test_the_aircraft_may_act_on_a_variant(write):
    campaign = read(write, SWEPT, **{"seed: 7": "seed: 7\nreconfigure: plain.threshold_deg_s.2"})
    assert campaign.reconfigure == "plain.threshold_deg_s.2"


@given(st.floats(-1e3, 1e3), st.floats(0.1, 1e3), st.integers(2, 40))
def test_spans_reach_their_ends_in_equal_steps(first, length, count):
    values = Sweep(linspace=(first, first + length, float(count))).values
    assert len(values) == count
    assert (values[0], values[-1]) == (pytest.approx(first, abs=1e-6), pytest.approx(first + length, abs=1e-6))
    ratios = Sweep(log=(length, 8.0 * length, 4.0)).values
    assert ratios == pytest.approx([length, 2 * length, 4 * length, 8 * length])
