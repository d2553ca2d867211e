"""The two lateral equations that a yaw rate must agree with, scheduled over the flight condition."""

from functools import reduce
from operator import mul
from types import SimpleNamespace

import numpy as np

from fddbench.blocks.layout import Row, Rows, record
from fddbench.blocks.linear import column, total
from fddbench.detection.yaw_rate_best.gains import LateralTable
from fddbench.units import RAD_PER_DEG

__all__ = ["Drives", "LateralModel"]


@record
class Drives:
    """What moves the aircraft apart from its yaw rate, (n_cases,) each.

    Attributes
    ----------
    yaw_deg_s2 : row
        Yaw acceleration.
    yaw_per_beta : row
        Its part per sideslip [1/s^2].
    yaw_per_r : row
        Yaw acceleration per yaw rate [1/s].
    slip_deg_s : row
        Rate of the path angle, side velocity over the ground by airspeed.
    slip_per_r : row
        The same per yaw rate [-], about -1.
    """

    yaw_deg_s2: Row
    yaw_per_beta: Row
    yaw_per_r: Row
    slip_deg_s: Row
    slip_per_r: Row


class LateralModel:
    """Yaw moment and side force of a `LateralTable`.

    ``r' = N_v V beta + N_p p + N_r r + N_u u`` and ``(v/V)' = (Y_phi phi + Y_p p + Y_r r + Y_u u) / V + Y_v beta``, with the
    sideslip through the air, which a vane measures: a gust moves both sides of these alike.
    """

    def __init__(self, table: LateralTable) -> None:
        self.table = table
        self.centre, self.per_width = column(table.centre), column([1.0 / width for width in table.half_width])

    def coefficients(self, mass_kg: Row, x_cg_ratio: Row, altitude_ft: Row, v_cas_kt: Row) -> tuple[Rows, Rows]:
        """Rows of yaw, (7, n_cases), and of side acceleration, (8, n_cases), in the units of the table."""
        at = (np.stack([mass_kg, x_cg_ratio, altitude_ft, v_cas_kt]) - self.centre) * self.per_width
        monomials = [reduce(mul, [at[j] for j in range(4) for _ in range(a[j])]) for a in self.table.powers[1:]]

        def of(rows: tuple[tuple[float, ...], ...]) -> Rows:
            return np.stack([_polynomial(row, monomials) + 0.0 * mass_kg for row in rows])

        return of(self.table.yaw), of(self.table.side)

    def drives(self, measured: SimpleNamespace) -> Drives:
        """Drives of the measured signals of a sample."""
        m = measured
        yaw, side = self.coefficients(m.mass_kg, m.x_cg_ratio, m.altitude_ft, m.v_cas_kt)
        controls = _controls(m.surface_deg)
        per_speed = 1.0 / m.v_tas_m_s
        phi = m.phi_deg
        if self.table.bank_cubic:
            phi = phi - (self.table.bank_cubic * RAD_PER_DEG**2) * (phi * phi * phi)
        yaw_per_beta = yaw[0] * m.v_tas_m_s
        force = side[0] * phi + side[2] * m.p_deg_s + total(side[4:] * controls)
        return Drives(
            yaw_deg_s2=yaw_per_beta * m.beta_deg + yaw[1] * m.p_deg_s + total(yaw[3:] * controls),
            yaw_per_beta=yaw_per_beta,
            yaw_per_r=yaw[2],
            slip_deg_s=force * per_speed + side[1] * m.beta_deg,
            slip_per_r=side[3] * per_speed,
        )


def _polynomial(row: tuple[float, ...], monomials: list[Row]) -> Row:
    """Value of a row of the table; terms without a coefficient are left out."""
    terms = [value * monomial for value, monomial in zip(row[1:], monomials, strict=True) if value]
    return reduce(lambda left, right: left + right, terms, row[0])


def _controls(surface_deg: Rows) -> Rows:
    """Rudder, aileron 1 less 2, 3 less 4, odd less even spoilers [deg], (4, n_cases)."""
    s = surface_deg
    spoilers = s[5] - s[6] + s[7] - s[8] + s[9] - s[10] + s[11] - s[12]
    return np.stack([s[0], s[1] - s[2], s[3] - s[4], spoilers])
