"""The shipped gains of the six-degree-of-freedom law are those of the recipe, and hold over the envelope."""

from itertools import product

import numpy as np
import pytest
import yaml

from fddbench.benchmarks.yaw_rate.transport.gains import LAW, Gains, Schedule, read_law
from fddbench.design.transport_law import REFERENCE_PA, damping, points, power_laws, scheduled
from fddbench.errors import DesignError
from fddbench.flight.envelope import infeasible_reasons
from fddbench.flight.transport.reading import twin_jet

SHIPPED = yaml.safe_load(LAW.read_text(encoding="utf-8"))
GRID = np.array(
    list(product((120e3, 180e3, 233e3), (0.17, 0.30, 0.41), (8e3, 18e3, 28e3, 38e3), (160.0, 220.0, 300.0)))
).T
FLOWN = GRID[:, [reason == "" for reason in infeasible_reasons(GRID[0], GRID[2], GRID[3])]]


def test_recipe_gives_the_shipped_gains():
    assert FLOWN.shape[1] == 81
    assert SHIPPED["reference_pressure_pa"] == REFERENCE_PA
    laws = power_laws(twin_jet(), FLOWN)
    for name, law in laws.items():
        shipped = SHIPPED["gains"][name]
        assert shipped["value"] == pytest.approx(law["value"], rel=2e-3), name
        assert shipped["exponent"] == pytest.approx(law["exponent"], abs=2e-3), name


@pytest.mark.parametrize("percent", [-10.0, 0.0, 10.0])
def test_loop_with_delay_and_actuators_is_well_damped_over_the_envelope(percent):
    """Attained: lateral 0.38, 0.43, 0.47; longitudinal 0.45, 0.49, 0.50."""
    deltas = {axis: np.full(FLOWN.shape[1], percent / 100.0) for axis in "xyzlmn"}
    bandwidth = twin_jet().actuators.bandwidth_rad_s
    found = []
    for point in points(twin_jet(), FLOWN, deltas):
        gains = np.array(list(scheduled(SHIPPED["gains"], point.pressure_pa).values()))
        side = damping(point.lateral, gains[:10].reshape(2, 5), bandwidth_rad_s=bandwidth)
        plane = damping(point.longitudinal, -gains[10:].reshape(1, 3), bandwidth_rad_s=bandwidth)
        found.append((*side, *plane))
    lateral, slowest, longitudinal, slowest_pitch = np.min(found, axis=0)
    assert lateral > 0.36
    assert longitudinal > 0.42
    assert slowest > 0.25
    assert slowest_pitch > 0.25


def test_a_schedule_is_the_power_law_between_its_knots():
    k = read_law(LAW).at(np.array([4000.0, 12960.0, 17000.0]))
    for name in Gains._fields:
        law = SHIPPED["gains"][name]
        exact = law["value"] * (np.array([4000.0, 12960.0, 17000.0]) / REFERENCE_PA) ** law["exponent"]
        np.testing.assert_allclose(getattr(k, name), exact, rtol=5e-3)


def test_a_law_without_a_gain_is_refused():
    gains = {name: law for name, law in SHIPPED["gains"].items() if name != "roll_p"}
    with pytest.raises(DesignError, match=r"a law needs reference_pressure_pa and the gains roll_phi.*no \['roll_p'\]"):
        Schedule({**SHIPPED, "gains": gains})
