"""The published lateral LPV model: x = [phi, V_y, p, r], 13 surfaces, affine in mass, X_cg, altitude and airspeed."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from fddbench.blocks.functions import atan2, cos, sin
from fddbench.blocks.layout import Rows
from fddbench.blocks.linear import affine, column, product
from fddbench.systems import AffineLpv

__all__ = ["SCHEDULING", "LateralLpv", "derivatives", "lateral_lpv"]

SCHEDULING = ("mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt")
"""Scheduling parameters in the order of rho, with their units."""


@dataclass(frozen=True, eq=False, kw_only=True)
class LateralLpv(AffineLpv):
    """``xdot = A(rho) x + B(rho) u`` with x = [phi rad, V_y m/s, p rad/s, r rad/s] and u in degrees.

    The tables are A, (5, 4, 4, 1), and B, (5, 4, 13, 1), of the appendix of the yaw-rate paper; its box is ``|rho| <= 1``.

    Attributes
    ----------
    surfaces : tuple of str
        Names of the 13 surfaces; positive rudder gives Y > 0 and N < 0, odd spoilers roll left.
    """

    surfaces: tuple[str, ...]

    def trim_speeds_m_s(self, rho: Rows, v_tas_m_s: Rows) -> tuple[Rows, Rows]:
        """Kinematic speeds ``U0 = V cos alpha0`` and ``W0 = V sin alpha0`` [m/s], with tan alpha0 = A(phi, r)."""
        alpha_rad = atan2(affine(self.tables["A"][:, :1, 3:], rho)[0, 0], np.ones_like(v_tas_m_s))
        return v_tas_m_s * cos(alpha_rad), v_tas_m_s * sin(alpha_rad)


def derivatives(
    A: Rows,
    B: Rows,
    u: Rows,
    *,
    u0_m_s: Rows,
    w0_m_s: Rows,
    gust_m_s: Rows,
    delta: tuple[Rows, Rows, Rows],
    rotation_rad_s: tuple[Rows, Rows] | None = None,
    gust_yaw: Rows | None = None,
) -> tuple[Rows, Rows]:
    """Scaled matrix and the constant part of ``xdot`` while the surfaces and the gust stand still.

    The aerodynamic deltas ``delta = (dC_Y, dC_l, dC_n)`` [-] scale A(2,2), B(2,:) and the aerodynamic parts
    ``A(2,3) - V sin alpha0`` and ``A(2,4) + V cos alpha0``; A(3,2:4), B(3,:); A(4,2:4), B(4,:). Gravity and kinematics
    are never scaled. V_y enters the aerodynamics relative to the air: ``V_y - gust``; where the air rotates, so do
    ``p - p_g`` and ``r - r_g`` of `rotation_rad_s`, in the aerodynamic parts. The yawing moment of the gust alone is ``1 +
    gust_yaw`` times what A(4,2) says.

    Returns
    -------
    (4, 4, n_cases) and (4, n_cases) rows
        Matrix M and vector f of ``xdot = M x + f``.
    """
    d_y, d_l, d_n = delta
    zero = np.zeros_like(d_y)
    side = np.stack([zero, d_y * A[1, 1], d_y * (A[1, 2] - w0_m_s), d_y * (A[1, 3] + u0_m_s)])
    roll, yaw = (np.stack([zero, d * A[i, 1], d * A[i, 2], d * A[i, 3]]) for i, d in ((2, d_l), (3, d_n)))
    M = A + np.stack([np.zeros_like(side), side, roll, yaw])
    control = product(B, u)
    scaled = np.stack([control[0], (1.0 + d_y) * control[1], (1.0 + d_l) * control[2], (1.0 + d_n) * control[3]])
    f = scaled - M[:, 1] * gust_m_s
    if rotation_rad_s is not None:
        p_g, r_g = rotation_rad_s
        of_p = np.stack([zero, M[1, 2] - w0_m_s, M[2, 2], M[3, 2]])
        of_r = np.stack([zero, M[1, 3] + u0_m_s, M[2, 3], M[3, 3]])
        f = f - of_p * p_g - of_r * r_g
    if gust_yaw is not None:
        f = f - np.stack([zero, zero, zero, gust_yaw * (M[3, 1] * gust_m_s)])
    return M, f


@cache
def lateral_lpv() -> LateralLpv:
    """The model as published, read once."""
    text = (Path(__file__).parent / "data" / "addsafe_lateral.yaml").read_text(encoding="utf-8")
    data: dict[str, Any] = yaml.load(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    return LateralLpv(
        tables={"A": column(data["A"]), "B": column(data["B"])},
        names=SCHEDULING,
        trim=column([data["trim"][name] for name in SCHEDULING]),
        scale=column([data["scale"][name] for name in SCHEDULING]),
        surfaces=tuple(data["surfaces"]),
    )
