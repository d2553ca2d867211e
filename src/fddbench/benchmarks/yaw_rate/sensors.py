"""Sensors of the yaw-rate benchmark: noise added once per sample."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.blocks.linear import column

__all__ = ["PRESETS", "Noise"]


@dataclass(frozen=True, kw_only=True)
class Noise:
    """White noise, one sigma per sample.

    Attributes
    ----------
    r_deg_s, p_deg_s : float
        Each yaw-rate sensor, and the roll rate [deg/s].
    beta_deg, phi_deg : float
        Sideslip and bank angle [deg].
    """

    r_deg_s: float
    beta_deg: float
    p_deg_s: float
    phi_deg: float

    def r(self, true_deg_s: Rows, normals: Rows) -> Rows:
        """Three yaw-rate sensors [deg/s], (3, n_cases); normals 0-2."""
        return true_deg_s + self.r_deg_s * normals[:3]

    def others(self, beta_deg: Rows, p_deg_s: Rows, phi_deg: Rows, normals: Rows) -> Rows:
        """Sideslip [deg], roll rate [deg/s] and bank angle [deg], (3, n_cases); normals 3-5."""
        sigma = column((self.beta_deg, self.p_deg_s, self.phi_deg))
        return np.stack([beta_deg, p_deg_s, phi_deg]) + sigma * normals[3:6]


PRESETS: Mapping[str, Noise] = {
    # at 100 Hz; our choice for the reproduction campaigns
    "white": Noise(r_deg_s=0.01, beta_deg=0.02, p_deg_s=0.02, phi_deg=0.02),
    "ideal": Noise(r_deg_s=0.0, beta_deg=0.0, p_deg_s=0.0, phi_deg=0.0),
}
"""Sensor sets by their names in campaigns; the first is the default."""
