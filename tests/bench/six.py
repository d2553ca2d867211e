"""The aircraft with six degrees of freedom against JSBSim: the plant alone, and the whole loop with two detectors."""

import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from fddbench.benchmarks.yaw_rate.plants.transport_6dof import Transport6Dof
from fddbench.benchmarks.yaw_rate.transport.plant import controls_of
from fddbench.blocks import kernel
from fddbench.blocks.block import NO_DRAWS, program
from fddbench.blocks.layout import Nothing
from fddbench.campaign.load import read_campaign
from fddbench.flight.wind import still
from fddbench.runner.assembling import assemble
from fddbench.runner.chunks import COMPILED_CHUNK, cut
from fddbench.runner.flight import Flyer
from tests.bench.absent import AbsentError, need
from tests.bench.measure import Way, rates
from tests.bench.report import Line

WIDE = 2208
# aircraft of JSBSim, asked of the plant, asked of the loop
PEERS = (("B747", 55.0, 20.0), ("737", 90.0, None), ("A320", None, None))
_TEXT = """# How fast does it fly?
name: speed
about: How fast does it fly?
benchmark: yaw_rate
plant: transport_6dof
purpose: tuning
seed: 20250101
duration_s: 5.0
detectors: [sliding_mode_published, voting_monitor]
dispersions: {monte_carlo: {runs: 2208, mass_kg: {uniform: [150000, 220000]}, v_cas_kt: {uniform: [220, 300]}}}
scenarios:
  - {name: healthy, manoeuvre: cruise}
"""


class _Alone:
    """The plant with its surfaces and engines as trimmed, as a block."""

    draws = NO_DRAWS

    def __init__(self) -> None:
        self.plant = Transport6Dof(0.01, 1)
        self.states, self.constants = self.plant.states, self.plant.constants

    def step(self, x, c, n, sample):
        zero = np.zeros_like(c.law.stabiliser_deg)
        controls = controls_of([zero] * 13, [zero, zero], c.law.stabiliser_deg)
        return self.plant.step(x, c, Nothing(), controls, still(zero), c.law.thrust_ratio)


def _plant() -> Callable[[int], np.ndarray]:
    """The plant over many flights, its motion shown as a loop needs it."""
    alone = _Alone()
    values = {p.name: np.full(WIDE, p.default) for p in alone.plant.parameters}
    values["v_cas_kt"] = np.linspace(220.0, 300.0, WIDE)
    c = alone.plant.prepare(values, ["cruise"] * WIDE).constants
    names = type(alone.step(alone.plant.start(c), c, Nothing(), 0.0)[1]).__dataclass_fields__

    def shown(motion):
        # one number that needs all of the motion, so that none of it is left out
        total = sum((getattr(motion, name) for name in names), 0.0 * motion.n_z_g)
        return {
            "finished": np.stack([(total > 1e300).astype(float) if isinstance(total, np.ndarray) else total > 1e300])
        }

    made = program(alone, shown=shown)
    compiled = kernel.build(made, backend="llvm")
    state, fixed = alone.states.pack(alone.plant.start(c), WIDE), alone.constants.pack(c, WIDE)
    where = kernel.Addresses(key=1, run=np.arange(WIDE), flight=0, scenario=0)
    return lambda samples: compiled.fly(state, fixed, np.full(WIDE, samples), where, first=0, end=samples).state


def _loop(folder: Path) -> Callable[[], int]:
    """The whole loop with law, sensors and two detectors; gives how many samples of flights it flew."""
    path = folder / "six.yaml"
    path.write_text(_TEXT, encoding="utf-8")
    assembly = assemble(read_campaign(path))
    flyer = Flyer(assembly, "llvm")
    flyer.prepare()
    cases = np.arange(assembly.plan.n_cases, dtype=np.int64)
    parts = [assembly.batch(part) for part in cut(assembly.plan, cases, size=COMPILED_CHUNK, jobs=1)]

    def fly() -> int:
        for part in parts:
            flyer.fly(part)
        return 501 * len(cases)

    return fly


def lines(*, repeats: int, turn_s: float) -> Iterator[Line]:
    """The plant, then the loop, over the aircraft of JSBSim; ratios of steps per CPU second, one step a sample of 10 ms."""
    try:
        ways = {name: Way(fly=_jsbsim(name), runs=1) for name, _, _ in PEERS}
    except AbsentError as reason:
        yield Line(what="JSBSim", note=str(reason))
        return
    found = rates({"ours": Way(fly=_plant(), runs=WIDE), **ways}, repeats=repeats, turn_s=turn_s)
    for name, asked, _ in PEERS:
        note = f"ours {np.median(found['ours']) / 1e6:.3g} M/s, theirs {np.median(found[name]) / 1e3:.3g} k/s"
        yield Line(
            what=f"6-DoF plant, JSBSim stepping its {name}", values=found["ours"] / found[name], asked=asked, note=note
        )
    with tempfile.TemporaryDirectory() as folder:
        fly, rate = _loop(Path(folder)), []
        for _ in range(repeats):
            begun = time.process_time()
            flown = fly()
            rate.append(flown / (time.process_time() - begun))
    for name, _, asked in PEERS:
        note = f"ours {np.median(rate) / 1e6:.3g} M/s"
        ratio = np.array(rate) / np.median(found[name])
        yield Line(what=f"  whole loop with two detectors, its {name}", values=ratio, asked=asked, note=note)


def _jsbsim(name: str) -> Callable[[int], object]:
    """An aircraft of JSBSim in the air, its engines running, one step a sample."""
    module = need("jsbsim")
    flight = module.FGFDMExec(None)
    flight.set_debug_level(0)
    flight.load_model(name)
    for key, value in (
        ("ic/h-sl-ft", 20000.0),
        ("ic/vc-kts", 280.0),
        ("ic/theta-deg", 3.0),
        ("propulsion/set-running", -1.0),
    ):
        flight[key] = value
    flight.set_dt(0.01)
    flight.run_ic()

    def fly(samples: int) -> None:
        for _ in range(samples):
            flight.run()

    return fly
