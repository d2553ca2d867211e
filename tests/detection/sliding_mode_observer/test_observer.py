"""The observer of any affine model: what it reconstructs of a sensor's and of an actuator's fault, and what it refuses."""

import numpy as np
import pytest
import yaml
from scipy.linalg import expm

from fddbench import gallery
from fddbench.campaign.load import read_campaign
from fddbench.design.recipe import cook
from fddbench.designs.design import read_design
from fddbench.detection.sliding_mode_observer.observer import Observer
from fddbench.errors import CampaignError, DesignError
from fddbench.runner.assembling import assemble
from fddbench.runner.replay import replay_campaign

ACTUATOR = """\
kind: sliding_mode_observer
source: mine
tuned_on: null
recipe:
  model: {A: [[-1.0, 1.0], [-2.0, -1.0]], B: [[1.0, 0.0], [0.5, 1.0]], C: [[1.0, 0.0], [0.0, 1.0]]}
  outputs: [{signal: y, row: 0}, {signal: y, row: 1}]
  inputs: [{signal: pump_a, scale: 2.0}, {signal: valve_m}]
  faults: {pump: pump_a}
  corruption_pole_1_s: 20.0
  uncertainty: [[0.0], [1.0]]
  weights: {uncertainty: [0.1], corruption: [0.01, 0.01], fault: {pump: 1.0}}
  error_pole_1_s: -3.0
  k: 500.0
  delta: 0.5
  confirm_s: 0.2
gains: {}
"""
SENSOR = (
    ACTUATOR.replace("  faults: {pump: pump_a}\n", "  suspects: {y2: y_2}\n  filter_pole_1_s: 0.1\n")
    .replace("{signal: y, row: 0}, {signal: y, row: 1}", "{signal: y_1}, {signal: y_2, scale: 4.0}")
    .replace("{pump: 1.0}", "{y2: 1.0}")
)
T = 0.01


def cooked(tmp_path, text):
    path = tmp_path / "own.yaml"
    path.write_text(text)
    path.write_text(cook(path).text)
    return read_design(path)


def estimates(design, *, at_input=0.0, at_output=0.0, seconds=6.0):
    """Estimate of the observer beside the exact plant, in the unit of the site, with a fault from 1 s on."""
    gains = design.gains
    A, B = np.array([[-1.0, 1.0], [-2.0, -1.0]]), np.array([[1.0, 0.0], [0.5, 1.0]])
    whole = expm(np.block([[A, B], [np.zeros((2, 4))]]) * T)
    observer, x, found = Observer(gains, T), np.array([0.3, -0.2]), []
    state = observer.states.spread(observer.start(), 1)
    for k in range(round(seconds / T)):
        on, u = k >= 100, np.array([0.4, np.sin(0.02 * k)])
        y = x + (np.array([0.0, at_output]) if on else 0.0)
        state, f = observer.step(state, y[:, None], u[:, None], np.zeros((0, 1)), np.array([k == 0]))
        found.append(f[0, 0] * gains.unit_per_fault[0])
        flown = u + (np.array([at_input, 0.0]) if on else 0.0)
        x = whole[:2, :2] @ x + whole[:2, 2:] @ flown
    return np.array(found)


def test_an_actuator_s_fault_comes_back_in_its_unit(tmp_path):
    """0.3 in the model is 0.15 of the site, whose unit is twice as large."""
    found = estimates(cooked(tmp_path, ACTUATOR), at_input=0.3)
    assert np.abs(found[:100]).max() < 0.01
    assert found[-1] == pytest.approx(0.15, rel=0.03)


@pytest.mark.parametrize("injection", ["unit_vector", "super_twisting, twisting: {k1: [3.0, 3.0], k2: [5.0, 5.0]}"])
def test_every_injection_tells_a_sensor_s_fault(tmp_path, injection):
    kind, _, twisting = injection.partition(", ")
    text = SENSOR.replace(
        "  delta: 0.5\n", f"  delta: 0.5\n  injection: {kind}\n" + (f"  {twisting}\n" if twisting else "")
    )
    found = estimates(cooked(tmp_path, text), at_output=0.2)
    assert np.abs(found[:100]).max() < 0.004
    assert found[-1] == pytest.approx(0.05, rel=0.05)  # 0.2 in the model, whose unit is a quarter of the signal's


def test_the_sigmoid_tells_it_too_and_no_other_fault(tmp_path):
    design = cooked(tmp_path, SENSOR)
    assert estimates(design, at_output=0.2)[-1] == pytest.approx(0.05, rel=0.08)
    assert abs(estimates(design)[-1]) < 0.004


