"""Numbers of the compact model, and what of an aircraft differs from flight to flight."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from fddbench.blocks.layout import ROW, Layout, Row, record

__all__ = ["AIRCRAFT", "DATA", "Aircraft", "aircraft", "iyy_kg_m2"]


@cache
def _data() -> dict[str, Any]:
    text = (Path(__file__).parent / "data" / "b747.yaml").read_text(encoding="utf-8")
    data: dict[str, Any] = yaml.safe_load(text)
    return data


DATA = _data()
"""The model as shipped; its comments say where each number comes from."""


@record
class Aircraft:
    """Mass and inertia, centre of gravity as a share of the chord, C_m of alphadot, and factors of coefficients.

    `c_m_ratio` multiplies everything in the pitching moment but the tail surfaces, `c_m_elevator_ratio` that of the elevator.
    """

    mass_kg: Row
    iyy_kg_m2: Row
    x_cg_ratio: Row
    c_m_alphadot: Row
    c_l_ratio: Row
    c_d_ratio: Row
    c_m_ratio: Row
    c_m_elevator_ratio: Row


AIRCRAFT = Layout(
    Aircraft(
        mass_kg=ROW, iyy_kg_m2=ROW, x_cg_ratio=ROW, c_m_alphadot=ROW, c_l_ratio=ROW, c_d_ratio=ROW, c_m_ratio=ROW,
        c_m_elevator_ratio=ROW,
    )
)  # fmt: skip
"""A row each."""


def iyy_kg_m2(mass_kg: Row) -> Row:
    """Moment of inertia in pitch [kg m^2], (n_cases,): through both published pairs, steeper below 254 t.

    >>> iyy_kg_m2(np.array([263084.0, 288756.0]))
    array([43800000., 44880000.])
    """
    own = DATA["inertia"]
    slope = (own["cr2144_iyy_kg_m2"] - own["iyy_kg_m2"]) / (own["cr2144_mass_kg"] - own["mass_kg"])
    heavy = own["iyy_kg_m2"] + slope * (mass_kg - own["mass_kg"])
    corner = own["iyy_kg_m2"] + slope * (own["light_mass_kg"] - own["mass_kg"])
    return np.minimum(heavy, corner + own["light_slope_m2"] * (mass_kg - own["light_mass_kg"]))


def aircraft(
    mass_kg: Row | None = None,
    *,
    x_cg_ratio: Row = DATA["geometry"]["reference_cg_ratio"],
    c_m_alphadot: Row = DATA["moment"]["alphadot"],
    delta_c_l_percent: Row = 0.0,
    delta_c_d_percent: Row = 0.0,
    delta_c_m_percent: Row = 0.0,
    delta_c_m_elevator_percent: Row = 0.0,
) -> Aircraft:
    """An aircraft, rows of (n_cases,); the nominal one of 263 t where nothing is said, (1,)."""
    mass_kg = np.array([DATA["inertia"]["mass_kg"]]) if mass_kg is None else mass_kg
    ones = np.ones_like(mass_kg)
    return Aircraft(
        mass_kg=mass_kg,
        iyy_kg_m2=iyy_kg_m2(mass_kg),
        x_cg_ratio=ones * x_cg_ratio,
        c_m_alphadot=ones * c_m_alphadot,
        c_l_ratio=ones + 0.01 * delta_c_l_percent,
        c_d_ratio=ones + 0.01 * delta_c_d_percent,
        c_m_ratio=ones + 0.01 * delta_c_m_percent,
        c_m_elevator_ratio=ones + 0.01 * delta_c_m_elevator_percent,
    )
