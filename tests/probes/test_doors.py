"""Contract: sites, plants, benchmarks, faults, voters and choices of one's own can be added from outside."""

import shutil
from pathlib import Path

import numpy as np
import pytest
import yaml

from fddbench import kinds, testing
from fddbench.benchmarks.yaw_rate import YawRate
from fddbench.campaign.load import read_campaign
from fddbench.errors import CampaignError
from fddbench.interfaces import Choice
from fddbench.runner.assembling import assemble
from fddbench.runner.flight import Flyer
from fddbench.runner.rows import rows_and_events

BESIDE = Path(__file__).parent / "beside"
DETECTORS = ["sliding_mode_published", "voting_monitor", "cusum_example"]


@pytest.fixture
def beside(tmp_path):
    """A folder with all the files of one's own, to write campaigns into."""
    shutil.copytree(BESIDE, tmp_path, dirs_exist_ok=True)
    return tmp_path


def write(folder, **content):
    path = folder / "campaign.yaml"
    base = {"name": "probe", "benchmark": "yaw_rate", "seed": 5, "duration_s": 4.0, "detectors": DETECTORS}
    base["dispersions"] = {"monte_carlo": {"runs": 3, "mass_kg": {"uniform": [180000, 220000]}}}
    path.write_text(yaml.safe_dump({**base, **content}, sort_keys=False), encoding="utf-8")
    return path


def rows_of(path):
    assembly = assemble(read_campaign(path))
    rows, _ = rows_and_events(Flyer(assembly), np.arange(assembly.plan.n_cases))
    return rows.to_pandas(), assembly


JAM_R = {"name": "jam_r", "manoeuvre": "cruise"}
JAM_R["faults"] = [{"kind": "jam", "sites": ["r1", "r2"], "onset_s": 1.0, "amplitude_percent": 5}]
HEALTHY = {"name": "healthy", "manoeuvre": "roll_doublet"}


def test_a_rudder_is_a_fourth_site_and_disturbs_no_detector(beside):
    jam = {"kind": "jam", "sites": ["rudder"], "onset_s": 1.0, "amplitude_deg": 3.0}
    scenarios = [HEALTHY, JAM_R, {"name": "jam_rudder", "manoeuvre": "cruise", "faults": [jam]}]
    ours, assembly = rows_of(write(beside, plant="plants.py:WithRudder", scenarios=scenarios))
    assert [d.watches for d in assembly.detectors.values()] == [("r1", "r2", "r3")] * 3
    before, _ = rows_of(write(beside, scenarios=[HEALTHY, JAM_R]))
    same = ours[ours["scenario"] != "jam_rudder"].reset_index(drop=True)
    assert same.equals(before)
    rudder = ours[ours["scenario"] == "jam_rudder"]
    assert set(rudder["faulty_sites"]) == {"rudder"}
    assert set(rudder["status"]) == {"ok"}
    recorded = Flyer(assembly, "numpy").fly(
        assembly.batch(np.array([6])), ["measured:surface_deg", "truth:r_true_deg_s"]
    )
    moved = recorded.recorded["measured:surface_deg"][101, 0, 0] - recorded.recorded["measured:surface_deg"][99, 0, 0]
    assert moved == pytest.approx(3.0, abs=0.5)
    assert np.abs(recorded.recorded["truth:r_true_deg_s"][300, 0, 0]) > 0.05  # and the aircraft feels it


def test_seven_sensors_have_noise_of_their_own_and_the_first_three_theirs_as_before(beside):
    noise = {"kind": "noise", "onset_s": 1.0, "variance_deg2_s2": 4.0, "correlation": "independent"}
    noise["sites"] = [f"r{j + 1}" for j in range(7)]
    seven = write(
        beside, plant="plants.py:SevenSensors", scenarios=[{"name": "n", "manoeuvre": "cruise", "faults": [noise]}]
    )
    rows, assembly = rows_of(seven)
    assert set(rows["status"]) == {"ok"}
    shown = (
        Flyer(assembly).fly(assembly.batch(np.array([0])), ["measured:r_deg_s"]).recorded["measured:r_deg_s"][:, :, 0]
    )
    healthy, faulty = np.corrcoef(shown[:100].T), np.corrcoef(shown[101:].T)
    assert shown.shape[1] == 7
    for correlation in (healthy, faulty):
        assert np.abs(correlation - np.eye(7)).max() < 0.45
    three = read_campaign(write(beside, scenarios=[{"name": "n", "manoeuvre": "cruise"}]))
    first = assemble(three)
    alone = Flyer(first).fly(first.batch(np.array([0])), ["measured:r_deg_s"]).recorded["measured:r_deg_s"]
    assert np.array_equal(alone[0, :, 0], shown[0, :3])


