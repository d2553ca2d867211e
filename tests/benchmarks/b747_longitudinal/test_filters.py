"""The shipped detection filters on the Boeing 747: what decouples on the LPV plant, and how near the nonlinear one comes."""

import numpy as np
import pytest

import fddbench
from fddbench import gallery
from fddbench.campaign.load import read_campaign

SHORT = "scenarios.{}.manoeuvre=level"


@pytest.fixture(scope="module")
def flown():
    """Estimates [deg, N], (n_time, 2) per scenario and filter, and what the faults added, for a plant and a law."""
    known = {}

    def fly(plant, law, *filters):
        key = (plant, law, filters)
        if key not in known:
            known[key] = _fly(plant, law, filters)
        return known[key]

    return fly


def _fly(plant, law, filters):
    # point 0 of the campaign is the nominal aircraft
    path = gallery.folder("campaigns") / "b747_coefficients.yaml"
    changes = [f"plant={plant}", f"law={law}", f"detectors=[{', '.join(filters)}]", "dispersions={}"]
    level = [SHORT.format(name) for name in ("healthy", "elevator", "thrust")] if law == "open_loop" else []
    campaign = read_campaign(path, changes + level)
    estimates, added = {}, {}
    for scenario in ("healthy", "elevator", "thrust"):
        seen = fddbench.signals(campaign, scenario)
        for name in filters:
            own = seen.detectors[name]
            estimates[scenario, name] = np.hstack([own["estimate_elevator_deg"], own["estimate_thrust_n"]])
        pairs = (("elevator_true_deg", "elevator_deg"), ("thrust_true_n", "thrust_n"))
        added[scenario] = np.hstack([seen.signals[true] - seen.signals[read] for true, read in pairs])
    return seen.time_s, estimates, added


def wrong_to_right(estimates, name, *, less_healthy):
    """Peak of the other fault's estimate over the peak of the fault's own: thrust for an elevator fault, and vice versa."""
    base = estimates["healthy", name] if less_healthy else 0.0
    elevator, thrust = estimates["elevator", name] - base, estimates["thrust", name] - base
    right = np.abs(estimates["elevator", name][:, 0]).max(), np.abs(estimates["thrust", name][:, 1]).max()
    return np.abs(elevator[:, 1]).max() / right[1], np.abs(thrust[:, 0]).max() / right[0]


@pytest.mark.parametrize(("variant", "law"), [("fold", "hinf"), ("approx", "open_loop"), ("approx", "lqi")])
def test_on_the_affine_aircraft_the_other_fault_does_not_show(flown, variant, law):
    name = f"lpv_filter_{variant}"
    _, estimates, _ = flown(f"lpv_{variant}", law, name)
    assert max(wrong_to_right(estimates, name, less_healthy=False)) < 1e-6  # 1e-11 measured
    assert np.abs(estimates["healthy", name]).max(axis=0) == pytest.approx(0.0, abs=1e-5)


ALL = ("lpv_filter_fold", "lpv_filter_approx", "lpv_filter_trim_removed", "lti_filter_b747")


@pytest.mark.parametrize("law", ["hinf", "lqi"])
@pytest.mark.parametrize("name", ALL[:3])
def test_on_the_nonlinear_aircraft_it_stays_below_5_percent_and_sizes_are_right(flown, law, name):
    time_s, estimates, added = flown("nonlinear", law, *ALL)
    assert max(wrong_to_right(estimates, name, less_healthy=True)) < 0.05
    for scenario, row, start_s, end_s in (("elevator", 0, 50.0, 75.0), ("thrust", 1, 65.0, 115.0)):
        counted = (time_s >= start_s) & (time_s < end_s)
        estimate, truth = estimates[scenario, name][counted, row], added[scenario][counted, row]
        assert estimate.mean() == pytest.approx(truth.mean(), rel=0.05)
        assert np.sqrt(np.mean((estimate - truth) ** 2)) < 0.05 * np.abs(truth).mean()


