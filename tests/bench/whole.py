"""A campaign from its file to its rows: compiling, flying, the whole process, threads, and memory."""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fddbench import private
from fddbench.campaign.load import read_campaign
from fddbench.runner.assembling import assemble
from fddbench.runner.assembly import Assembly, Batch
from fddbench.runner.chunks import COMPILED_CHUNK, cut
from fddbench.runner.flight import Flyer
from tests.bench.report import Line

_TEXT = """# How fast does it fly?
name: speed
about: How fast does it fly?
benchmark: yaw_rate
plant: lateral_lpv
voter: median
sensors: white
wind: none
purpose: tuning
seed: 20250101
duration_s: {duration_s}
detectors: [sliding_mode_published, voting_monitor]
dispersions:
  monte_carlo:
    runs: {half}
    mass_kg: {{uniform: [180000, 220000]}}
    x_cg_ratio: {{uniform: [0.27, 0.33]}}
    altitude_ft: {{uniform: [15000, 25000]}}
    v_cas_kt: {{uniform: [260, 320]}}
scenarios:
  - {{name: healthy, manoeuvre: yaw_angle_mode}}
  - name: oscillation
    manoeuvre: turn_coordination_1
    faults:
      - {{kind: oscillatory, sites: [r1], onset_s: 2.0, amplitude_percent: 1.25, frequency_rad_s: 0.5385, phase_rad: 0.0}}
"""
# a small process in between: the peak memory of a process begins with that of the one it was forked from
_WATCH = """
import os, subprocess, sys
process = subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL)
_, status, used = os.wait4(process.pid, 0)
print(used.ru_utime + used.ru_stime, used.ru_maxrss)
sys.exit(os.waitstatus_to_exitcode(status))
"""
MANY, MANY_S = 100_000, 12.0


@dataclass(frozen=True)
class Cost:
    """What a process took."""

    cpu_s: float
    wall_s: float
    peak_mb: float


def lines(*, repeats: int) -> Iterator[Line]:
    """All measurements of campaigns, in a temporary folder with a cache of its own."""
    with tempfile.TemporaryDirectory() as name:
        os.environ["FDDBENCH_CACHE"] = str(Path(name) / "cache")
        yield from _compile(Path(name))
        yield from _normal(Path(name), repeats)
        yield from _many(Path(name), repeats)
        yield from _linear(Path(name), repeats)


