"""Contract: where a campaign says so the aircraft acts on what one detector declared at the sample before, on nobody else."""

import json
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from tests.runner.test_same_bits import bits

from fddbench import gallery, load, testing
from fddbench.api.checking import described
from fddbench.api.flights import score, signals
from fddbench.api.pages import report
from fddbench.blocks import kernel, llvm
from fddbench.campaign.load import read_campaign
from fddbench.errors import CampaignError
from fddbench.runner.assembling import assemble
from fddbench.runner.flight import Flyer
from fddbench.runner.rehearsal import rehearsed
from fddbench.runner.replay import replay_campaign
from fddbench.runner.rows import rows_and_events
from fddbench.runner.run import run_campaign

BESIDE = Path(__file__).parent.parent / "probes" / "beside"
BIAS = {"kind": "bias", "sites": ["first"], "onset_s": 1.0, "amplitude_deg": 3.0}
SCENARIOS = [
    {"name": "healthy", "manoeuvre": "hold", "duration_s": 2.0},
    {"name": "bias", "manoeuvre": "hold", "faults": [BIAS]},
    {
        "name": "spare",
        "manoeuvre": "hold",
        "faults": [{**BIAS, "sites": ["spare"], "amplitude_deg": {"uniform": [0.9, 4]}}],
    },
    {
        "name": "leaves",
        "manoeuvre": "hold",
        "faults": [{**BIAS, "kind": "drift", "amplitude_deg": 30.0, "rate_deg_s": 15.0}],
    },
]
NAMES = ["measured:level_deg", "truth:level_true_deg", "truth:used", "added", "departed"]


@pytest.fixture
def write(tmp_path):
    """Write a campaign on the benchmark with a spare sensor, beside its files."""
    for file in (BESIDE / "standby.py", *(BESIDE / "detectors").glob("*")):
        target = tmp_path / file.relative_to(BESIDE)
        target.parent.mkdir(exist_ok=True)
        if file.is_file():
            shutil.copy(file, target)

    def _write(detectors=("band",), reconfigure="band", gains=None, **content):
        for name, own in (gains or {}).items():
            path = tmp_path / "detectors" / f"{name}.yaml"
            design = yaml.safe_load(path.read_text(encoding="utf-8")) | {"gains": own}
            path.write_text(yaml.safe_dump(design), encoding="utf-8")
        path = tmp_path / "campaign.yaml"
        base = {
            "name": "probe",
            "benchmark": "standby.py:Standby",
            "seed": 5,
            "duration_s": 3.0,
            "detectors": list(detectors),
        }
        base["dispersions"] = {"monte_carlo": {"runs": 3, "gain_per_s": {"uniform": [3.0, 4.0]}}}
        base |= {"scenarios": SCENARIOS, "reconfigure": reconfigure, **content}
        base = {key: value for key, value in base.items() if value is not None}
        path.write_text(json.dumps(base, indent=1), encoding="utf-8")
        return path

    return _write


def assembled(path):
    return assemble(read_campaign(path))


def recorded(assembly, backend="auto", cases=None):
    cases = np.arange(assembly.plan.n_cases) if cases is None else np.array(cases)
    return Flyer(assembly, backend).fly(assembly.batch(cases), NAMES).recorded


def rows_of(assembly, backend="auto", flyer=None):
    flyer = Flyer(assembly, backend) if flyer is None else flyer
    return rows_and_events(flyer, np.arange(assembly.plan.n_cases))[0].to_pandas(types_mapper=pd.ArrowDtype)


def of(rows, detector):
    return rows[rows["detector"] == detector].reset_index(drop=True)


