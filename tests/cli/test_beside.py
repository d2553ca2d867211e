"""Kinds of one's own in files beside a campaign, for every family; what they stand on travels with the results."""

import json
import shutil
import subprocess
import sysconfig
from pathlib import Path

import numpy as np
import pytest
import yaml

from fddbench import gallery, load
from fddbench.campaign.load import read_campaign
from fddbench.cli import main
from fddbench.runner.replay import replay

PROBES = Path(__file__).parents[1] / "probes" / "beside"

PLANT = """\
from constants import DURATION_S
from fddbench.benchmarks.yaw_rate.plants.lateral_lpv import LateralLpvPlant

class Mine(LateralLpvPlant):
    \"\"\"The shipped aircraft, which only cruises.\"\"\"
    manoeuvres = {"cruise": DURATION_S}
"""
PARTS = """\
from pathlib import Path
from fddbench.benchmarks.yaw_rate.sensors import Noise
from fddbench.flight.turbulence import LateralGust

SIGMA = float((Path(__file__).parent / "sigma.txt").read_text())
quiet = Noise(r_deg_s=0.001, beta_deg=0.0, p_deg_s=0.0, phi_deg=0.0)
breeze = LateralGust(SIGMA)
"""
CAMPAIGN = """\
name: mine
benchmark: yaw_rate
plant: plant.py:Mine
voter: mean.py:Mean
sensors: parts.py:quiet
wind: parts.py:breeze
seed: 4
detectors: [voting_monitor]
scenarios:
  - {name: healthy, manoeuvre: cruise}
  - name: teeth
    manoeuvre: cruise
    duration_s: 4.0
    faults: [{kind: "sawtooth.py:Sawtooth", sites: [r1], onset_s: 1.0, amplitude_deg_s: 3, period_s: 0.5}]
"""


@pytest.fixture
def beside(tmp_path, monkeypatch):
    """Folder of a campaign with files of its own for every choice of the yaw-rate benchmark."""
    folder = tmp_path / "work"
    shutil.copytree(PROBES, folder)
    (folder / "plant.py").write_text(PLANT)
    (folder / "constants.py").write_text("DURATION_S = 3.0\n")
    (folder / "parts.py").write_text(PARTS)
    (folder / "sigma.txt").write_text("0.5\n")
    (folder / "mine.yaml").write_text(CAMPAIGN)
    monkeypatch.chdir(folder)
    return folder


def fly(campaign, *options):
    return main(["run", campaign, "--quiet", "--jobs", "1", "--out", "../out", *options])


def kept(folder):
    """Files of a folder of results that came with the campaign."""
    listed = json.loads((folder / "provenance.json").read_text())["files"]
    assert all((folder / name).is_file() for name in listed)
    return set(listed)


def test_every_choice_may_come_from_a_file(beside, capsys):
    assert main(["check", "mine.yaml"]) == 0
    chosen = "plant plant.py:Mine, voter mean.py:Mean, sensors parts.py:quiet, wind parts.py:breeze"
    assert f"Benchmark yaw_rate, {chosen}\n" in capsys.readouterr().out
    assert fly("mine.yaml") == 0
    out = beside.parent / "out"
    own = {"plant.py", "constants.py", "mean.py", "parts.py", "sigma.txt", "sawtooth.py"}
    assert kept(out) == own | {"detectors/voting_monitor.yaml"}
    shutil.rmtree(beside)  # nothing beside the results is needed any more
    healthy, teeth = replay(out)
    assert healthy.time_s[-1] == 3.0
    rates = [teeth.signals[f"r_deg_s_{j}"][:, 0] for j in (1, 2, 3)]
    np.testing.assert_array_equal(teeth.signals["r_voted_deg_s"][:, 0], (rates[0] + rates[1] + rates[2]) / 3.0)
    since = teeth.time_s - 1.0
    tooth = np.where(since >= 0.0, 3.0 * (since / 0.5 - np.floor(since / 0.5 + 1e-9)), 0.0)
    assert np.abs(rates[0] - rates[1] - tooth)[since % 0.5 > 0.015].max() < 0.01
    assert 0.0 < np.abs(teeth.signals["gust_m_s"]).max() < 3.0
    assert set(load(out)["fault"].dropna()) == {"sawtooth"}


