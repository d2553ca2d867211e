"""Fault injection: of 80 flights one meets a step that does harm; 79 rows are those of the same detector without it.

Seen to fail with the mechanism off (`supervisable` saying no): the run ends with a step that exits, segfaults, aborts,
closes files, sends itself a signal or kills its parent; with one that hangs it never ends; a fork writes all twice; a leak
takes what there is; 20 MB are printed; the working folder moves; the truth is in reach. What raises is a row either way.
"""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from tests.runner.plugins import HEAD, SIDE_BY_SIDE
from tests.runner.test_same_bits import bits

from fddbench import load
from fddbench.campaign.load import read_campaign
from fddbench.runner.run import run_campaign

TEXT = """\
name: poison
benchmark: yaw_rate
seed: 5
duration_s: 0.6
detectors: [NAMES]
dispersions:
  monte_carlo: {runs: 80, mass_kg: {uniform: [180000, 220000]}}
scenarios:
  - {name: jam, manoeuvre: cruise, faults: [{kind: jam, sites: [r1], onset_s: 0.2, amplitude_deg_s: 5.0}]}
"""
POISONED = 33
"""Run that meets the harm; its mass is that of no other."""

BODY = """
import ctypes, gc, os, signal, sys, threading

KEPT = []


class Mine(Base):
    def start(self):
        return [0.0] * 3, [0] * 3, 0

    def step(self, state, measured):
        sums, declared, k = state
        if k == 20 and int(measured.mass_kg) == MASS:
            HARM
        for i, r in enumerate(measured.r_deg_s):
            sums[i] = max(sums[i] + abs(r - measured.r_voted_deg_s) - 0.1, 0.0)
            declared[i] = declared[i] or sums[i] > 2.0
        return (sums, declared, k + 1), Verdict(declared, max(sums) / 2.0)
"""

HARMS = {
    "raises": ("raise ValueError('\\x1b[31mred\\x1b[0m')", "error", r"ValueError: \x1b[31mred\x1b[0m (raises.py:"),
    "leaves": ("sys.exit(3)", "error", "SystemExit: 3"),
    "recurses": ("self.step(state, measured)", "error", "RecursionError"),
    "interrupts": ("raise KeyboardInterrupt", "error", "KeyboardInterrupt"),
    "exits": ("os._exit(3)", "crashed", "crashed: it ended its process with exit code 3"),
    "segfaults": ("ctypes.string_at(0)", "crashed", "crashed: its process died of SIGSEGV"),
    "aborts": ("os.abort()", "crashed", "crashed: its process died of SIGABRT"),
    "dies_of_a_number": ("os.kill(os.getpid(), 40)", "crashed", "crashed: its process died of signal 40"),
    "kills_its_parent": ("os.kill(os.getppid(), signal.SIGKILL)\n            signal.pause()", "crashed", "crashed: "),
    "closes": ("os.closerange(0, 1024)", "crashed", "crashed: it closed files that are not its own"),
    "hangs": ("while True: pass", "timeout", "timeout: a step took longer than 1 s"),
    "hangs_in_c": ("ctypes.CDLL(None).pause()", "timeout", "timeout: a step took longer than 1 s"),
    "leaks": ("while True: KEPT.append(bytearray(10**7))", "memory", "memory: it needs more than 200 MB"),
    "prints": ("print('x' * 10**7); os.write(1, b'y' * 10**7)", "ok", ""),
    "moves": ("os.chdir('/'); os.environ.clear(); sys.path.clear()", "ok", ""),
    "signals": ("os.kill(os.getpid(), signal.SIGINT)", "ok", ""),
    "forks": ("os.fork()", "ok", ""),
    "starts_threads": ("threading.Thread(target=time.sleep, args=(99,), daemon=True).start()", "ok", ""),
    "writes": (
        "a = measured.r_deg_s\n"
        "            while isinstance(a, np.ndarray): a.flags.writeable = True; a[:] = 99.0; a = a.base",
        "error", "ValueError: cannot set WRITEABLE flag to True",
    ),
}  # fmt: skip
QUICK = ("raises", "exits", "segfaults", "hangs_in_c", "leaks", "prints")
SEES = (
    "KEPT.extend(o for o in gc.get_objects() if type(o).__name__ in ('Assembly', 'Batch', 'Plan', 'Campaign', 'Flyer'))"
)
LIMITS = "limits: {step_s: 1, memory_mb: 200}\n"