def test_in_open_loop_too_while_the_fault_lasts(flown):
    """After it the aircraft swings to a path of -8 deg, where the model takes its sine for the angle: 7 % there."""
    time_s, estimates, _ = flown("nonlinear", "open_loop", *ALL)
    for name in ALL[:3]:
        lasting = (time_s < 75.0)[:, np.newaxis]
        during = {key: np.where(lasting | (key[0] == "thrust"), value, 0.0) for key, value in estimates.items()}
        assert max(wrong_to_right(during, name, less_healthy=True)) < 0.05


def test_the_transients_of_the_paper_come_with_fold_and_go_with_approx(flown):
    time_s, estimates, _ = flown("nonlinear", "hinf", *ALL)
    for begin_s in (25.0, 100.0):
        during = (time_s >= begin_s) & (time_s < begin_s + 5.0)
        fold, approx = (np.abs(estimates["healthy", f"lpv_filter_{v}"][during, 0]).max() for v in ("fold", "approx"))
        assert fold > 0.015
        assert approx < 0.1 * fold


def test_scheduling_beats_one_flight_condition_away_from_it(flown):
    _, estimates, _ = flown("nonlinear", "hinf", *ALL)
    scheduled, constant = (np.abs(estimates["healthy", ALL[i]][:, 0]).max() for i in (1, 3))
    assert scheduled < 0.2 * constant


@pytest.mark.parametrize(
    ("change", "site", "share"),
    [("delta_c_m_elevator_percent=5", 0, -0.11), ("delta_c_d_percent=5", 1, 0.14), ("x_cg_ratio=0.26", 0, 0.10)],
)
def test_what_is_not_known_of_the_aircraft_biases_the_estimates(change, site, share):
    """The 10 % that 5 % of the elevator's moment are worth; and the offset tracker takes most of it out."""
    path, names = (
        gallery.folder("campaigns") / "b747_coefficients.yaml",
        ("lpv_filter_approx", "lpv_filter_trim_removed"),
    )
    key, value = change.split("=")
    scenario, begin_s, end_s = (("elevator", 50.0, 75.0), ("thrust", 65.0, 115.0))[site]
    campaign = read_campaign(path, [f"dispersions={{grid: {{{key}: [{value}]}}}}", f"detectors=[{', '.join(names)}]"])
    seen = fddbench.signals(campaign, scenario)
    true, read, estimate = (
        ("elevator_true_deg", "elevator_deg", "estimate_elevator_deg"),
        ("thrust_true_n", "thrust_n", "estimate_thrust_n"),
    )[site]
    counted = (seen.time_s >= begin_s) & (seen.time_s < end_s)
    size = (seen.signals[true] - seen.signals[read])[counted].mean()
    found = [seen.detectors[name][estimate][counted].mean() / size - 1.0 for name in names]
    assert found[0] == pytest.approx(share, abs=0.015)
    assert abs(found[1]) < 0.02


def test_a_trim_change_of_300_s_looks_like_a_fault_unless_drag_or_offset_are_taken_care_of():
    """A descent leaves the lift that Table B1 knows: 4.5 kN of thrust that is not there."""
    names = ("lpv_filter_fold", "lpv_filter_approx", "lpv_filter_trim_removed", "lpv_filter_unclipped")
    changes = [
        f"detectors=[{', '.join(names)}]",
        "dispersions={}",
        "duration_s=400",
        "scenarios.healthy.manoeuvre=descent",
    ]
    campaign = read_campaign(gallery.folder("campaigns") / "b747_coefficients.yaml", changes)
    seen = fddbench.signals(campaign, "healthy").detectors
    peaks_n = [np.abs(seen[name]["estimate_thrust_n"]).max() for name in names]
    assert min(peaks_n[:2]) > 4000.0
    assert peaks_n[2] < 1500.0
    assert peaks_n[3] < 100.0