def test_a_benchmark_and_a_detector_that_only_detects_from_files(beside):
    assert fly("own.yaml") == 0
    rows = load("../out")
    assert set(rows["status"]) == {"ok"}
    assert set(rows["n_declared"]) == {0}
    assert (rows[rows["scenario"] == "bias"]["margin_faulty"] > 3.0).all()
    assert (rows["margin_healthy"] < 1.0).all()
    assert rows["p_gain_ratio"].nunique() == 20
    assert fly("own.yaml", "--fresh", "--backend", "numpy", "--jobs", "2") == 0
    assert load("../out").equals(rows)


def test_the_results_alone_are_enough_for_a_page(beside, capsys):
    assert fly("own.yaml") == 0
    moved = beside.parent / "elsewhere" / "kept"
    moved.parent.mkdir()
    (beside.parent / "out").rename(moved)
    shutil.rmtree(beside)
    assert main(["report", str(moved)]) == 0
    assert "difference.py:Difference" in (moved / "report.html").read_text(encoding="utf-8")
    assert main(["scores", str(moved)]) == 0
    recording = next(iter(replay(moved, signals=("q_deg_s_1", "q_true_deg_s"))))
    assert set(recording.signals) == {"q_deg_s_1", "q_deg_s_2", "q_true_deg_s"}


@pytest.mark.parametrize("name", ["constants.py", "sigma.txt", "mean.py", "sawtooth.py"])
def test_another_file_beside_is_another_campaign(beside, capsys, name):
    assert fly("mine.yaml") == 0
    path = beside / name
    before = path.read_text()
    path.write_text(before + "\n")
    assert fly("mine.yaml") == 2
    assert "out holds results of another campaign" in capsys.readouterr().err
    path.write_text(before)
    assert fly("mine.yaml") == 0
    assert "0 flights flown, 2 found done" in capsys.readouterr().out


def test_a_file_changed_in_the_results_is_found(beside, capsys):
    assert fly("mine.yaml") == 0
    (beside.parent / "out" / "constants.py").write_text("DURATION_S = 2.0\n")
    assert main(["report", "../out"]) == 2
    assert "Run the campaign again on this folder" in capsys.readouterr().err
    assert fly("mine.yaml") == 0
    assert main(["report", "../out"]) == 0


def test_fresh_leaves_nothing_of_the_files_before(beside):
    assert fly("mine.yaml") == 0
    assert fly("own.yaml", "--fresh") == 0
    assert not (beside.parent / "out" / "plant.py").exists()
    assert kept(beside.parent / "out") >= {"short_period.py", "sawtooth.py"}


NET = """\
from pathlib import Path
import numpy as np
from pydantic import BaseModel
from fddbench.blocks.layout import Layout, Rows, record
from fddbench.blocks.linear import largest
from fddbench.interfaces import Verdict
from helper import GAIN
W = np.load(Path(__file__).parent / "weights.npy")
class Gains(BaseModel):
    limit: float
@record
class Declared:
    declared: Rows
class Net:
    about, recorded, Gains = "net", (), Gains
    states = Layout(Declared(declared=3))
    def __init__(self, limit): self.limit = limit
    @classmethod
    def from_design(cls, gains, bus): return cls(gains.limit)
    def start(self): return Declared(declared=0.0)
    def step(self, x, m):
        r = np.abs(m.r_deg_s - m.r_voted_deg_s) * (GAIN * float(W[0]))
        declared = np.where(r > self.limit, 1.0, x.declared)
        return Declared(declared=declared), Verdict(declared, largest(r) / self.limit)
"""
TINY = """\
name: net
benchmark: yaw_rate
seed: 1
duration_s: 2.0
detectors: [net]
scenarios:
  - {name: healthy, manoeuvre: cruise}
  - {name: jam, manoeuvre: cruise, faults: [{kind: jam, sites: [r1], onset_s: 1.0, amplitude_deg_s: 2}]}
"""


@pytest.fixture
def net(tmp_path, monkeypatch):
    """A detector with weights and a helper module beside it; its folder."""
    folder = tmp_path / "work" / "detectors"
    folder.mkdir(parents=True)
    (folder / "net.py").write_text(NET)
    (folder / "helper.py").write_text("GAIN = 1.0\n")
    np.save(folder / "weights.npy", np.array([1.0]))
    (folder / "net.yaml").write_text("kind: net.py:Net\nsource: me\ntuned_on: null\ngains: {limit: 0.3}\n")
    (folder.parent / "net.yaml").write_text(TINY)
    monkeypatch.chdir(folder.parent)
    return folder


