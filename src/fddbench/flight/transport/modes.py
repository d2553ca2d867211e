"""Trim and natural modes of the aircraft without its laws, over flight conditions."""

import numpy as np
import numpy.typing as npt

from fddbench.blocks.layout import Rows
from fddbench.flight.atmosphere import FT_M, GRAVITY_M_S2, true_airspeed_m_s
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.body import body_of
from fddbench.flight.transport.linear import LATERAL, LONGITUDINAL, linearised
from fddbench.flight.transport.trim import trim
from fddbench.units import DEG_PER_RAD

__all__ = ["COLUMNS", "modes_of"]

Floats = npt.NDArray[np.float64]
COLUMNS = (
    *("alpha_deg", "stabiliser_deg", "thrust_ratio"),
    *("short_period_rad_s", "short_period_damping", "n_alpha_g_rad", "anticipation_1_g_s2"),
    *("dutch_roll_rad_s", "dutch_roll_damping", "roll_1_s", "spiral_1_s"),
)
"""Trim; the faster oscillation in pitch, load factor over incidence and the control anticipation parameter (frequency squared
over it, MIL-F-8785C); dutch roll, and the real modes of roll and spiral."""


def modes_of(aircraft: Aircraft, condition: Rows) -> dict[str, Floats]:
    """`COLUMNS` of flight conditions, (n,) each; a mode that does not oscillate has not-a-number.

    Parameters
    ----------
    condition : (4, n) array
        Mass [kg], centre of gravity [-], altitude [ft], calibrated airspeed [kt].
    """
    mass, x_cg, altitude, v_cas = condition
    body = body_of(aircraft, mass, x_cg)
    at = trim(aircraft, body, true_airspeed_m_s(v_cas, altitude), altitude * FT_M)
    linear = linearised(aircraft, body, at)
    plane, _ = linear.part(LONGITUDINAL, ("elevator",))
    side, _ = linear.part(LATERAL, ("rudder",))
    rows = []
    for i, v in enumerate(at.v_tas_m_s.tolist()):
        frequency, damping = _oscillation(np.linalg.eigvals(plane[..., i]))
        n_alpha = -plane[1, 1, i] * v / GRAVITY_M_S2
        roots = np.linalg.eigvals(side[..., i])
        real = np.sort(roots[np.abs(roots.imag) < 1e-9].real)
        roll, spiral = (real[0], real[-1]) if len(real) == 2 else (np.nan, np.nan)
        rows.append((frequency, damping, n_alpha, frequency**2 / n_alpha, *_oscillation(roots), roll, spiral))
    trimmed = (DEG_PER_RAD * at.alpha_rad, DEG_PER_RAD * at.stabiliser_rad, at.thrust_ratio)
    return dict(zip(COLUMNS, (*trimmed, *np.array(rows, dtype=float).T), strict=True))


def _oscillation(roots: npt.NDArray[np.complex128]) -> tuple[float, float]:
    """Frequency [rad/s] and damping [-] of the fastest oscillation."""
    found = roots[roots.imag > 1e-9]
    if not len(found):
        return float("nan"), float("nan")
    fastest = found[np.argmax(np.abs(found))]
    return float(np.abs(fastest)), float(-fastest.real / np.abs(fastest))
