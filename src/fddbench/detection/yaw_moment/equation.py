"""The yaw-moment equation, ``r' = N_v V_a + N_p p + N_r r + N_u u``, with what is measured of its right-hand side.

The sideslip is measured relative to the air, so the gust that drives the moment is measured as well and drops out; in the
side-force equation it would enter with its derivative.
"""

from types import SimpleNamespace

import numpy as np

from fddbench.blocks.functions import sin
from fddbench.blocks.layout import Row, Rows, record
from fddbench.blocks.linear import affine, column, total
from fddbench.flight.lateral_lpv import lateral_lpv
from fddbench.units import DEG_PER_RAD

__all__ = ["NEEDS", "YawAcceleration", "YawMoment"]

NEEDS = (
    "beta_deg", "p_deg_s", "r_deg_s", "surface_deg", "v_tas_m_s", "mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt",
)  # fmt: skip
"""Signals that the equation, and the sensors compared with it, are made of."""
_YAW = 3


@record
class YawAcceleration:
    """Parts of r' but for the damping: of sideslip, roll rate and surfaces [deg/s^2]; and the damping N_r [1/s]."""

    sideslip_deg_s2: Row
    roll_deg_s2: Row
    surfaces_deg_s2: Row
    damping_1_s: Row


class YawMoment:
    """Row of the yaw rate in the published lateral LPV model, scheduled by measured mass, X_cg, altitude and airspeed.

    Surfaces whose moments are the same up to the sign, at every flight condition, are summed before they are multiplied.
    """

    def __init__(self) -> None:
        self.model = lateral_lpv()
        self.state_table = self.model.tables["A"][:, _YAW : _YAW + 1, 1:]
        row = self.model.tables["B"][:, _YAW, :, 0]
        self.groups: list[list[tuple[int, float]]] = []
        for j in range(row.shape[1]):
            for group in self.groups:
                first = row[:, group[0][0]]
                sign = 1.0 if np.array_equal(first, row[:, j]) else -1.0 if np.array_equal(first, -row[:, j]) else 0.0
                if sign:
                    group.append((j, sign))
                    break
            else:
                self.groups.append([(j, 1.0)])
        self.surface_table = column(row[:, np.newaxis, [group[0][0] for group in self.groups]])

    def parts(self, m: SimpleNamespace) -> YawAcceleration:
        """Parts of the yaw acceleration of one sample of the bus."""
        rho = self.model.rho(m.mass_kg, m.x_cg_ratio, m.altitude_ft, m.v_cas_kt)
        n_v, n_p, n_r = affine(self.state_table, rho)[0]
        n_u = affine(self.surface_table, rho)[0]
        moments = [n_u[g] * self._together(m.surface_deg, group) for g, group in enumerate(self.groups)]
        v_y_m_s = m.v_tas_m_s * sin(m.beta_deg / DEG_PER_RAD)
        return YawAcceleration(
            sideslip_deg_s2=DEG_PER_RAD * n_v * v_y_m_s,
            roll_deg_s2=n_p * m.p_deg_s,
            surfaces_deg_s2=DEG_PER_RAD * total(moments),
            damping_1_s=n_r,
        )

    def _together(self, surface_deg: Rows, group: list[tuple[int, float]]) -> Row:
        """Sum of the surfaces of a group [deg], with the signs of their moments."""
        value = surface_deg[group[0][0]]
        for j, sign in group[1:]:
            value = value + surface_deg[j] if sign > 0.0 else value - surface_deg[j]
        return value
