"""Contract: the same bits compiled, interpreted, with plain NumPy, in any company, and told that nothing is declared."""

import numpy as np
import pytest

from fddbench.blocks import llvm
from fddbench.faults.disconnection import Disconnection
from fddbench.faults.effectiveness import Effectiveness

LOSS = {"kind": "effectiveness", "onset_s": 0.8, "loss_percent": 20.0}
FAULTS = [
    [],
    [Effectiveness.in_unit("deg")(sites=("elevator",), **LOSS), Effectiveness.in_unit("N")(sites=("thrust",), **LOSS)],
    [Disconnection.in_unit("deg")(kind="disconnection", sites=("elevator",), onset_s=0.4)],
]
COMBINATIONS = (
    {"plant": "nonlinear", "law": "hinf", "sensors": "realistic", "wind": "moderate"},
    {"plant": "lpv_fold", "law": "scheduled", "sensors": "white", "wind": "severe"},
    {"plant": "lpv_approx", "law": "lqi", "wind": "light"},
    {"plant": "nonlinear", "law": "open_loop"},
)
FLIGHTS = {
    "faults": FAULTS,
    "manoeuvre": "elevator_pulse",
    "mass_kg": [240e3, 263e3, 290e3],
    "v_tas_m_s": [230, 241, 250],
}


@pytest.mark.parametrize("chosen", COMBINATIONS, ids=lambda chosen: "-".join(chosen.values()))
def test_every_way_of_flying_gives_the_same_bits(bench, chosen):
    loop = bench.loop(faults=FAULTS, **chosen)
    plain = bench.fly(loop, 3, 2.0, backend="numpy", declared_from_s=0.6, **FLIGHTS)
    assert np.isfinite(plain["alpha_deg"]).all()
    if llvm.available():
        compiled = bench.fly(loop, 3, 2.0, backend="llvm", declared_from_s=0.6, **FLIGHTS)
        for name, rows in plain.items():
            assert rows.tobytes() == compiled[name].tobytes(), name
    silent = bench.fly(loop, 3, 6.0, declared_from_s=1e9, **FLIGHTS)
    untold = bench.fly(loop, 3, 6.0, **FLIGHTS)
    for name, rows in untold.items():
        assert rows.tobytes() == silent[name].tobytes(), name


@pytest.mark.parametrize("chosen", COMBINATIONS, ids=lambda chosen: "-".join(chosen.values()))
def test_steps_of_plain_numpy_are_the_traced_ones_alone_and_in_company(bench, chosen):
    """The step itself, eagerly, on three flights and on one of them."""
    loop = bench.loop(faults=FAULTS, **chosen)
    flown = {}
    for which in ([0, 1, 2], [2]):
        given = {name: [values[j] for j in which] for name, values in FLIGHTS.items() if name != "manoeuvre"}
        prepared = bench.prepare(loop, len(which), manoeuvre="elevator_pulse", **given)
        constants = loop.constants.spread(prepared.constants, len(which))
        x = loop.states.spread(loop.start(constants), len(which))
        draws = np.random.default_rng(3).normal(size=(40, loop.draws.size, 3))[:, :, which]
        for k in range(40):
            x, seen = loop.step(x, constants, loop.draws.unpack(draws[k]), np.float64(k))
        flown[len(which)] = np.concatenate([loop.states.pack(x, len(which)), seen.added])
    assert flown[3][:, 2:].tobytes() == flown[1].tobytes()
