"""Contract: the benchmark with every option of its choices, both plants in all their manoeuvres, the same bits everywhere."""

import numpy as np
import pytest
import yaml

from fddbench.testing import check_benchmark
from fddbench.testing.campaigns import different_bits, some_flights


def test_benchmark_keeps_the_contract():
    check_benchmark("yaw_rate", duration_s=0.2)


@pytest.mark.parametrize("plant", ["lateral_lpv", "transport_6dof"])
def test_inertial_units_have_the_same_bits_in_all_engines_and_are_the_same_in_every_scenario(tmp_path, plant):
    """Also with a unit lost whole, in turbulence: NumPy, compiled, alone and in company."""
    lost = [
        {"kind": "jam", "sites": [f"{name}2"], "onset_s": 0.3, "amplitude_percent": 10.0} for name in ("phi", "p", "r")
    ]
    scenarios = [{"name": "healthy", "manoeuvre": "cruise"}, {"name": "lost", "manoeuvre": "cruise", "faults": lost}]
    campaign = {
        "name": "units", "benchmark": "yaw_rate", "plant": plant, "sensors": "iru", "wind": "light", "seed": 3,
        "duration_s": 0.6, "detectors": ["voting_monitor"], "scenarios": scenarios,
        "dispersions": {"monte_carlo": {"runs": 3}},
    }  # fmt: skip
    path = tmp_path / "units.yaml"
    path.write_text(yaml.safe_dump(campaign))
    assembly, batch = some_flights(path, [], most=6)
    recorded = [f"measured:{name}" for name in assembly.loop.bus.signals]
    assert not different_bits(assembly, batch, recorded)
    found = {(s, r): batch.constants[:, j] for j, (s, r) in enumerate(zip(batch.scenario, batch.run, strict=True))}
    errors = [j for j, name in enumerate(assembly.loop.constants.names) if name.startswith("sensors.")]
    assert len(errors) > 20
    for run in range(3):
        healthy, broken = (found[s, run][errors] for s in (0, 1))
        assert np.array_equal(healthy, broken)
        assert not np.array_equal(healthy, found[0, (run + 1) % 3][errors])