@pytest.mark.parametrize("backend", ["auto", "numpy"])
def test_the_aircraft_acts_from_the_next_sample_on(write, backend):
    cases = range(3, 6)
    acting = recorded(assembled(write()), backend, cases)
    idle = recorded(assembled(write(reconfigure=None)), backend, cases)
    used, level = acting["truth:used"][:, 0], acting["truth:level_true_deg"][:, 0]
    assert (used[:101] == 0.0).all()  # the fault is there and declared at sample 100
    assert (used[101:] == 1.0).all()
    assert np.abs(level[-1]).max() < 0.05
    np.testing.assert_allclose(
        idle["truth:level_true_deg"][-1, 0], -3.0, atol=0.05
    )  # it has flown after the wrong sensor
    for name in NAMES:
        np.testing.assert_array_equal(acting[name][:101], idle[name][:101])


@pytest.mark.skipif(not llvm.available(), reason="llvmlite is not installed")
def test_lanes_company_interpreter_and_plain_numpy_give_the_same_bits(write):
    assembly = assembled(write(["band", "no_number"]))
    batch = assembly.batch(np.arange(assembly.plan.n_cases))
    fused = Flyer(assembly).fused
    state, constants = fused.packed(batch)
    samples = assembly.ends(batch).astype(np.int64) + 1
    where = kernel.Addresses(key=5, run=batch.run, flight=assembly.plan.stream, scenario=batch.scenario_stream)
    ways = [{"backend": "numpy"}, *({"backend": "llvm", "lanes": n} for n in (1, 4, 16))]
    ends = []
    for way in ways:
        built = kernel.build(fused.program(), streams=fused.draws.streams, merge=fused.merge_keys(), **way)
        ends.append(built.fly(state, constants, samples, where, first=0, end=int(samples.max())).state)
    for end in ends[1:]:
        np.testing.assert_array_equal(end, ends[0])
    compiled, plain = (recorded(assembly, way) for way in ("llvm", "numpy"))
    alone = recorded(assembly, "llvm", [7])
    for name in NAMES:
        np.testing.assert_array_equal(compiled[name], plain[name], err_msg=name)
        np.testing.assert_array_equal(compiled[name][: len(alone[name]), :, 7], alone[name][..., 0], err_msg=name)
    assert bits(rows_of(assembly, "llvm")) == bits(rows_of(assembly, "numpy"))


def test_flights_that_depart_do_so_for_everybody(write):
    rows = rows_of(assembled(write(["band", "plain_band"], "band", {"band": {"limit_deg": 20.0}})))
    gone = rows[rows["scenario"] == "leaves"]
    assert gone["departed_s"].notna().all()
    assert gone.groupby("run")["departed_s"].nunique().eq(1).all()
    saved = rows_of(assembled(write(gains={"band": {"limit_deg": 1.0}})))
    assert saved["departed_s"].isna().all()  # acting in time, it stays


def test_ordinary_python_commands_as_compiled_code_does(write):
    by_rows = assembled(write(["band", "plain_band"], "band"))
    by_python = assembled(write(["band", "plain_band"], "plain_band"))
    assert Flyer(by_rows).compiled == llvm.available()
    assert not Flyer(by_python, "llvm" if llvm.available() else "auto").compiled
    assert bits(rows_of(by_rows)) == bits(rows_of(by_python))


@pytest.mark.parametrize("commander", ["band", "plain_band"])
def test_another_detector_changes_no_row(write, commander):
    before = rows_of(assembled(write([commander], commander)))
    more, many = ["many_at_once", "alarm_only", "spare_only", commander], {"limit_deg": 2.0}
    sound = of(rows_of(assembled(write(more, commander, {"many_at_once": many}))), "many_at_once")
    raising = assembled(write(more, commander, {"many_at_once": many | {"raises_above_deg": 3.2}}))
    for backend in ("auto", "numpy"):
        rows = rows_of(raising, backend)
        assert bits(of(rows, commander)) == bits(before)
        found = of(rows, "many_at_once")
        assert found["reason"].dropna().str.contains("ValueError: too much").all()
        # where it did not raise it was flown again in smaller company, on the same aircraft
        flown = (found["status"] == "ok").to_numpy(dtype=bool)
        assert 0 < flown.sum() < len(flown)
        assert bits(found[flown]) == bits(sound[flown])


