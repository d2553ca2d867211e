"""Laws of many points of the envelope as one: gains over dynamic pressure."""

from collections.abc import Sequence

import numpy as np

from fddbench.design.tracking.aircraft import FlightPoint, linear_aircrafts
from fddbench.errors import DesignError
from fddbench.flight.b747.airframe import DATA
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["envelope_points", "fitted"]


def envelope_points(v_tas_m_s: Sequence[float], altitude_m: Sequence[float]) -> list[FlightPoint]:
    """Points of a grid that can be flown: those with a trim at an angle of attack within the box of Table B1."""
    low, high = DATA["envelope"]["alpha_deg"]
    grid = [FlightPoint(altitude_m=h, v_tas_m_s=v) for h in altitude_m for v in v_tas_m_s]
    flying = linear_aircrafts(grid)
    return [at for at, here in zip(grid, flying, strict=True) if here is not None and low <= here.alpha_deg <= high]


def fitted(points: Sequence[FlightPoint], laws: Sequence[StateSpace], knots_pa: Floats) -> tuple[Floats, Floats]:
    """C and D at the knots, (n_knots, 2, n_x) and (n_knots, 2, n_y): closest to the laws of the points in the mean square.

    Between knots they are linear in dynamic pressure, held outside.
    """
    pressures = np.array([point.dynamic_pressure_pa for point in points])
    hats = np.stack([np.interp(pressures, knots_pa, row) for row in np.eye(len(knots_pa))], axis=1)
    if np.linalg.matrix_rank(hats) < len(knots_pa):
        raise DesignError(
            f"no point of the envelope lies near one of the knots {np.asarray(knots_pa).tolist()} Pa; points have "
            f"{pressures.min():.0f} to {pressures.max():.0f} Pa. Take the knot away, or a finer grid"
        )
    gains = np.stack([np.concatenate([law.C.ravel(), law.D.ravel()]) for law in laws])
    at_knots, *_ = np.linalg.lstsq(hats, gains, rcond=None)
    n_c = laws[0].C.size
    shape_c, shape_d = laws[0].C.shape, laws[0].D.shape
    return at_knots[:, :n_c].reshape(-1, *shape_c), at_knots[:, n_c:].reshape(-1, *shape_d)
