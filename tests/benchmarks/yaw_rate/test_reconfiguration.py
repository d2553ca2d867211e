"""A campaign that says `reconfigure`: from the next sample on declared sensors leave the vote, nothing else changes."""

from dataclasses import replace

import numpy as np
import pytest
import yaml

from fddbench.benchmarks.yaw_rate.plants.lateral_lpv import LateralLpvPlant
from fddbench.testing.campaigns import flown, some_flights

JAM = {"kind": "jam", "sites": ["r1"], "onset_s": 0.5, "amplitude_percent": 10.0}
SIGNALS = [f"measured:{name}" for name in ("r_deg_s", "r_voted_deg_s", "p_deg_s", "surface_deg")]


def flights(tmp_path, *overrides, **more):
    """Three healthy flights and three with a jammed sensor, and what is to be seen of them."""
    campaign = {
        "name": "acting", "benchmark": "yaw_rate", "seed": 3, "wind": "light", "duration_s": 2.0,
        "detectors": ["voting_monitor"],
        "scenarios": [{"name": "healthy", "manoeuvre": "cruise"}, {"name": "jam", "manoeuvre": "cruise", "faults": [JAM]}],
        "dispersions": {"monte_carlo": {"runs": 3}}, **more,
    }  # fmt: skip
    path = tmp_path / "acting.yaml"
    path.write_text(yaml.safe_dump(campaign))
    assembly, batch = some_flights(path, overrides, most=6)
    return batch, flown(assembly, batch, SIGNALS, backend="llvm").recorded


@pytest.mark.parametrize(
    "chosen",
    [{"sensors": "white"}, {"sensors": "iru", "voter": "monitored"}, {"plant": "transport_6dof", "sensors": "iru"}],
    ids=["white", "monitored units", "six degrees"],
)
def test_the_vote_goes_on_without_what_is_declared_and_undeclared_flights_keep_their_bits(tmp_path, chosen):
    _, plain = flights(tmp_path, **chosen)
    batch, acting = flights(tmp_path, "reconfigure=voting_monitor", **chosen)
    healthy = batch.scenario == 0
    assert healthy.sum() == 3
    declared = 151  # jammed from sample 50 on, confirmed for 1 s, acted on from the next sample on
    for name in SIGNALS:
        assert plain[name][:, :, healthy].tobytes() == acting[name][:, :, healthy].tobytes()
        assert plain[name][:declared].tobytes() == acting[name][:declared].tobytes()
    r, voted = (acting[f"measured:{name}"][declared:, :, ~healthy] for name in ("r_deg_s", "r_voted_deg_s"))
    assert np.array_equal(voted[:, 0], 0.5 * (r[:, 1] + r[:, 2]))


def test_who_else_is_declared_leaves_its_own_vote_and_all_declared_are_voted_as_before(bench):
    loop = bench.loop(sensors="iru")
    constants, state = bench.start(loop, 3, normals=np.random.default_rng(2).normal(size=(loop.before.size, 3)))
    draws = loop.draws.unpack(np.random.default_rng(5).normal(size=(loop.draws.size, 3)))
    declared = np.zeros((9, 3))
    declared[[0, 4, 6], 1] = 1.0  # r1, phi2, p1
    declared[:, 2] = 1.0
    (_, plain), (_, seen) = (loop.step(state, constants, draws, 0.0, told) for told in (None, declared))
    plain, seen = plain.measured, seen.measured
    for units, voted, left in (("r_deg_s", "r_voted_deg_s", [1, 2]), ("phi_units_deg", "phi_deg", [0, 2]),
                               ("p_units_deg_s", "p_deg_s", [1, 2])):  # fmt: skip
        before, now = getattr(plain, voted), getattr(seen, voted)
        assert now[[0, 2]].tolist() == before[[0, 2]].tolist()
        assert now[1] == pytest.approx(getattr(seen, units)[left, 1].mean(), abs=1e-15)
        assert now[1] != before[1]


def test_a_surface_that_is_declared_changes_no_vote(bench):
    rudder = replace(LateralLpvPlant.sites[0], name="rudder", signal="surface_deg", kind="actuator", unit_name="deg")

    class WithRudder(LateralLpvPlant):
        sites = (rudder, *LateralLpvPlant.sites)

    loop = bench.loop(plant=WithRudder, sensors="white")
    constants, state = bench.start(loop, 1)
    draws = loop.draws.unpack(np.random.default_rng(5).normal(size=(loop.draws.size, 1)))
    told = np.array([[1.0], [0.0], [1.0], [0.0]])
    _, seen = loop.step(state, constants, draws, 0.0, told)
    r = seen.measured.r_deg_s[:, 0]
    assert seen.measured.r_voted_deg_s[0] == 0.5 * (r[0] + r[2])