def written(folder, bodies, more=()):
    """Campaign with these detectors, by name and text."""
    (folder / "detectors").mkdir()
    for name, body in bodies.items():
        (folder / "detectors" / f"{name}.py").write_text(HEAD + body)
        head = f"kind: {name}.py:Mine\nabout: a test\nsource: me\ntuned_on: null\n"
        (folder / "detectors" / f"{name}.yaml").write_text(f"{head}{LIMITS}gains: {{}}\n")
    path = folder / "poison.yaml"
    path.write_text(TEXT.replace("NAMES", ", ".join([*bodies, *more])))
    return path


def mass_of_the_poisoned(folder):
    path = folder / "voting.yaml"
    path.write_text(TEXT.replace("NAMES", "voting_monitor"))
    run_campaign(read_campaign(path), folder / "voting", jobs=1)
    rows = load(folder / "voting")
    assert len({int(mass) for mass in rows["p_mass_kg"]}) == 80
    return int(rows[rows["run"] == POISONED]["p_mass_kg"].iloc[0])


def poisoned(harm, mass):
    return BODY.replace("MASS", str(mass)).replace("HARM", harm)


def apart(rows, name):
    """Rows of a detector but the poisoned one, without its name; and that row."""
    mine = rows[rows["detector"] == name].sort_values("run").reset_index(drop=True)
    sound = mine[mine["run"] != POISONED].drop(columns=["detector"]).reset_index(drop=True)
    return sound, mine[mine["run"] == POISONED].iloc[0]


def all_at_once(folder, names):
    """Rows of all these harms in one campaign, each a detector, beside one that does none; and how much was printed."""
    mass = mass_of_the_poisoned(folder)
    seen = poisoned(SEES, mass).replace("max(sums) / 2.0)", "float(len(KEPT)))")
    bodies = {"none": poisoned("pass", mass), "sees": seen, **{name: poisoned(HARMS[name][0], mass) for name in names}}
    path = written(folder, bodies)
    before = Path.cwd()
    with (folder / "said").open("w+") as said:
        kept = os.dup(2)
        os.dup2(said.fileno(), 2)
        try:
            run_campaign(read_campaign(path), folder / "out", jobs=1)
        finally:
            os.dup2(kept, 2)
            os.close(kept)
    assert Path.cwd() == before
    return load(folder / "out"), (folder / "said").stat().st_size


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    return all_at_once(tmp_path_factory.mktemp("poison"), QUICK)


def require_harm_alone(rows, name):
    _, status, reason = HARMS[name]
    clean, _ = apart(rows, "none")
    others, own = apart(rows, name)
    assert len(others) == 79
    assert bits(others) == bits(clean), name
    assert own["status"] == status, name
    assert status == "ok" or reason in own["reason"]


@pytest.mark.slow
@pytest.mark.parametrize("name", QUICK)
def test_harm_is_a_row_of_its_own_flight_alone(flown, name):
    require_harm_alone(flown[0], name)


@pytest.mark.slow
def test_all_other_harm_is_a_row_of_its_own_flight_alone(tmp_path):
    others = [name for name in HARMS if name not in QUICK]
    rows, _ = all_at_once(tmp_path, others)
    for name in others:
        require_harm_alone(rows, name)


@pytest.mark.slow
def test_nothing_of_the_truth_is_in_the_memory_of_a_detector(flown):
    """In the process that flies, the batch with all onsets, the plan and the campaign are objects that anybody finds."""
    rows, _ = flown
    mine = rows[rows["detector"] == "sees"]
    assert set(mine["status"]) == {"ok"}
    assert set(mine["margin_faulty"]) == {0.0}


@pytest.mark.slow
def test_what_a_detector_prints_is_cut_short(flown):
    assert flown[1] < 20_000


@pytest.mark.slow
@pytest.mark.parametrize("harm", ["exits", "hangs_in_c", "leaks", "raises"])
def test_many_flights_side_by_side_are_flown_apart(tmp_path, harm):
    mass = mass_of_the_poisoned(tmp_path)
    body = "import ctypes, os\nKEPT = []\n" + SIDE_BY_SIDE.replace(
        "        worst =",
        f"        if (measured.mass_kg.astype(int) == {mass}).any():\n            {HARMS[harm][0]}\n        worst =",
    )
    path = written(tmp_path, {"none": SIDE_BY_SIDE, harm: body})
    run_campaign(read_campaign(path), tmp_path / "out", jobs=1)
    rows = load(tmp_path / "out")
    others, own = apart(rows, harm)
    assert bits(others) == bits(apart(rows, "none")[0])
    assert own["status"] == HARMS[harm][1]