def test_sites_in_deg_and_deg_s_and_newtons_stand_side_by_side(beside):
    def jam(site, **size):
        return {"name": site, "manoeuvre": "hold", "faults": [{"kind": "jam", "sites": [site], "onset_s": 1.0, **size}]}

    scenarios = [jam("gyro", amplitude_deg_s=3.0), jam("vane", amplitude_deg=4.0), jam("thruster", amplitude_n=50.0)]
    percent = {"kind": "jam", "sites": ["vane", "thruster"], "onset_s": 1.0, "amplitude_percent": 10.0}
    scenarios.append({"name": "both", "manoeuvre": "hold", "faults": [percent]})
    common = {"benchmark": "three_units.py:ThreeUnits", "detectors": ["watch_all"], "dispersions": {}}
    rows, assembly = rows_of(write(beside, scenarios=scenarios, **common))
    assert rows["declared_sites"].tolist() == ["gyro", "vane", "thruster", "vane+thruster"]
    assert rows["detection_time_limit_s"].tolist() == [2.0, 3.0, 4.0, 3.0]
    batch = assembly.batch(np.array([3]))
    shown = Flyer(assembly).fly(batch, ["measured:vane_deg", "measured:thrust_n"]).recorded
    assert shown["measured:vane_deg"][-1, 0, 0] == 2.0 + 2.5
    assert shown["measured:thrust_n"][-1, 0, 0] == 100.0 + 100.0
    mixed = {**percent, "amplitude_deg": 1.0}
    del mixed["amplitude_percent"]
    with pytest.raises(CampaignError, match=r"vane, thruster have different units .deg, N.: give sizes in percent"):
        read_campaign(write(beside, scenarios=[{"name": "m", "manoeuvre": "hold", "faults": [mixed]}], **common))


def test_actuators_in_deg_and_n_have_every_fault_alike_in_compiled_code(beside):
    def broken(name, site, **fault):
        return {"name": name, "manoeuvre": "hold", "faults": [{"sites": [site], "onset_s": 1.0, **fault}]}

    scenarios = [
        broken("half", "thruster", kind="effectiveness", loss_percent={"uniform": [5.0, 50.0]}),
        broken("loose", "vane", kind="disconnection", lag_s={"grid": [0.05, 0.2]}),
        broken("solid", "vane", kind="oscillatory", mode="replace", amplitude_deg=1.0, frequency_hz=2.5),
        broken("liquid", "thruster", kind="oscillatory", amplitude_n=30.0, frequency_hz=2.5),
        broken("runaway", "vane", kind="runaway", rate_deg_s=8.0),
        broken("frozen", "thruster", kind="jam", mode="replace", freeze=True),
        broken("idle", "thruster", kind="jam", mode="replace", hold_value_n=6.0),
        broken("bias", "thruster", kind="bias", amplitude_n=-20.0),
    ]
    runs = {"monte_carlo": {"runs": 1}}
    common = {"benchmark": "three_units.py:ThreeUnits", "detectors": ["watch_all"], "dispersions": runs}
    assembly = assemble(read_campaign(write(beside, scenarios=scenarios, **common)))
    batch, names = assembly.batch(np.arange(assembly.plan.n_cases)), ["measured:vane_deg", "measured:thrust_n"]
    compiled, plain = (Flyer(assembly, backend).fly(batch, names).recorded for backend in ("compiled", "numpy"))
    for name in names:
        assert compiled[name].tobytes() == plain[name].tobytes()
    vane_deg, thrust_n = (plain[name][:, 0] for name in names)
    assert 50.0 < thrust_n[-1, 0] < 95.0
    assert (vane_deg[100, 1:3] < 2.0).all()
    assert vane_deg[110, 3] == pytest.approx(1.0)
    assert thrust_n[[110, 130], 4] == pytest.approx([130.0, 70.0])
    assert vane_deg[[125, -1], 5] == pytest.approx([4.0, 25.0])
    assert thrust_n[-1, 6:].tolist() == [100.0, 6.0, 80.0]