@pytest.mark.parametrize(
    ("old", "new", "kind", "message"),
    [
        ("pump: pump_a}", "pump: pump_b}", DesignError, "fault 'pump' is of input 'pump_b', which the model has 0 times"),
        ("  faults: {pump: pump_a}\n", "", CampaignError, "suspects or faults: the outputs that may be faulty"),
        ("  k: 500.0", "  k: 0.5", DesignError, "condition \\(15\\): min K = 0.5 does not exceed eta_0 = 1"),
        ("faults: {pump: pump_a}", "faults: {pump: pump_a, valve: valve_m}", DesignError, "2 faults and 2 outputs"),
        ("B: [[1.0, 0.0], [0.5, 1.0]]", "B: [[0.0, 0.0], [0.0, 1.0]]", DesignError, "C F has rank 0 for 1 faults"),
        ("uncertainty: [[0.0], [1.0]]", "uncertainty: [[0.0]]", DesignError, "uncertainty needs 2 rows, one per state, got 1"),
        ("fault: {pump: 1.0}", "fault: {valve: 1.0}", DesignError, "weights.fault needs a size for each of pump"),
        ("  confirm_s", "  filter_pole_1_s: 0.1\n  confirm_s", CampaignError, "suspect outputs pass a filter with this pole"),
    ],
)  # fmt: skip
def test_recipes_that_give_nothing_say_why(tmp_path, old, new, kind, message):
    assert old in ACTUATOR
    with pytest.raises(kind, match=message):
        cooked(tmp_path, ACTUATOR.replace(old, new))


def test_a_fault_that_changes_its_sign_in_the_box_is_refused(tmp_path):
    (tmp_path / "mine.py").write_text(
        "import numpy as np\nclass Tilt:\n    about, signals, parameters, box = 'a', ('tilt',), ('tilt',), ((-1.0, 1.0),)\n"
        "    def rho(self, measured):\n        return np.stack([measured.tilt])\n"
    )
    text = ACTUATOR.replace("model: {", "scheduling: mine.py:Tilt\n  model: {").replace(
        "B: [[1.0, 0.0], [0.5, 1.0]]", "B: [[[1.0, 0.0], [0.5, 1.0]], [[2.0, 0.0], [1.0, 0.0]]]"
    )
    with pytest.raises(DesignError, match="fault 'pump' has -100 % of its strength somewhere in the box"):
        cooked(tmp_path, text)


def test_sizes_that_do_not_fit_are_refused(tmp_path):
    path = tmp_path / "own.yaml"
    path.write_text(ACTUATOR)
    data = yaml.safe_load(cook(path).text)
    data["gains"]["W"] = [[1.0]]
    path.write_text(yaml.safe_dump(data))
    with pytest.raises(CampaignError, match="W: needs matrices of 1 rows of 2 numbers"):
        read_design(path)


def test_the_shipped_design_of_the_boeing_747_is_what_its_recipe_gives():
    path = gallery.folder("detectors") / "sliding_mode_b747.yaml"
    made, filed = cook(path), yaml.safe_load(path.read_text())
    assert made.found["gamma_optimum"] == pytest.approx(filed["recipe"]["found"]["gamma_optimum"], rel=1e-4)
    assert made.found["gamma_lower_bound"] == pytest.approx(
        made.found["gamma_optimum"], rel=1e-3
    )  # nothing is left to gain
    np.testing.assert_allclose(made.gains["W"], filed["gains"]["W"], rtol=0.05, atol=1.0)
    assert filed["tuned_on"] == [{"campaign": "b747_tuning", "seed": 7471}]


def test_what_a_benchmark_does_not_have_is_refused():
    campaign = read_campaign(gallery.folder("campaigns") / "smoke.yaml", ["detectors=[sliding_mode_b747]"])
    with pytest.raises(CampaignError, match="alpha_deg"):
        assemble(campaign)


def test_the_shipped_design_tells_a_fault_of_roll_rate_from_one_of_yaw_rate():
    """1 deg/s on two units of the one, and of the other: its own estimate follows, the other stays where it was."""
    campaign = read_campaign(
        gallery.folder("campaigns") / "smoke.yaml",
        ["detectors=[sliding_mode_p_and_r]", "sensors=iru", "dispersions.monte_carlo.runs=2", f"scenarios={PAIRS}"],
    )
    moved = {}
    for scenario in ("p", "r"):
        (recording,) = replay_campaign(campaign, scenarios=[scenario])
        shown = recording.detectors["sliding_mode_p_and_r"]
        moved[scenario] = [
            np.abs(shown[f"estimate_{name}"][-50:] - shown[f"estimate_{name}"][350:400]).mean() for name in "pr"
        ]
    assert moved["p"][0] == pytest.approx(0.93, abs=0.12)
    assert moved["r"][1] == pytest.approx(0.93, abs=0.12)
    assert moved["p"][1] < 0.1
    assert moved["r"][0] < 0.1


PAIRS = (
    "[{name: p, manoeuvre: cruise, duration_s: 7.0, "
    "faults: [{kind: bias, sites: [p1, p2], onset_s: 4.0, amplitude_deg_s: 1.0}]}, "
    "{name: r, manoeuvre: cruise, duration_s: 7.0, "
    "faults: [{kind: bias, sites: [r1, r2], onset_s: 4.0, amplitude_deg_s: 1.0}]}]"
)
