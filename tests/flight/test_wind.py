"""What all winds keep: every component is there, calm air costs nothing, and machine code flies what NumPy flies."""

import numpy as np
import pytest

from fddbench.blocks.block import program
from fddbench.blocks.flown import Addresses
from fddbench.blocks.kernel import build
from fddbench.blocks.layout import leaves
from fddbench.flight.dryden import LONGITUDINAL_WINDS, SIX_COMPONENT_WINDS
from fddbench.flight.one_minus_cosine import OneMinusCosine
from fddbench.flight.rotating_gust import LATERAL_WINDS
from fddbench.flight.wind import CalmAir, Encounter, still

N = 7
EVERY = {
    "lateral": LATERAL_WINDS["severe"],
    "six": SIX_COMPONENT_WINDS["moderate"],
    "longitudinal": LONGITUDINAL_WINDS["light"],
    "hump": OneMinusCosine("up", 0.3),
    "calm": CalmAir(),
}
MEETS = Encounter(
    v_tas_m_s=np.linspace(100.0, 260.0, N), scale_ratio=np.linspace(0.5, 1.5, N), altitude_m=8000.0, span_m=60.3
)


class Fed:
    """A wind as a block that is fed with the number of the sample."""

    def __init__(self, wind):
        self.wind, self.states, self.constants, self.draws = wind, wind.states, wind.constants, wind.draws

    def start(self, c):
        return self.wind.start(c)

    def step(self, x, c, n, sample):
        return self.wind.step(x, c, n, sample, like=0.0 * sample)


@pytest.mark.parametrize("name", EVERY)
def test_machine_code_flies_as_numpy_does(name):
    wind = EVERY[name]
    normals = wind.before.unpack(np.random.default_rng(3).normal(size=(wind.before.size, N)))
    c = wind.prepare(normals, MEETS, 0.01)
    rows = wind.constants.pack(c, N), wind.states.pack(wind.states.spread(wind.start(c), N), N)
    traced = program(Fed(wind), shown=lambda air: dict(leaves(air)))
    flights = {
        "constants": rows[0],
        "samples": np.full(N, 90),
        "addresses": Addresses(key=11, run=np.arange(N), flight=1, scenario=np.zeros(N, dtype=int)),
    }
    moving = tuple(name for name, _ in leaves(still(np.zeros(1))))
    found = []
    for backend in ("numpy", "auto"):
        kernel = build(traced, streams=wind.draws.streams, recorded=moving, backend=backend)
        found.append(kernel.fly(rows[1], **flights, first=0, end=90))
    for one in moving:
        assert found[0].recorded[one].tobytes() == found[1].recorded[one].tobytes()
    assert found[0].state.tobytes() == found[1].state.tobytes()
    moved = {one for one in moving if np.any(found[0].recorded[one])}
    expected = {
        "lateral": "v_m_s p_rad_s r_rad_s",
        "six": " ".join(moving),
        "longitudinal": "u_m_s w_m_s q_rad_s",
        "hump": "w_m_s",
    }
    assert moved == set(expected.get(name, "").split())


@pytest.mark.parametrize("name", EVERY)
def test_a_flight_alone_meets_the_same_air(name):
    wind = EVERY[name]
    rows = np.random.default_rng(3).normal(size=(wind.before.size, N))
    together = wind.constants.pack(wind.prepare(wind.before.unpack(rows), MEETS, 0.01), N)
    for i in range(N):
        own = Encounter(**{key: np.broadcast_to(value, N)[[i]] for key, value in vars(MEETS).items()})
        alone = wind.constants.pack(wind.prepare(wind.before.unpack(rows[:, [i]]), own, 0.01), 1)
        assert alone.tobytes() == np.ascontiguousarray(together[:, [i]]).tobytes()


def test_calm_air_costs_nothing_and_is_still():
    calm = CalmAir()
    assert [layout.size for layout in (calm.states, calm.constants, calm.draws, calm.before)] == [0, 0, 0, 0]
    c = calm.prepare(np.zeros((0, 3)), Encounter(v_tas_m_s=np.full(3, 200.0)), 0.01)
    _, air = calm.step(calm.start(c), c, None, np.float64(0.0), like=np.full(3, 7.0))
    assert [row.tolist() for _, row in leaves(air)] == [[0.0, 0.0, 0.0]] * 6
