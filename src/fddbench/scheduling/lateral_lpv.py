"""The published lateral LPV aircraft: its four parameters as measured, and its model in terms of what sensors give."""

from dataclasses import replace
from types import SimpleNamespace
from typing import ClassVar

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.flight.lateral_lpv import SCHEDULING, lateral_lpv
from fddbench.interfaces import AffineModel, Channel
from fddbench.units import DEG_PER_RAD, RAD_PER_DEG

__all__ = ["LateralLpvParameters"]


def _box() -> tuple[tuple[float, float], ...]:
    """The published box, |rho| <= 1, in the units of the parameters."""
    model = lateral_lpv()
    return tuple(
        (float(middle - half), float(middle + half))
        for middle, half in zip(model.trim[:, 0], model.scale[:, 0], strict=True)
    )


def _published() -> AffineModel:
    """States and outputs alike: phi [rad], V_y through the air [m/s], p, r [rad/s]; the surfaces in degrees.

    The side velocity of the model is one through the air where it makes forces. In such coordinates a lateral gust enters by
    its rate, and the side velocity alone: its direction is [0, 1, 0, 0].
    """
    model = lateral_lpv()
    tables = {}
    for name, table in model.tables.items():
        own = table[1:, :, :, 0] / model.scale[:, :, np.newaxis]
        constant = table[0, :, :, 0] - np.tensordot(model.trim[:, 0], own, axes=1)
        tables[name] = np.concatenate([constant[np.newaxis], own])
    outputs = (
        Channel(signal="phi_deg", scale=RAD_PER_DEG),
        Channel(signal="beta_deg", scale=RAD_PER_DEG, times="v_tas_m_s"),
        Channel(signal="p_deg_s", scale=RAD_PER_DEG),
        Channel(signal="r_voted_deg_s", scale=RAD_PER_DEG),
    )
    inputs = tuple(Channel(signal="surface_deg", row=row, held=True) for row in range(len(model.surfaces)))
    return AffineModel(A=tables["A"], B=tables["B"], C=np.eye(4), outputs=outputs, inputs=inputs, box=np.array(_box()))


def _yaw_moment() -> AffineModel:
    """The yaw-moment row alone, in degrees: state r, three sensors of it, and what drives it as inputs.

    The side velocity through the air is measured, so the gust is measured with it and no disturbance.
    """
    whole = _published()
    unit = np.array([DEG_PER_RAD, 1.0, *[DEG_PER_RAD] * whole.B.shape[2]])
    moments = np.concatenate([whole.A[:, 3:, 1:3], whole.B[:, 3:]], axis=2) * unit
    driven = (replace(whole.outputs[1], held=False), Channel(signal="p_deg_s"))
    sensors = tuple(Channel(signal="r_deg_s", row=row) for row in range(3))
    return AffineModel(
        A=whole.A[:, 3:, 3:],
        B=moments,
        C=np.ones((3, 1)),
        outputs=sensors,
        inputs=(*driven, *whole.inputs),
        box=whole.box,
    )


class LateralLpvParameters:
    """Mass, centre of gravity, altitude and airspeed as they are measured, not clipped to the published box."""

    about = "lateral LPV aircraft of the yaw-rate benchmark: mass, X_cg, altitude and airspeed as measured"
    signals = SCHEDULING
    parameters = SCHEDULING
    box = np.array(_box())
    models: ClassVar = {"published": _published, "yaw_moment": _yaw_moment}

    def rho(self, measured: SimpleNamespace) -> Rows:
        """Parameters in their units, (4, n_cases)."""
        return np.stack([vars(measured)[name] for name in SCHEDULING])