def test_distorted_and_played_sensors_are_alike_in_compiled_code(beside):
    def broken(name, **fault):
        return {
            "name": name,
            "manoeuvre": "hold",
            "faults": [{"kind": name, "sites": ["vane"], "onset_s": 0.5, **fault}],
        }

    (beside / "rec.csv").write_text("time_s,value_deg\n0,1\n0.1,2\n0.25,-1\n")
    scenarios = [
        broken("spike", amplitude_deg=1.0, width_s=0.02, period_s={"grid": [0.1, 0.25]}),
        broken("stuck_bit", bit={"grid": [0, 3, 5]}, value=1, quantum_deg=0.05),
        broken("stale", every_samples={"grid": [3, 10]}),
        broken("scale_factor", scale_factor_percent={"uniform": [-20.0, 20.0]}),
        broken("latency", latency_s={"uniform": [0.0, 0.2]}),
        broken("quantisation", quantum_deg=0.3),
        broken("series", file="rec.csv", after="repeat", start="uniform", gain={"grid": [1.0, -2.0]}),
    ]
    common = {"benchmark": "three_units.py:ThreeUnits", "detectors": ["watch_all"]}
    common["dispersions"] = {"monte_carlo": {"runs": 2}}
    assembly = assemble(read_campaign(write(beside, scenarios=scenarios, **common)))
    batch = assembly.batch(np.arange(assembly.plan.n_cases))
    compiled, plain = (Flyer(assembly, e).fly(batch, ["measured:vane_deg"]).recorded for e in ("compiled", "numpy"))
    assert compiled["measured:vane_deg"].tobytes() == plain["measured:vane_deg"].tobytes()
    only = assemble(read_campaign(write(beside, scenarios=[broken("latency", latency_s=0.1)], **common)))
    batch = only.batch(np.arange(2))
    compiled, plain = (Flyer(only, e).fly(batch, ["measured:vane_deg"]).recorded for e in ("compiled", "numpy"))
    assert compiled["measured:vane_deg"].tobytes() == plain["measured:vane_deg"].tobytes()


def test_a_benchmark_a_fault_and_a_detector_come_from_files_beside_the_campaign():
    rows, _ = rows_of(BESIDE / "own.yaml")
    assert set(rows["status"]) == {"ok"}
    assert set(rows["fault"].dropna()) == {"bias", "sawtooth"}
    for file, most in (("short_period.py", 60), ("sawtooth.py", 25)):
        assert len((BESIDE / file).read_text(encoding="utf-8").splitlines()) <= most
    testing.check_benchmark("short_period.py:ShortPeriod", beside=BESIDE)
    testing.check_fault("sawtooth.py:Sawtooth", {"amplitude_percent": 1.0, "period_s": 0.1}, beside=BESIDE)
    testing.check_voter("mean.py:Mean", beside=BESIDE)


def test_a_sawtooth_is_its_closed_form(beside):
    teeth = {"kind": "sawtooth.py:Sawtooth", "sites": ["r1"], "onset_s": 1.0, "amplitude_deg_s": 2.0, "period_s": 0.5}
    scenario = {"name": "t", "manoeuvre": "cruise", "faults": [teeth]}
    assembly = assemble(read_campaign(write(beside, sensors="ideal", voter="mean.py:Mean", scenarios=[scenario])))
    names = ["measured:r_deg_s", "truth:r_true_deg_s", "measured:r_voted_deg_s"]
    shown = Flyer(assembly).fly(assembly.batch(np.array([0])), names).recorded
    time_s = np.arange(401) * 0.01 - 1.0
    expected = np.where(time_s >= 0.0, 2.0 * ((time_s / 0.5) % 1.0), 0.0)
    added = shown["measured:r_deg_s"][:, 0, 0] - shown["truth:r_true_deg_s"][:, 0, 0]
    near = np.abs((time_s / 0.5 + 0.5) % 1.0 - 0.5) < 1e-9  # on a tooth's edge rounding decides
    np.testing.assert_allclose(added[~near], expected[~near], atol=1e-9)
    mean = shown["measured:r_deg_s"][:, :, 0].mean(axis=1)
    np.testing.assert_allclose(shown["measured:r_voted_deg_s"][:, 0, 0], mean, atol=1e-12)


