"""Mass, inertia and coefficient deltas of flights as the equations take them."""

from collections.abc import Mapping

import numpy as np

from fddbench.blocks.functions import pow_
from fddbench.blocks.layout import Row
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.equations import Body

__all__ = ["AXES", "body_of"]

AXES = ("x", "y", "z", "l", "m", "n")


def body_of(
    aircraft: Aircraft,
    mass_kg: Row,
    x_cg_ratio: Row,
    deltas: Mapping[str, Row] | None = None,
    *,
    gust_yaw: Row | None = None,
) -> Body:
    """Flights of these masses [kg] and centres of gravity [-], (n_cases,).

    Inertia grows with a power of the mass.

    Parameters
    ----------
    deltas : mapping of str to rows, optional
        Changes [-] of the total coefficients in body axes by the last letter of their names: x, y, z, l, m, n.
    gust_yaw : row, optional
        By how much the yawing moment of a gust is larger than its sideslip says [-].
    """
    inertia, deltas = aircraft.inertia, deltas or {}
    share = mass_kg / inertia.mass_kg
    i_xx = inertia.i_xx_kg_m2 * pow_(share, inertia.exponent_xx)
    i_yy = inertia.i_yy_kg_m2 * pow_(share, inertia.exponent_yy)
    i_zz = inertia.i_zz_kg_m2 * pow_(share, inertia.exponent_zz)
    i_xz = inertia.i_xz_kg_m2 * pow_(share, inertia.exponent_zz)
    whole = i_xx * i_zz - i_xz * i_xz
    ones = {f"one_c_{axis}": 1.0 + deltas.get(axis, np.zeros_like(mass_kg)) for axis in AXES}
    return Body(
        mass_kg=mass_kg, x_cg_ratio=x_cg_ratio, i_xx=i_xx, i_yy=i_yy, i_zz=i_zz, i_xz=i_xz,
        roll_of_roll=i_zz / whole, roll_of_yaw=i_xz / whole, yaw_of_yaw=i_xx / whole, **ones,
        gust_yaw=np.zeros_like(mass_kg) if gust_yaw is None else gust_yaw,
    )  # fmt: skip
