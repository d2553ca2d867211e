"""What grows with a model and should not: many tables, many substeps, many variants of a detector."""

import os
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from fddbench import gallery, private
from fddbench.blocks import kernel
from fddbench.blocks.integrate import rk4
from fddbench.blocks.layout import Rows
from fddbench.blocks.linear import affine, column, product
from fddbench.blocks.lookup import Grid, Lookup
from fddbench.blocks.program import Program, trace
from fddbench.campaign.load import read_campaign
from fddbench.runner.assembling import assemble
from fddbench.runner.flight import Flyer
from tests.bench.report import Line
from tests.bench.step import DT, A

RUNS, SAMPLES = 64, 5000
N_TABLES, N_ALPHA, N_MACH = 24, 20, 19
SUBSTEPS = 1000
PUBLISHED = "sliding_mode_published"
MIXED: tuple[Mapping[str, float], ...] = (
    {},
    *({"threshold_floor_deg_s": 0.25 + 0.01 * j} for j in (1, 2, 3)),
    *({"flag_threshold_deg_s": 0.3 + 0.01 * j} for j in (1, 2, 3)),
    *({"confirm_one_s": 1.0 + 0.1 * j} for j in (1, 2, 3)),
)
ENERGY = tuple({"energy_limit_deg_s2": 30.0 + j} for j in range(10))
_CAMPAIGN = """# How much more do ten variants cost than one?
name: variants
about: How much more do ten variants cost than one?
benchmark: yaw_rate
plant: lateral_lpv
voter: median
sensors: white
wind: none
purpose: tuning
seed: 20250101
duration_s: 20.0
detectors: [{names}]
dispersions:
  monte_carlo: {{runs: 64, mass_kg: {{uniform: [180000, 220000]}}}}
scenarios:
  - {{name: healthy, manoeuvre: yaw_angle_mode}}
"""


def lines(*, repeats: int) -> Iterator[Line]:
    """All measurements, in a temporary folder with a cache of its own."""
    with tempfile.TemporaryDirectory() as name:
        os.environ["FDDBENCH_CACHE"] = str(Path(name) / "cache")
        yield from _tables(repeats)
        yield from _substeps(repeats)
        yield from _variants(Path(name), repeats)


def tables(n: int = N_TABLES) -> Callable[..., Mapping[str, Rows]]:
    """Step that looks up in `n` tables over the same two axes, at places that move."""
    rng = np.random.default_rng(5)
    alpha, mach = Grid(np.sort(rng.uniform(-10.0, 30.0, N_ALPHA))), Grid(np.sort(rng.uniform(0.2, 0.9, N_MACH)))
    coefficients = [Lookup(rng.normal(size=(N_ALPHA, N_MACH)), alpha, mach) for _ in range(n)]

    def step(state: Rows, sample: Rows) -> Mapping[str, Rows]:
        places = alpha.find(state[0] + 0.01 * sample), mach.find(state[1])
        total = sum(table(*places) for table in coefficients)
        return {"state": np.stack([state[0], state[1], 0.5 * state[2] + total])}

    return step


def substeps(n: int) -> Callable[..., Mapping[str, Rows]]:
    """Step of the linear parameter-varying plant of the bench in `n` substeps."""

    def step(state: Rows) -> Mapping[str, Rows]:
        M = affine(column(A), 0.1 * state[:2])
        return {"state": rk4(lambda x: product(M, x), state, step_s=DT, substeps=n)}

    return step


def _compiled(program: Program) -> tuple[kernel.Kernel, float]:
    """Kernel compiled anew, and the CPU time that took."""
    for file in private.folder().glob("*.o"):
        file.unlink()
    begun = time.process_time()
    made = kernel.build(program, backend="llvm")
    return made, time.process_time() - begun


def _tables(repeats: int) -> Iterator[Line]:
    traced, compiled, flown = [], [], []
    for _ in range(repeats):
        begun = time.process_time()
        program = trace(tables(), state=3, sample=0)
        traced.append(time.process_time() - begun)
        made, spent = _compiled(program)
        compiled.append(spent)
        flown.append(_flown(made, np.zeros((3, RUNS)), SAMPLES) / (RUNS * SAMPLES) * 1e9)
    what = f"{N_TABLES} tables of {N_ALPHA} x {N_MACH}"
    yield Line(
        what=f"{what}, tracing, CPU",
        values=traced,
        asked=0.3,
        least=False,
        unit="s",
        note=f"{len(program.nodes)} nodes",
    )
    yield Line(what="  compiling, CPU", values=compiled, asked=1.5, least=False, unit="s")
    yield Line(what="  a step of one flight", values=flown, unit="ns")


def _substeps(repeats: int) -> Iterator[Line]:
    spent = [_compiled(trace(substeps(SUBSTEPS), state=4))[1] for _ in range(repeats)]
    yield Line(what=f"{SUBSTEPS} substeps, compiling, CPU", values=spent, asked=2.0, least=False, unit="s")


def _flown(made: kernel.Kernel, state: np.ndarray, samples: int) -> float:
    """CPU time of a flight."""
    n = state.shape[1]
    where = kernel.Addresses(key=0, run=0, flight=0, scenario=0)
    begun = time.process_time()
    made.fly(state, np.zeros((0, n)), np.full(n, samples), where, first=0, end=samples)
    return time.process_time() - begun


def _variants(folder: Path, repeats: int) -> Iterator[Line]:
    flyers = {
        what: _flyer(folder / what, variants)
        for what, variants in (("one", MIXED[:1]), ("mixed", MIXED), ("energy", ENERGY))
    }
    spent: dict[str, list[float]] = {what: [] for what in flyers}
    for _ in range(repeats):
        for what, fly in flyers.items():
            begun = time.process_time()
            fly()
            spent[what].append(time.process_time() - begun)
    one = np.array(spent["one"])
    asked = {
        "mixed": ("10 variants in floor, flag, confirmation over one", 1.6),
        "energy": ("10 variants in the energy limit over one", 2.3),
    }
    for what, (words, limit) in asked.items():
        yield Line(what=f"{words}, CPU", values=np.array(spent[what]) / one, asked=limit, least=False)


def _flyer(folder: Path, variants: tuple[Mapping[str, float], ...]) -> Callable[[], Any]:
    """Flight of the published scheme with other numbers, ready to go."""
    (folder / "detectors").mkdir(parents=True)
    design = yaml.safe_load((gallery.folder("detectors") / f"{PUBLISHED}.yaml").read_text(encoding="utf-8"))
    for j, changed in enumerate(variants):
        text = yaml.safe_dump({**design, "gains": {**design["gains"], **changed}})
        (folder / "detectors" / f"variant_{j}.yaml").write_text(text, encoding="utf-8")
    file = folder / "variants.yaml"
    file.write_text(_CAMPAIGN.format(names=", ".join(f"variant_{j}" for j in range(len(variants)))), encoding="utf-8")
    assembly = assemble(read_campaign(file))
    flyer, batch = Flyer(assembly, "llvm"), assembly.batch(np.arange(assembly.plan.n_cases))
    flyer.prepare()
    return lambda: flyer.fly(batch)