def test_weights_and_helpers_of_a_detector_travel(net, capsys):
    assert fly("net.yaml") == 0
    out = net.parent.parent / "out"
    beside = {f"detectors/{name}" for name in ("net.yaml", "net.py", "helper.py", "weights.npy")}
    assert kept(out) == beside
    rows = load(out)
    for name, content in (("weights.npy", None), ("helper.py", "GAIN = 2.0\n")):
        before = (net / name).read_bytes()
        np.save(net / name, np.array([2.0])) if content is None else (net / name).write_text(content)
        assert fly("net.yaml") == 2
        message = capsys.readouterr().err
        assert ("the file detectors/weights.npy is not the same" if content is None else "+GAIN = 2.0") in message
        assert fly("net.yaml", "--out", f"../{name}") == 0
        other = load(f"../{name}")  # twice as sensitive: what was read again is what flew
        np.testing.assert_allclose(other["margin_healthy"].astype(float), 2.0 * rows["margin_healthy"].astype(float))
        (net / name).write_bytes(before)
    shutil.rmtree(net)
    capsys.readouterr()
    assert main(["report", "../out"]) == 0


LATE = NET.replace('W = np.load(Path(__file__).parent / "weights.npy")\n', "W = [1.0]\n").replace(
    "return cls(gains.limit)",
    'return cls(gains.limit * float(np.load(Path(__file__).parent / "weights.npy")[0]))',
)


def test_what_is_read_later_must_be_declared(net, capsys):
    (net / "net.py").write_text(LATE)
    for command in ("check", "run"):
        assert main([command, "net.yaml"]) == 2
        message = capsys.readouterr().err
        assert "net.yaml:5:13: design 'net' (detectors/net.yaml): it reads weights.npy beside it" in message
        assert "FILES = ('weights.npy',)" in message
    assert not Path("results").exists()
    (net / "net.py").write_text(f"FILES = ('weights.npy',)\n{LATE}")
    assert fly("net.yaml") == 0
    assert "detectors/weights.npy" in kept(net.parent.parent / "out")
    shutil.rmtree(net)
    assert main(["report", "../out"]) == 0


@pytest.mark.parametrize(
    ("files", "message"),
    [
        ("'weights.npy'", "net.py: FILES is a tuple of file names beside it, got 'weights.npy'"),
        ("(1,)", "FILES is a tuple of file names beside it, got (1,)"),
        ("('gone.npy',)", "declares the file 'gone.npy', which is not in"),
        ("('../net.yaml',)", "declares the file '../net.yaml', which is not in"),
    ],
)
def test_declarations_that_are_none(net, capsys, files, message):
    (net / "net.py").write_text(f"FILES = {files}\n{NET}")
    assert main(["check", "net.yaml"]) == 2
    error = capsys.readouterr().err
    assert error.startswith("fddbench: detectors/net.yaml:1:7: ")
    assert message in error


def test_a_benchmark_declares_what_it_reads_later(beside, capsys):
    path = beside / "short_period.py"
    text = path.read_text()
    path.write_text(
        text.replace("        return Loop(options)", '        open("own.txt").close()\n        return Loop(options)')
    )
    (beside / "own.txt").write_text("x")
    assert main(["check", "own.yaml"]) == 2
    assert "benchmark 'short_period.py:ShortPeriod' reads own.txt beside the campaign" in capsys.readouterr().err
    path.write_text(path.read_text() + '\nFILES = ("own.txt",)\n')
    assert main(["check", "own.yaml"]) == 0
    assert fly("own.yaml") == 0
    assert "own.txt" in kept(beside.parent / "out")


def test_names_that_results_need_are_refused(beside, capsys):
    (beside / "manifest.jsonl").write_text("")
    (beside / "mean.py").write_text((beside / "mean.py").read_text() + '\nFILES = ("manifest.jsonl",)\n')
    assert main(["check", "mine.yaml"]) == 2
    assert "mine.yaml:1:1: the file manifest.jsonl beside the campaign has a name that" in capsys.readouterr().err


def test_two_files_of_one_text_both_travel(net):
    """Plug-ins are remembered by their text; each keeps the name it has."""
    (net / "twin.py").write_text(NET)
    (net / "twin.yaml").write_text((net / "net.yaml").read_text().replace("net.py", "twin.py"))
    assert fly("net.yaml", "--set", "detectors=[net, twin]") == 0
    assert {"detectors/net.py", "detectors/twin.py"} <= kept(net.parent.parent / "out")
    assert main(["report", "../out"]) == 0