def campaign(folder: Path, n_cases: int, duration_s: float) -> Path:
    """File of a campaign."""
    path = folder / f"speed_{n_cases}_{duration_s:g}.yaml"
    path.write_text(_TEXT.format(half=n_cases // 2, duration_s=duration_s), encoding="utf-8")
    return path


def assembled(folder: Path, n_cases: int, duration_s: float) -> Assembly:
    """The campaign ready to fly."""
    return assemble(read_campaign(campaign(folder, n_cases, duration_s)))


def batches(assembly: Assembly, jobs: int) -> list[Batch]:
    """All its cases, cut as a run cuts them."""
    cases = np.arange(assembly.plan.n_cases, dtype=np.int64)
    return [assembly.batch(part) for part in cut(assembly.plan, cases, size=COMPILED_CHUNK, jobs=jobs)]


def run(path: Path, folder: Path, *options: str) -> Cost:
    """`fddbench run` in a process of its own."""
    words = [sys.executable, "-m", "fddbench", "run", str(path), "--out", str(folder), "--fresh", "--quiet", *options]
    begun = time.monotonic()
    answer = subprocess.run([sys.executable, "-S", "-c", _WATCH, *words], check=True, capture_output=True, text=True)
    cpu_s, peak_kb = map(float, answer.stdout.split())
    return Cost(cpu_s, time.monotonic() - begun, peak_kb / 1024.0)


def _compile(folder: Path) -> Iterator[Line]:
    assembly = assembled(folder, 64, 60.0)
    cold, warm, all_cold, all_warm = [], [], [], []
    for _ in range(5):
        for file in private.folder().glob("*.o"):
            file.unlink()
        for build, everything in ((cold, all_cold), (warm, all_warm)):
            begun = time.process_time()
            flyer = Flyer(assembly, "llvm")
            assert not flyer.opaque
            program = flyer.fused.program()
            traced = time.process_time()
            flyer.fused.program = lambda program=program: program  # type: ignore[method-assign]
            flyer.prepare()
            ended = time.process_time()
            build.append(ended - traced)
            everything.append(ended - begun)
    yield Line(what="compile the default set, cold, CPU", values=cold, asked=0.5, least=False, unit="s")
    yield Line(what="  with tracing", values=all_cold, unit="s")
    yield Line(what="compile the default set, cached, CPU", values=warm, asked=0.02, least=False, unit="s")
    yield Line(what="  with tracing", values=all_warm, unit="s")


def _fly(flyer: Flyer, parts: list[Batch], jobs: int = 1) -> None:
    if jobs == 1:
        for part in parts:
            flyer.fly(part)
        return
    from joblib import Parallel, delayed

    for _ in Parallel(n_jobs=jobs, backend="threading", return_as="generator_unordered")(
        delayed(flyer.fly)(part) for part in parts
    ):
        pass


def _normal(folder: Path, repeats: int) -> Iterator[Line]:
    assembly = assembled(folder, 2200, 60.0)
    flyer, parts = Flyer(assembly), batches(assembly, 1)
    flyer.prepare()
    flown = []
    for _ in range(repeats):
        begun = time.process_time()
        _fly(flyer, parts)
        flown.append(time.process_time() - begun)
    costs = [run(campaign(folder, 2200, 60.0), folder / "out") for _ in range(repeats)]
    yield Line(what="flying 2200 x 60 s, 2 detectors, CPU", values=flown, asked=1.2, least=False, unit="s")
    cpu, wall = [c.cpu_s for c in costs], [c.wall_s for c in costs]
    yield Line(what="the same as `fddbench run`, CPU", values=cpu, asked=3.0, least=False, unit="s")
    yield Line(what="the same as `fddbench run`, wall", values=wall, unit="s")


def _many(folder: Path, repeats: int) -> Iterator[Line]:
    assembly = assembled(folder, MANY, MANY_S)
    flyer, parts = Flyer(assembly), batches(assembly, 2)
    flyer.prepare()
    times, spent = ({1: [], 2: []} for _ in range(2))
    for _ in range(repeats):
        for jobs, found in times.items():
            begun, used = time.perf_counter(), time.process_time()
            _fly(flyer, parts, jobs)
            found.append(time.perf_counter() - begun)
            spent[jobs].append(time.process_time() - used)
    gain = np.array(times[1]) / np.array(times[2])
    note = f"flights of {MANY_S:g} s; one thread {np.median(times[1]):.2f} s; wants two cores that do nothing else"
    more = np.array(spent[2]) / np.array(spent[1])
    yield Line(what=f"flying {MANY} cases, one to two threads, wall", values=gain, asked=1.8, note=note)
    yield Line(what="  CPU of two threads over that of one", values=more)
    del parts, flyer
    costs = [run(campaign(folder, MANY, MANY_S), folder / "out") for _ in range(repeats)]
    peak, cpu, wall = ([getattr(c, name) for c in costs] for name in ("peak_mb", "cpu_s", "wall_s"))
    yield Line(what=f"`fddbench run` of {MANY} cases, peak memory", values=peak, asked=400.0, least=False, unit="MB")
    yield Line(what="  CPU", values=cpu, unit="s")
    yield Line(what="  wall", values=wall, unit="s")


def _linear(folder: Path, repeats: int) -> Iterator[Line]:
    """CPU time per case at sizes from 64 on, as a share of that at the largest."""
    sizes, parts = (64, 1000, 10_000, MANY), {}
    for n in sizes:
        assembly = assembled(folder, n, 2.5)
        flyer = Flyer(assembly)
        flyer.prepare()
        parts[n] = flyer, batches(assembly, 1)
    cost: dict[int, list[float]] = {n: [] for n in sizes}
    for _ in range(repeats):
        for n, (flyer, some) in parts.items():
            times = max(1, 10_000 // n)
            begun = time.process_time()
            for _ in range(times):
                _fly(flyer, some)
            cost[n].append((time.process_time() - begun) / (n * times))
    for n in sizes[:-1]:
        yield Line(
            what=f"flying, CPU per case at {MANY} over that at {n}", values=np.array(cost[MANY]) / np.array(cost[n]),
            asked=1.2, least=False, note="flights of 2.5 s",
        )  # fmt: skip