def test_jobs_and_chunks_change_no_bit_and_a_replay_shows_the_same_flight(write, tmp_path):
    campaign = read_campaign(write(["plain_band", "band"], "plain_band", scenarios=SCENARIOS[1:3]))
    run_campaign(campaign, tmp_path / "one", jobs=1)
    run_campaign(campaign, tmp_path / "two", jobs=1, chunk=3)
    assert bits(load(tmp_path / "one")) == bits(load(tmp_path / "two"))
    again = signals(tmp_path / "one", "bias", ["bias/0/0/2"])
    whole = next(iter(replay_campaign(campaign, scenarios=["bias"])))
    np.testing.assert_array_equal(again.signals["used"][:, 0], whole.signals["used"][:, 2])
    assert again.signals["used"][-1, 0] == 1.0
    assert again.detectors["plain_band"]["n_declared"][100, 0] == 1.0


@pytest.mark.parametrize("commander", ["band", "plain_band"])
def test_declarations_of_ones_own_are_scored_on_the_flight_that_the_commander_makes(write, commander):
    campaign = read_campaign(write([commander], commander, scenarios=SCENARIOS[1:2]))
    shown = signals(campaign, "bias")
    assert (shown.detectors[commander]["n_declared"] <= 1.0).all()
    declared = np.stack([shown.detectors[commander]["n_declared"], 0.0 * shown.signals["used"]], axis=1)
    own = score(campaign, shown.cases, declared, residual=shown.detectors[commander]["residual"], name=commander)
    rows = rows_of(assemble(campaign))
    assert bits(own[rows.columns]) == bits(rows)


def test_sites_that_a_detector_does_not_watch_are_never_declared_to_the_aircraft(write):
    found = recorded(assembled(write(["spare_only"], "spare_only")), cases=range(3, 6))
    assert (found["truth:used"] == 0.0).all()
    np.testing.assert_allclose(found["truth:level_true_deg"][-1, 0], -3.0, atol=0.05)


def test_what_is_no_number_declares_nothing(write):
    assembly = assembled(write(["no_number", "band"], "no_number"))
    rows = rows_of(assembly)
    bias = rows[rows["scenario"] == "bias"]
    assert set(of(bias, "no_number")["status"]) == {"nonfinite"}
    assert set(of(bias, "band")["status"]) == {"ok"}
    assert (recorded(assembly, cases=range(3, 6))["truth:used"] == 0.0).all()


def test_a_detector_that_declares_nothing_leaves_every_bit(write):
    silent = {"band": {"limit_deg": 1e6}}
    acting, idle = (assembled(write(["band"], name, silent)) for name in ("band", None))
    assert bits(rows_of(acting)) == bits(rows_of(idle))
    assert acting.plan.campaign.sha256 != idle.plan.campaign.sha256
    assert Flyer(idle).fused.states.size + 2 == Flyer(acting).fused.states.size
    nothing = assembled(write(["band"], None, silent, seed=5))
    assert Flyer(nothing).fused.program().hash == Flyer(idle).fused.program().hash


@pytest.mark.parametrize("backend", ["auto", "numpy"])
def test_where_the_commander_raises_nobody_is_scored(write, backend):
    gains = {"plain_band": {"limit_deg": 1.0, "raises_above_deg": 3.2}}
    rows = rows_of(assembled(write(["band", "plain_band", "many_at_once"], "plain_band", gains)), backend)
    for _, flight in rows.groupby("case" if "case" in rows else ["scenario", "run"]):
        by = flight.set_index("detector")
        if by.loc["plain_band", "status"] == "ok":
            assert set(by["status"]) == {"ok"}
            continue
        assert set(by["status"]) == {"error"}
        assert by["outcome"].isna().all()
        own = by.loc["plain_band", "reason"]
        assert own.startswith("ValueError: too much")
        assert set(by["reason"]) == {own, f"the aircraft acts on plain_band, which ended with: {own}"}
    assert set(rows["status"]) == {"ok", "error"}