@pytest.mark.parametrize("options", [["--backend", "numpy", "--jobs", "2"], ["--jobs", "1"]])
@pytest.mark.slow
def test_files_called_as_modules_of_python_are_no_trouble(tmp_path, options):
    """Started beside them too, where workers that put the working folder first would take them for Python's."""
    names = ("random", "numpy", "types", "signal")
    folder = tmp_path / "detectors"
    folder.mkdir()
    example = gallery.folder("detectors") / "cusum_example.py"
    design = example.with_suffix(".yaml").read_text()
    for name in names:
        shutil.copyfile(example, folder / f"{name}.py")
        (folder / f"{name}.yaml").write_text(design.replace("cusum_example.py", f"{name}.py"))
    (tmp_path / "a.yaml").write_text(TINY.replace("[net]", f"[{', '.join(names)}]").replace("2.0", "1.2"))
    command = [str(Path(sysconfig.get_path("scripts")) / "fddbench"), "run", "../a.yaml", "--quiet", "--out", "../out"]
    done = subprocess.run([*command, *options], cwd=folder, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert len(load(tmp_path / "out")) == 8
    assert main(["report", str(tmp_path / "out")]) == 0


PAINTED = """\
from fddbench.benchmarks.yaw_rate.benchmark import YawRate
from fddbench.interfaces import Choice

class Painted(YawRate):
    \"\"\"The shipped benchmark with one thing more to choose.\"\"\"
    name, about = "painted", "painted"
    choices = YawRate.choices | {"paint": Choice(about="colour", options={"white": 0.0, "red": 1.0})}
"""


def painted(folder, *lines):
    (folder / "paint.py").write_text(PAINTED)
    text = TINY.replace("yaw_rate", "paint.py:Painted").replace("[net]", "[voting_monitor]")
    (folder / "painted.yaml").write_text(text + "".join(f"{line}\n" for line in lines))
    return folder / "painted.yaml"


def test_a_new_choice_is_one_line_in_one_place(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = painted(tmp_path, "paint: red")
    assert main(["check", str(path)]) == 0
    assert "wind none, paint red\n" in capsys.readouterr().out
    campaign = read_campaign(path)
    assert (campaign.choices["paint"], campaign.chosen["paint"]) == ("red", 1.0)
    assert fly(str(path), "--out", "out") == 0
    assert yaml.safe_load((tmp_path / "out" / "campaign.yaml").read_text())["paint"] == "red"
    assert main(["report", "out"]) == 0
    hashes = [read_campaign(painted(tmp_path, *lines)).sha256 for lines in ((), ("paint: white",), ("paint: red",))]
    assert hashes[0] == hashes[1] != hashes[2]
    capsys.readouterr()
    assert main(["check", str(painted(tmp_path, "paint: rot"))]) == 2
    assert "no paint of benchmark 'painted' is called 'rot'. Known: white, red" in capsys.readouterr().err
    assert main(["check", str(painted(tmp_path, "pain: red"))]) == 2
    assert "unknown key 'pain'. Did you mean 'paint'?" in capsys.readouterr().err


def test_a_choice_called_as_a_key_of_every_campaign_is_refused(tmp_path, capsys):
    path = painted(tmp_path)
    (tmp_path / "paint.py").write_text(PAINTED.replace('{"paint"', '{"seed"'))
    assert main(["check", str(path)]) == 2
    message = capsys.readouterr().err
    assert (
        "painted.yaml:2:12: a benchmark cannot offer the choices ['seed']: campaigns have keys of that name" in message
    )


WRONG_PARTS = {
    "a voter without a vote": ("mean.py", ("def vote", "def elect"), "mine.yaml:4:8: 'mean.py:Mean' cannot be the voter of "
                               "benchmark 'yaw_rate': it has no vote"),
    "a voter that raises": ("mean.py", ("voted = sensors[0]", "voted = sensor[0]"), "NameError: name 'sensor' is not defined"),
    "a voter of two rows": ("mean.py", ("return voted", "return sensors[:2] + voted"), "the voter Mean gives a signal of"),
    "a fault that raises": ("sawtooth.py", ("self.height *", "self.heigth *"), "AttributeError: 'Teeth' object has no"),
    "a fault that is none": ("sawtooth.py", ("class Sawtooth(WithAmplitude)", "class Sawtooth"), "is no fault: it has no"),
    "a preset that is none": ("parts.py", ("quiet = Noise(", "quiet = dict("), "cannot be the sensors of benchmark"),
    "a plant that is none": ("plant.py", ("(LateralLpvPlant)", ""), "cannot be the plant of benchmark 'yaw_rate': it has no"),
    "a helper that is gone": ("plant.py", ("from constants", "from constant"), "plant.py:1 does not run: ModuleNotFoundError"),
    "a name that is gone": ("parts.py", ("breeze = ", "storm = "), "parts.py has no 'breeze'"),
}  # fmt: skip


@pytest.mark.parametrize("what", WRONG_PARTS)
def test_a_wrong_part_is_a_message_and_nothing_is_written(beside, capsys, what):
    name, (old, new), message = WRONG_PARTS[what]
    text = (beside / name).read_text()
    assert old in text
    (beside / name).write_text(text.replace(old, new))
    for command in (["check", "mine.yaml"], ["run", "mine.yaml", "--out", "../out"]):
        assert main(command) == 2
        error = capsys.readouterr().err
        assert message in error
        if "raises" in what:
            assert f"{name}:" in error
    assert not (beside.parent / "out").exists()


WRONG_BENCHMARKS = {
    "no loop": ("    def loop(self, options)", "    def lopo(self, options)", "is no benchmark: it has no loop"),
    "no step": (
        "    def step(",
        "    def setp(",
        "the loop of benchmark 'short_period.py:ShortPeriod' has no step; see fddbench.interfaces.Loop",
    ),
    "a step that raises": ("faults, q = ", "faults, q = self.gone; ", "cannot fly: AttributeError"),
    "a misspelt signal": (
        "SimpleNamespace(q_deg_s=q",
        "SimpleNamespace(q_rad_s=q",
        "the bus announces q_deg_s of shape (2, n_cases), the step shows (0,)",
    ),
    "a state of another shape": ("State(x=after", "State(x=after[:1]", "x needs the shape (2, n_cases), got (1, "),
    "a truth of another name": (
        'truth={"q_true_deg_s"',
        'truth={"q"',
        "truth announces ['q_true_deg_s'], the step shows ['q']; make them equal",
    ),
    "what faults add on one site only": (
        "added=q - healthy",
        "added=q[0]",
        "added needs the shape (2, n_cases), a row for every site, got (2,)",
    ),
    "the error of a vote that is no signal": (
        "voted={}",
        'voted={"q_voted_deg_s": q[0]}',
        "voted has the error of voted signals of the bus, (n_cases,) each; got q_voted_deg_s of shape (2,)",
    ),
    "a unit nobody knows": (
        '"unit_name": "deg/s"',
        '"unit_name": "furlong"',
        "no unit is called 'furlong'; known: '', 'deg'",
    ),
    "one name twice": ('name=f"q{j + 1}"', 'name="q1"', "the fault sites ['q1'] are there twice"),
    "a plant without sites": (
        "    sites, manoeuvres, shown = SITES, ",
        "    places, manoeuvres, shown = SITES, ",
        "has no sites",
    ),
    "one that cannot be made": (
        "    def loop(",
        "    def __init__(self, x): self.x = x\n\n    def loop(",
        "cannot be used: TypeE",
    ),
    "a start that raises": (
        "        return State(x=0.0,",
        "        return State(y=0.0,",
        "cannot fly: TypeError",
    ),
    "a loop that cannot be made": (
        "cont2discrete((A,",
        "cont2discrete((A.x,",
        "cannot make its loop: AttributeError",
    ),
}


@pytest.mark.parametrize("what", WRONG_BENCHMARKS)
def test_a_wrong_benchmark_is_a_message_with_its_place(beside, capsys, what):
    old, new, message = WRONG_BENCHMARKS[what]
    text = (beside / "short_period.py").read_text()
    assert old in text
    (beside / "short_period.py").write_text(text.replace(old, new))
    assert main(["check", "own.yaml"]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.startswith("fddbench: own.yaml:2:12: ") or "benchmark 'short_period.py:ShortPeriod'" in error
    if "raises" in what or "loop: Attr" in message:
        assert "short_period.py:" in error.rsplit("(", 1)[1]
