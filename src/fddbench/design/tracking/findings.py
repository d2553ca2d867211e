"""What a law file says of its law: margins, stability over the envelope, and responses of the nonlinear aircraft."""

from itertools import product
from typing import Any

import numpy as np

from fddbench.benchmarks.b747_longitudinal.laws.law_file import OUTPUTS, TrackingLaw
from fddbench.design.recipes.recipe import short
from fddbench.design.tracking.aircraft import FlightPoint, linear_aircraft, linear_aircrafts
from fddbench.design.tracking.closed_loop import actuated, disk_margin, gains_at, sampled_decay_1_s
from fddbench.design.tracking.reference import settling_s
from fddbench.design.tracking.response import Story, fly
from fddbench.flight.b747.airframe import DATA, aircraft

__all__ = ["SAMPLE_S", "findings", "slowest_decays_1_s", "step_responses"]

SAMPLE_S = 0.04
"""Clock that stability is checked on, the slowest that the benchmark is meant for [s]."""
_DELAY_S = 1.5 * SAMPLE_S  # one sample, and half of one for the hold
_STEPS = (2.0, 5.0)
"""Steps of flight path [deg] and speed [m/s]."""
_PERCENT = 10.0


def findings(law: TrackingLaw, *points: FlightPoint) -> dict[str, Any]:
    """All of it at the design point; stability at these points."""
    at = FlightPoint(**DATA["design_point"])
    flying, gains = linear_aircraft(at), gains_at(law, at.dynamic_pressure_pa)
    margins = {
        name: {order: short(disk_margin(plant, gains, order, delay_s=_DELAY_S)) for order in OUTPUTS}
        for name, plant in (
            ("disk_margin", actuated(flying)),
            ("disk_margin_stabiliser", actuated(flying, law.handover)),
        )
    }
    by_elevator, by_stabiliser = slowest_decays_1_s(law, *points)
    return {
        **margins,
        "slowest_decay_1_s": short(by_elevator),
        "slowest_decay_stabiliser_1_s": short(by_stabiliser),
        "nonlinear": step_responses(law, at),
        "nonlinear_stabiliser": step_responses(law, at, stabiliser=True),
    }


def slowest_decays_1_s(law: TrackingLaw, *points: FlightPoint) -> tuple[float, float]:
    """Decay of the slowest mode [1/s], pitch by elevator and by stabiliser.

    The least of all points and of all corners of ± 10 % of C_L, C_D, C_m and C_m of the elevator.
    """
    found = [float("inf"), float("inf")]
    for corner in product((-_PERCENT, _PERCENT), repeat=4):
        names = ("delta_c_l_percent", "delta_c_d_percent", "delta_c_m_percent", "delta_c_m_elevator_percent")
        rows = {name: np.full(len(points), value) for name, value in zip(names, corner, strict=True)}
        flying = linear_aircrafts(points, aircraft(np.full(len(points), DATA["inertia"]["mass_kg"]), **rows))
        for at, here in zip(points, flying, strict=True):
            gains = gains_at(law, at.dynamic_pressure_pa)
            for i, handover in enumerate((None, law.handover)):
                if here is not None:
                    found[i] = min(found[i], sampled_decay_1_s(actuated(here, handover), gains, sample_s=SAMPLE_S))
    return found[0], found[1]


def step_responses(law: TrackingLaw, at: FlightPoint, *, stabiliser: bool = False) -> dict[str, float]:
    """Settling of a step of each command alone, what it does to the other, and what is left of the error at the end.

    Flight path 2 deg, speed 5 m/s; settled within 5 % of the step.
    """
    begin, end = 5.0, 150.0
    from_s = 1.0 if stabiliser else float("inf")
    path = Story(
        duration_s=end, flight_path_deg=lambda t: _STEPS[0] * (t >= begin), jumps_s=(begin,), handover_s=from_s
    )
    speed = Story(duration_s=end, speed_m_s=lambda t: _STEPS[1] * (t >= begin), jumps_s=(begin,), handover_s=from_s)
    up, faster = fly(law, at, path), fly(law, at, speed)
    return {
        "flight_path_settling_s": short(settling_s(up.time_s, up["flight_path_deg"], _STEPS[0], from_s=begin)),
        "speed_settling_s": short(settling_s(faster.time_s, faster["speed_m_s"], _STEPS[1], from_s=begin)),
        "speed_by_flight_path_m_s": short(float(np.abs(up["speed_m_s"]).max())),
        "flight_path_by_speed_deg": short(float(np.abs(faster["flight_path_deg"]).max())),
        "flight_path_left_deg": short(float(up["flight_path_deg"][-1]) - _STEPS[0]),
        "speed_left_m_s": short(float(faster["speed_m_s"][-1]) - _STEPS[1]),
    }