@pytest.mark.slow
def test_many_poisoned_flights_cost_no_more_than_each_alone(tmp_path):
    """Every second flight dies: each is flown at most three times in company and once alone."""
    mass = mass_of_the_poisoned(tmp_path)
    body = poisoned("pass", mass).replace(
        "if k == 20 and", "if k == 20 and int(measured.mass_kg) % 2: os._exit(1)\n        if k == 20 and"
    )
    begun = time.monotonic()
    run_campaign(read_campaign(written(tmp_path, {"half": body})), tmp_path / "out", jobs=1)
    assert time.monotonic() - begun < 90.0
    rows = load(tmp_path / "out")
    dead = rows["p_mass_kg"].astype(int) % 2 == 1
    assert set(rows[dead]["status"]) == {"crashed"}
    assert set(rows[~dead]["status"]) == {"ok"}


@pytest.mark.slow
def test_an_aircraft_that_acts_on_a_detector_loses_one_flight(tmp_path):
    mass = mass_of_the_poisoned(tmp_path)
    path = written(tmp_path, {"none": poisoned("pass", mass), "exits": poisoned("os._exit(3)", mass)})
    text = path.read_text().replace("runs: 80", "runs: 40").replace("seed: 5", "seed: 5\nreconfigure: exits")
    path.write_text(text.replace("benchmark: yaw_rate", "benchmark: yaw_rate\nvoter: monitored"))
    run_campaign(read_campaign(path), tmp_path / "out", jobs=1)
    rows = load(tmp_path / "out")
    mine = rows[rows["detector"] == "exits"].set_index("run")["status"]
    assert mine[POISONED] == "crashed"
    assert set(mine.drop(POISONED)) == {"ok"}


def marked(mark):
    """Processes with a mark in their environment."""
    found = []
    for path in Path("/proc").glob("[0-9]*"):
        try:
            if mark.encode() in (path / "environ").read_bytes() and b"Z (" not in (path / "stat").read_bytes():
                found.append(path.name)
        except OSError:
            continue
    return found


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
@pytest.mark.parametrize("jobs", ["1", "2"])
def test_no_process_outlives_a_killed_run_by_a_second(tmp_path, jobs):
    """Seen to fail with `die_with` doing nothing and stages that end no flights; either of both is enough."""
    mass = mass_of_the_poisoned(tmp_path)
    path = written(tmp_path, {"hangs": poisoned("while True: pass", mass)})
    design = tmp_path / "detectors" / "hangs.yaml"
    design.write_text(design.read_text().replace("step_s: 1", "step_s: 1000"))
    mark = f"FDDBENCH_MARK={os.getpid()}_{jobs}"
    line = [
        sys.executable,
        "-m",
        "fddbench",
        "run",
        str(path),
        "--jobs",
        jobs,
        "--quiet",
        "--out",
        str(tmp_path / "out"),
    ]
    run = subprocess.Popen(
        line, env={**os.environ, **dict([mark.split("=")])}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    until = time.monotonic() + 60.0
    while time.monotonic() < until and not list((tmp_path / "out").glob("rows/*.parquet")):
        time.sleep(0.1)  # the other chunk hangs
        if len(marked(mark)) >= 4 and time.monotonic() > until - 45.0:
            break
    assert len(marked(mark)) >= 4
    run.send_signal(signal.SIGKILL)
    run.wait()
    time.sleep(1.0)
    assert marked(mark) == []


@pytest.mark.slow
def test_a_detector_that_always_hangs_or_dies_is_given_up_soon(tmp_path):
    always = {"hangs": "while True: pass", "exits": "os._exit(3)"}
    bodies = {
        name: BODY.replace("int(measured.mass_kg) == MASS", "True").replace("HARM", harm)
        for name, harm in always.items()
    }
    begun, told = time.monotonic(), []
    run_campaign(
        read_campaign(written(tmp_path, bodies, ["voting_monitor"])), tmp_path / "out", jobs=1, notice=told.append
    )
    assert time.monotonic() - begun < 30.0
    rows = load(tmp_path / "out")
    found = {name: set(mine["status"]) for name, mine in rows.groupby("detector")}
    assert found == {"hangs": {"timeout"}, "exits": {"crashed"}, "voting_monitor": {"ok"}}
    assert "hangs is given up: on each of the first 2 flights timeout: a step took longer than 1 s" in "\n".join(told)