def test_a_second_plant_is_chosen_by_name(beside):
    published, _ = rows_of(write(beside, scenarios=[HEALTHY]))
    weak, _ = rows_of(write(beside, plant="plants.py:WeakFin", scenarios=[HEALTHY]))
    delta = {
        "sequence": {"delta_c_n_percent": [-20.0]},
        "monte_carlo": {"runs": 3, "mass_kg": {"uniform": [180000, 220000]}},
    }
    same, _ = rows_of(write(beside, scenarios=[HEALTHY], dispersions=delta))
    assert weak["margin_healthy"].tolist() == same["margin_healthy"].tolist()
    assert weak["margin_healthy"].tolist() != published["margin_healthy"].tolist()
    with pytest.raises(
        CampaignError, match=r"no plant of benchmark 'yaw_rate' is called 'nonsense'. Known: lateral_lpv"
    ):
        read_campaign(write(beside, plant="nonsense", scenarios=[HEALTHY]))


def test_a_new_choice_is_added_in_one_place(beside, monkeypatch):
    heavy = Choice(about="how heavy", options={"light": 0.0, "heavy": 1.0})
    monkeypatch.setattr(YawRate, "choices", {**YawRate.choices, "load": heavy})
    path = write(beside, load="heavy", scenarios=[HEALTHY])
    campaign = read_campaign(path)
    assert campaign.chosen["load"] == 1.0
    assert campaign.choices["load"] == "heavy"
    with pytest.raises(CampaignError, match="no load of benchmark 'yaw_rate' is called 'heavi'. Did you mean 'heavy'"):
        read_campaign(write(beside, load="heavi", scenarios=[HEALTHY]))


def test_every_fault_kind_flies_on_a_site_of_every_unit(tmp_path):
    base = {"bias": {"amplitude": 1}, "jam": {"amplitude": 1}, "runaway": {"rate": 2}, "noise": {"variance": 1}}
    base |= {
        "drift": {"rate": 1, "amplitude": 2},
        "nrz": {"amplitude": 1},
        "oscillatory": {"amplitude": 1, "frequency_hz": 3},
        "effectiveness": {"loss_percent": 30},
        "disconnection": {},
        "scale_factor": {"scale_factor_percent": 3},
        "quantisation": {"quantum": 0.1},
        "stuck_bit": {"bit": 3, "value": 1, "quantum": 0.1},
        "stale": {"every_samples": 3},
        "latency": {"latency_s": 0.03},
        "spike": {"amplitude": 1, "width_s": 0.02},
        "series": {"file": "rec.csv"},
    }
    assert set(base) == set(kinds.known("fault"))
    for unit in ("deg", "N", ""):
        suffix = {"deg": "_deg", "N": "_n", "": ""}[unit]
        (tmp_path / "rec.csv").write_text(f"time_s,value{suffix}\n0,1\n0.1,2\n")
        for kind, sizes in base.items():
            keys = {"amplitude": {"deg": "amplitude_deg", "N": "amplitude_n", "": "amplitude"}[unit]}
            keys["quantum"] = keys["amplitude"].replace("amplitude", "quantum")
            keys["rate"] = {"deg": "rate_deg_s", "N": "rate_n_s", "": "rate_per_s"}[unit]
            keys["variance"] = {"deg": "variance_deg2", "N": "variance_n2", "": "variance"}[unit]
            own = {keys.get(size, size): value for size, value in sizes.items()}
            testing.check_fault(kind, own, unit=unit, beside=tmp_path)
