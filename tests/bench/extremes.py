"""All manoeuvres of the twin-jet at all points of Table 5 that it can fly: what they attain, as YAML.

``python -m tests.bench.extremes > reports/transport_6dof/extremes.yaml``; half a minute. Every manoeuvre is flown at each point
with the coefficients as they are, and once more with each of the six drawn from -10 ... 10 %; calm air, noisy sensors.
"""

from itertools import product

import numpy as np

from fddbench.benchmarks.yaw_rate import YawRate
from fddbench.benchmarks.yaw_rate.transport.loop import TransportLoop
from fddbench.benchmarks.yaw_rate.transport.profiles import MANOEUVRES
from fddbench.blocks.block import program
from fddbench.blocks.flown import Addresses
from fddbench.blocks.kernel import Kernel, build
from fddbench.flight.transport.limits import highest_alpha_rad
from fddbench.flight.transport.reading import twin_jet
from fddbench.interfaces import FlightFaults, Flights, Options
from fddbench.interfaces.benchmark import default_choices

__all__ = ["attained", "main"]

GRID = np.array(
    list(product((120e3, 180e3, 233e3), (0.17, 0.30, 0.41), (8e3, 18e3, 28e3, 38e3), (160.0, 220.0, 300.0)))
).T
SIGNALS = {
    "phi_deg": "phi_true_deg", "theta_deg": "theta_true_deg", "beta_deg": "beta_true_deg", "p_deg_s": "p_true_deg_s",
    "r_deg_s": "r_true_deg_s", "n_z_g": "n_z_true_g",
}  # fmt: skip
CHANGES = {"v_cas_change_kt": "v_cas_true_kt", "altitude_change_ft": "altitude_true_ft"}
_ALL = (*SIGNALS.values(), *CHANGES.values(), "alpha_true_deg", "mach")


def _loop() -> TransportLoop:
    bench = YawRate()
    chosen = {**default_choices(bench), "plant": bench.choices["plant"].options["transport_6dof"]}
    return bench.loop(Options(chosen=chosen))


def _kernel(loop: TransportLoop) -> Kernel:
    def shown(seen):
        return {**{name: np.stack([seen.truth[name]]) for name in _ALL}, "departed": np.stack([seen.departed])}

    return build(program(loop, shown=shown), streams=loop.draws.streams, recorded=(*_ALL, "departed"))


def _flown(loop: TransportLoop, kernel: Kernel, manoeuvre: str, deltas: dict[str, np.ndarray]) -> tuple:
    """Which flights can be flown, and their signals."""
    n = GRID.shape[1]
    values = {p.name: np.full(n, p.default) for p in loop.plant.parameters}
    values |= dict(zip(("mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt"), GRID, strict=True)) | deltas
    faults = FlightFaults(lists=[[]], which=np.zeros(n, dtype=int), uniform=np.zeros((0, len(loop.bus.sites), n)))
    normals = loop.before.unpack(np.zeros((loop.before.size, n)))
    ready = loop.prepare(Flights(parameters=values, manoeuvres=[manoeuvre] * n, faults=faults, normals=normals))
    constants = loop.constants.spread(ready.constants, n)
    state = loop.states.pack(loop.states.spread(loop.start(constants), n), n)
    where = Addresses(key=1, run=np.arange(n), flight=np.zeros(n), scenario=np.zeros(n))
    flown = kernel.fly(state, loop.constants.pack(constants, n), np.full(n, 6001), where, first=0, end=6001)
    able = np.array([reason == "" for reason in ready.infeasible_reason])
    return able, {name: rows[:, 0][:, able] for name, rows in flown.recorded.items()}


def attained(loop: TransportLoop, kernel: Kernel, manoeuvre: str, random: np.random.Generator | None) -> dict:
    """Smallest and largest value of each signal over all flights of a manoeuvre."""
    n = GRID.shape[1]
    deltas = {f"delta_c_{axis}_percent": random.uniform(-10.0, 10.0, n) for axis in "xyzlmn"} if random else {}
    able, signals = _flown(loop, kernel, manoeuvre, deltas)
    zero = twin_jet().lift.alpha_zero_deg
    to_buffet = (signals["alpha_true_deg"] - zero) / (np.rad2deg(highest_alpha_rad(twin_jet(), signals["mach"])) - zero)
    found = {"flights": int(able.sum()), "departed": int(signals["departed"].any(0).sum())}
    found |= {name: _range(signals[signal]) for name, signal in SIGNALS.items()}
    found |= {name: _range(signals[signal] - signals[signal][0]) for name, signal in CHANGES.items()}
    return found | {"mach_most": _short(signals["mach"].max()), "alpha_share_most": _short(to_buffet.max())}


def _range(values: np.ndarray) -> list[float]:
    return [_short(values.min()), _short(values.max())]


def _short(value: float) -> float:
    return float(f"{value:.3g}")


_HEAD = """# What all manoeuvres of transport_6dof attain at the 81 points of Table 5 that can be flown: smallest, largest.
# alpha_share: of the way from zero lift to buffet. Made by python -m tests.bench.extremes"""


def main() -> None:
    """Print the table, a manoeuvre a line."""
    loop = _loop()
    kernel = _kernel(loop)
    print(_HEAD)
    for what, seed in (("as_they_are", None), ("coefficients_within_10_percent", 7)):
        random = None if seed is None else np.random.default_rng(seed)
        print(f"{what}:")
        for name in MANOEUVRES:
            found = attained(loop, kernel, name, random)
            print(f"  {name}: {{{', '.join(f'{key}: {value}' for key, value in found.items())}}}")


if __name__ == "__main__":
    main()
