"""Travel of the control surfaces; that of the rudder falls with dynamic pressure."""

import numpy as np

from fddbench.blocks.layout import Row, Rows
from fddbench.flight.transport.aircraft import Actuation

__all__ = ["rates_deg_s", "rudder_travel_deg", "travel_deg"]


def rudder_travel_deg(actuators: Actuation, v_cas_kt: Row) -> Row:
    """Travel of the rudder [deg]: full up to a speed, then falling linearly in 1 / q (so in 1 / V_cas^2) to the least."""
    full, least = actuators.rudder_full_kt**-2, actuators.rudder_least_kt**-2
    share = (1.0 / (v_cas_kt * v_cas_kt) - least) / (full - least)
    limited = np.minimum(np.maximum(share, 0.0), 1.0)
    return actuators.rudder_least_deg + limited * (actuators.rudder.high_deg - actuators.rudder_least_deg)


def _fifteen(aileron: float, spoiler: float, elevator: float, stabiliser: float) -> list[float]:
    """Of four ailerons, eight spoilers, two elevators and the stabiliser."""
    return [aileron] * 4 + [spoiler] * 8 + [elevator] * 2 + [stabiliser]


def travel_deg(actuators: Actuation, v_cas_kt: Row) -> tuple[Rows, Rows]:
    """Lowest and highest positions [deg], (16, n_cases): rudder, 4 ailerons, 8 spoilers, 2 elevators, stabiliser."""
    a, rudder, one = actuators, rudder_travel_deg(actuators, v_cas_kt), np.ones_like(v_cas_kt)
    low = _fifteen(a.aileron.low_deg, a.spoiler.low_deg, a.elevator.low_deg, a.stabiliser.low_deg)
    high = _fifteen(a.aileron.high_deg, a.spoiler.high_deg, a.elevator.high_deg, a.stabiliser.high_deg)
    return np.stack([-rudder, *(each * one for each in low)]), np.stack([rudder, *(each * one for each in high)])


def rates_deg_s(actuators: Actuation) -> np.ndarray:
    """Rate limits [deg/s], (16, 1)."""
    a = actuators
    rest = _fifteen(a.aileron.rate_deg_s, a.spoiler.rate_deg_s, a.elevator.rate_deg_s, a.stabiliser.rate_deg_s)
    return np.array([[a.rudder.rate_deg_s], *([each] for each in rest)])