def test_a_commander_that_always_fails_is_given_up_and_all_with_it(write):
    told = []
    gains = {"plain_band": {"limit_deg": 1.0, "raises_above_deg": 0.02}}
    assembly = assembled(write(["band", "plain_band"], "plain_band", gains))
    flyer = rehearsed(Flyer(assembly), told.append)
    assert any("the aircraft acts on it, so nothing is flown and all rows are `error`" in line for line in told)
    rows = rows_of(assembly, flyer=flyer)
    assert set(rows["status"]) == {"error"}
    assert "the aircraft acts on plain_band, which ended with: given up" in of(rows, "band")["reason"].iloc[-1]


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("alarm_only", "it only detects and declares no site. Of this campaign it can act on: band"),
        ("many_at_once", r"it cannot be compiled and flies many flights side by side.*without `batched = True`"),
    ],
)
def test_refuses_a_detector_on_which_nothing_can_act(write, name, reason):
    with pytest.raises(CampaignError, match=rf"campaign.yaml:\d+:\d+: no aircraft can act on '{name}': {reason}"):
        assembled(write(["band", name], name))


def test_refuses_a_benchmark_that_cannot_act(write):
    path = write(["hinf_final"], "hinf_final", benchmark="jet_engine", dispersions={}, scenarios=[
        {"name": "healthy", "manoeuvre": "steps"}
    ])  # fmt: skip
    with pytest.raises(
        CampaignError, match=r"campaign.yaml:\d+:\d+: benchmark 'jet_engine' with .* cannot act on what"
    ):
        assembled(path)


def test_check_and_the_page_say_on_whom_the_aircraft_acts(write, tmp_path):
    path = write(["plain_band"], "plain_band", scenarios=SCENARIOS[:1], dispersions=None)
    text = described(path)
    assert "The aircraft acts on what plain_band declares, from the next sample on" in text
    assert "with the aircraft that acts on it" in " ".join(text.split())
    run_campaign(read_campaign(path), tmp_path / "out", jobs=1)
    page = report(tmp_path / "out").read_text(encoding="utf-8")
    assert "<dt>reconfigure</dt><dd>plain_band</dd>" in page


def test_the_key_may_be_taken_away_from_the_command_line(write):
    path = write(["band", "plain_band"], "band")
    assert read_campaign(path, ["reconfigure=null"]).reconfigure == ""
    assert read_campaign(path, ["reconfigure=plain_band"]).reconfigure == "plain_band"


def test_a_loop_that_reconfigures_is_checked(tmp_path):
    testing.check_benchmark("standby.py:Standby", beside=BESIDE)
    text = (BESIDE / "standby.py").read_text(encoding="utf-8")
    sound = "used = np.zeros_like(x.level) if declared is None else declared[0]"
    assert sound in text
    wrong = {
        "used = np.ones_like(x.level) if declared is None else declared[0]": "differs between declared=None and rows of zeros",
        "used = abs(0.0 * x.level) if declared is None else declared.sum() + abs(0.0 * x.level)": "depends on which flights",
    }
    for line, message in wrong.items():
        (tmp_path / "standby.py").write_text(text.replace(sound, line), encoding="utf-8")
        with pytest.raises(AssertionError, match=message):
            testing.check_benchmark("standby.py:Standby", beside=tmp_path)


def test_open_loop_hands_nothing_over_and_says_so():
    campaign = gallery.folder("campaigns") / "b747_reconfiguration.yaml"
    with pytest.raises(CampaignError, match="law open_loop.*cannot act on what a detector declares"):
        assemble(read_campaign(campaign, ["law=open_loop"]))
