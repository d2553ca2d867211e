"""The Boeing 747 of the LPV detection-filter paper: nine parameters from angle of attack, airspeed and altitude."""

from functools import partial
from types import SimpleNamespace
from typing import ClassVar

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.flight.b747.aerodynamics import air, coefficients, drag_coefficient
from fddbench.flight.b747.affine_model import Variant, affine_model
from fddbench.flight.b747.scheduling import BOX, PARAMETERS, parameters
from fddbench.interfaces import AffineModel, Channel
from fddbench.units import RAD_PER_DEG

__all__ = ["B747", "B747Unclipped"]


def _model(variant: Variant) -> AffineModel:
    """Affine model about the design point, with parameters in their units; the benchmark holds inputs over a sample."""
    lpv = affine_model(variant)
    tables = {}
    for name, table in lpv.tables.items():
        own = table[1:, :, :, 0] / lpv.scale[:, :, np.newaxis]
        tables[name] = np.concatenate(
            [(table[0, :, :, 0] - np.tensordot(lpv.trim[:, 0], own, axes=1))[np.newaxis], own]
        )
    outputs = (
        Channel(signal="alpha_deg", scale=RAD_PER_DEG),
        Channel(signal="q_deg_s", scale=RAD_PER_DEG),
        Channel(signal="v_tas_m_s"),
        Channel(signal="theta_deg", scale=RAD_PER_DEG),
        Channel(signal="altitude_m"),
    )
    inputs = (
        Channel(signal="elevator_deg", held=True),
        Channel(signal="stabiliser_deg", held=True),
        Channel(signal="thrust_n", held=True),
        Channel(),  # the fictitious input, one
    )
    return AffineModel(A=tables["A"], B=tables["B"], C=np.eye(5), outputs=outputs, inputs=inputs, box=BOX)


class B747:
    """Nine parameters of the affine model; the flight-path angle is pitch angle minus angle of attack.

    `models` are its variants: "fold" takes alphadot as q in the moment of alphadot, "approx" freezes Q/V there.
    """

    about = "Boeing 747-100/200: nine parameters from angle of attack, airspeed, altitude and pitch angle"
    signals = ("alpha_deg", "v_tas_m_s", "altitude_m", "theta_deg")
    parameters = PARAMETERS
    box = BOX
    models: ClassVar = {"fold": partial(_model, "fold"), "approx": partial(_model, "approx")}

    def rho(self, measured: SimpleNamespace) -> Rows:
        """Parameters in their units, (9, n_cases)."""
        alpha_rad, theta_rad = measured.alpha_deg * RAD_PER_DEG, measured.theta_deg * RAD_PER_DEG
        return parameters(alpha_rad, measured.v_tas_m_s, measured.altitude_m, theta_rad - alpha_rad)


class B747Unclipped(B747):
    """The same with the drag of the whole basic lift in the seventh parameter, ours.

    Table B1 shows that parameter with a lift that is held between 0.26 and 0.49. An aircraft that flies slower, higher or
    deeper than that has another drag, which the filters take for thrust: 29 kN per engine at 9000 m and 160 m/s.
    """

    about = "Boeing 747-100/200: as b747, with the drag of the whole lift, outside the limits of Table B1 too"

    def rho(self, measured: SimpleNamespace) -> Rows:
        """Parameters in their units, (9, n_cases)."""
        rho = super().rho(measured)
        found = coefficients(measured.alpha_deg * RAD_PER_DEG, measured.v_tas_m_s, air(measured.altitude_m))
        drag = drag_coefficient(found.basic_lift, found.mach) * found.q_pa
        return np.stack([*(rho[j] for j in range(6)), drag, rho[7], rho[8]])
