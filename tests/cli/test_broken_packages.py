"""A package of somebody else's that is broken is told to those who ask for it, and harms nobody else."""

import json
from types import SimpleNamespace

import pytest
from tests.cli.test_commands import TINY

from fddbench import kinds, load
from fddbench.benchmarks.yaw_rate.benchmark import YawRate
from fddbench.cli import main
from fddbench.interfaces import Choice, Site
from fddbench.voting.median import Median


@pytest.fixture
def tiny(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tiny.yaml").write_text(TINY)
    return tmp_path


@pytest.fixture
def registered(monkeypatch):
    """Registers something under the name of 'other' in a family, beside the real members."""
    real = kinds.registered

    def register(family, load):
        point = SimpleNamespace(load=load, value="other.package:Thing")
        monkeypatch.setattr(
            kinds, "registered", lambda asked: real(asked) | ({"other": point} if asked == family else {})
        )

    return register


def raising(error):
    def load():
        raise error

    return load


class Nameless:
    """Has nothing of what any family needs."""


class Furlong(YawRate):
    """A benchmark whose sites have a unit that nobody knows."""

    name = about = "furlong"

    def plant(self, chosen):
        site = Site(name="r1", signal="r_deg_s", unit_name="furlong", admissible=1.0)
        return SimpleNamespace(sites=(site,), parameters=(), refused_parameters={}, manoeuvres={"cruise": 1.0})


class Unmade(YawRate):
    """A benchmark that needs something to be made."""

    name = about = "unmade"

    def __init__(self, something):
        self.something = something


class Taken(YawRate):
    """A benchmark with a choice called as a key of every campaign."""

    name = about = "taken"
    choices = YawRate.choices | {"detectors": Choice(about="", options={"a": 1})}


BROKEN = {
    "import": (raising(ImportError("no module named lapack")), "ImportError: no module named lapack"),
    "division": (raising(ZeroDivisionError("1 / 0")), "ZeroDivisionError: 1 / 0"),
    "exit": (raising(SystemExit(3)), "SystemExit: 3"),
    "attribute": (raising(AttributeError("module has no Thing")), "AttributeError: module has no Thing"),
}
USED = {  # a campaign that names the member, and where it does
    "benchmark": (("benchmark: yaw_rate", "benchmark: other"), "tiny.yaml:2:12: "),
    "voter": (("seed: 1", "seed: 1\nvoter: other"), "tiny.yaml:4:8: "),
    "fault": (("kind: jam", "kind: other"), "tiny.yaml:8:54: "),
    "detector": (("[sliding_mode_published, ", "[other, "), "detectors/other.yaml:1:7: "),
}


def use(folder, family):
    """Write the campaign that names the member 'other' of a family; where it does."""
    (old, new), place = USED[family]
    (folder / "detectors").mkdir(exist_ok=True)
    (folder / "detectors" / "other.yaml").write_text("kind: other\nsource: me\ntuned_on: null\ngains: {}\n")
    assert old in TINY
    (folder / "tiny.yaml").write_text(TINY.replace(old, new))
    return place


def nobody_else_is_harmed(folder, capsys):
    """What knows nothing of the broken member works as ever."""
    (folder / "sound.yaml").write_text(TINY)
    for command in (["check", "sound.yaml"], ["check", "smoke"], ["list"], ["schema"], ["cost", "voting_monitor"]):
        assert main(command) == 0, command
    out = capsys.readouterr()
    assert out.err == ""
    return out.out


@pytest.mark.parametrize("family", USED)
@pytest.mark.parametrize("how", BROKEN)
def test_a_package_that_cannot_be_imported(tiny, registered, capsys, family, how):
    load, reason = BROKEN[how]
    place = use(tiny, family)
    registered(family, load)
    assert main(["run", "tiny.yaml", "--out", "out"]) == 2
    message = capsys.readouterr().err
    assert place in message
    assert f"the {family} 'other' is registered as other.package:Thing and cannot be imported: {reason}" in message
    assert "Mend or remove that package" in message
    assert not (tiny / "out").exists()
    listed = nobody_else_is_harmed(tiny, capsys)
    assert f"(broken) the {family} 'other' is registered as" in listed


@pytest.mark.parametrize("family", ["benchmark", "fault", "detector"])
def test_a_member_that_lacks_something(tiny, registered, capsys, family):
    place = use(tiny, family)
    registered(family, lambda: Nameless)
    assert main(["check", "tiny.yaml"]) == 2
    message = capsys.readouterr().err
    assert place in message
    assert f"'other' (other.package:Thing) is no {family}: it has no " in message
    assert "See fddbench.interfaces" in message
    assert "(broken)" in nobody_else_is_harmed(tiny, capsys)


def test_a_voter_that_lacks_something(tiny, registered, capsys):
    place = use(tiny, "voter")
    registered("voter", lambda: Nameless)
    assert main(["check", "tiny.yaml"]) == 2
    assert f"{place}'other' cannot be the voter of benchmark 'yaw_rate': it has no vote" in capsys.readouterr().err
    nobody_else_is_harmed(tiny, capsys)


def test_a_voter_that_somebody_registered_can_be_chosen(tiny, registered, capsys):
    use(tiny, "voter")
    registered("voter", lambda: type("Other", (Median,), {"__doc__": "Another median."}))
    assert main(["check", "tiny.yaml"]) == 0
    assert "voter other" in capsys.readouterr().out
    assert main(["run", "tiny.yaml", "--quiet", "--jobs", "1"]) == 0


@pytest.mark.parametrize(
    ("benchmark", "message"),
    [
        (Furlong, "no unit is called 'furlong'; known: "),
        (Unmade, "the benchmark 'other' cannot be used: TypeError: "),
        (Taken, "a benchmark cannot offer the choices ['detectors']: campaigns have keys of that name; rename them"),
    ],
)
def test_a_benchmark_that_cannot_be_asked(tiny, registered, capsys, benchmark, message):
    place = use(tiny, "benchmark")
    registered("benchmark", lambda: benchmark)
    assert main(["check", "tiny.yaml"]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"fddbench: {place}")
    assert message in error
    nobody_else_is_harmed(tiny, capsys)


def test_a_new_choice_shows_in_the_schema(registered, capsys):
    added = YawRate.choices | {"paint": Choice(about="colour", options={"white": 0.0})}
    registered("benchmark", lambda: type("Painted", (YawRate,), {"choices": added, "name": "painted"}))
    assert main(["schema"]) == 0
    keys = json.loads(capsys.readouterr().out)["properties"]
    assert {"paint", "plant", "voter", "sensors", "wind"} <= set(keys)


def test_two_packages_of_one_name_are_told(monkeypatch):
    points = [SimpleNamespace(name="mine", value=f"{package}:Mine") for package in ("a", "b", "a")]
    monkeypatch.setattr(kinds, "entry_points", lambda group: points)
    kinds.registered.cache_clear()
    try:
        with pytest.raises(
            Exception, match=r"(?s)two packages register the same voter:\n  mine = a:Mine\n  mine = b:Mine"
        ):
            kinds.registered("voter")
    finally:
        kinds.registered.cache_clear()


BUG = """\
import numpy as np
from pydantic import BaseModel
from fddbench.blocks.layout import Layout, Rows, record
from fddbench.blocks.linear import largest
from fddbench.interfaces import Verdict

class Gains(BaseModel):
    k: float
    h: float

@record
class Sums:
    s: Rows
    d: Rows

class Mine:
    about, recorded, Gains = "my cusum", ("s",), Gains
    states = Layout(Sums(s=3, d=3))
    def __init__(self, gains): self.g = gains
    @classmethod
    def from_design(cls, gains, bus): return cls(gains)
    def start(self): return Sums(s=0.0, d=0.0)
    def step(self, x, m):
        s = np.maximum(x.s + np.abs(m.r_deg_s - m.r_voted_deg_s) - self.g.k, 0.0)
        d = np.where(s > self.g.h, 1.0, x.d)
        after = Sums(s=s, d=d)
        return after, Verdict(d, largest(s) / self.g.h, signals={"s": largest(s)})
"""
STEP, SUMS, AFTER = 23, 24, 26
"""Lines of the step, of the first sum and of the state after."""
BUGS = {
    "misspelt signal": ("m.r_deg_s -", "m.rr_deg_s -", SUMS, "no attribute 'rr_deg_s'. Measured are phi_deg, "),
    "no state at all": ("return after, ", "return ", STEP, "a step gives (state, Verdict), got Verdict"),
    "forgotten state": ("Sums(s=s, d=d)", "Sums(s=s)", AFTER, "missing 1 required keyword-only argument: 'd'"),
    "misspelt state": ("Sums(s=s, d=d)", "Sums(s=s, e=d)", AFTER, "unexpected keyword argument 'e'"),
    "state of another shape": ("Sums(s=s, d=d)", "Sums(s=s[0], d=d)", STEP, "s needs the shape (3, n_cases), got (2,)"),
    "wrong shape": ("Verdict(d, ", "Verdict(d[0], ", STEP, "a verdict needs declared of shape (3, 2), got (2,)"),
    "residual of every site": ("largest(s) / self.g.h", "s / self.g.h", STEP, "a verdict needs residual of shape (2,), got"),
    "misspelt number": ("self.g.k", "self.g.kk", SUMS, "'Gains' object has no attribute 'kk'"),
    "number for a row": ("largest(s) / self.g.h", "0.0", STEP, "a verdict needs residual of shape (n_cases,), got ()"),
}  # fmt: skip


@pytest.fixture
def bug(tiny):
    (tiny / "detectors").mkdir()
    (tiny / "detectors" / "e.yaml").write_text("kind: e.py:Mine\ngains: {k: 0.1, h: 2.0}\nsource: me\ntuned_on: null\n")
    (tiny / "tiny.yaml").write_text(TINY.replace("sliding_mode_published", "e"))

    def write(old="", new=""):
        assert old in BUG
        (tiny / "detectors" / "e.py").write_text(BUG.replace(old, new) if old else BUG)
        return tiny

    return write


@pytest.mark.parametrize("command", ["check", "run"])
@pytest.mark.parametrize("what", BUGS)
def test_bugs_of_a_plug_in_are_told_with_their_line_before_anything_is_flown(bug, capsys, what, command):
    old, new, line, message = BUGS[what]
    folder = bug(old, new)
    assert main([command, "tiny.yaml"]) == 2
    error = capsys.readouterr().err
    assert error.startswith("fddbench: tiny.yaml:5:13: design 'e' (detectors/e.yaml): ")
    assert message in error
    assert f"detectors/e.py:{line})" in error
    assert not (folder / "results").exists()


def test_the_plug_in_without_a_bug_flies_compiled(bug, capsys):
    bug()
    assert main(["run", "tiny.yaml", "--quiet", "--jobs", "1"]) == 0
    assert "flies in Python" not in capsys.readouterr().err


DETECTS = (
    ('("s",), Gains\n', '("s",), Gains\n    isolates, watches = False, ()\n'),
    ("Verdict(d, largest(s) / self.g.h, ", "Verdict(None, largest(s) / self.g.h, alarm=largest(d), "),
)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("Verdict(None", "Verdict(d"), "a detector with isolates = False gives an alarm and declares no sites"),
        (("alarm=largest(d), ", ""), "a detector with isolates = False gives an alarm and declares no sites"),
        (("alarm=largest(d)", "alarm=d"), "a verdict needs alarm of shape (2,), got (3, 2)"),
        (None, ""),
    ],
)
def test_a_detector_that_only_detects(bug, capsys, change, message):
    folder = bug()
    text = BUG
    for old, new in (*DETECTS, *([change] if change else [])):
        assert old in text
        text = text.replace(old, new)
    (folder / "detectors" / "e.py").write_text(text)
    if change:
        assert main(["check", "tiny.yaml"]) == 2
        assert message in capsys.readouterr().err
        return
    for options in (["--jobs", "1"], ["--backend", "numpy", "--jobs", "1", "--out", "other"]):
        assert main(["run", "tiny.yaml", "--quiet", *options]) == 0
    rows, other = load("results/tiny"), load("other")
    assert rows.equals(other)
    mine = rows[rows["detector"] == "e"]
    assert set(mine["status"]) == {"ok"}
    assert (mine["n_declared"] == 0).all()
    assert mine["margin_faulty"].max() > 1.0
    assert main(["report", "results/tiny"]) == 0
