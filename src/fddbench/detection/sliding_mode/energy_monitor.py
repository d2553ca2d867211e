"""The energy monitor: an abnormal noise signature on a single sensor."""

from dataclasses import dataclass

import numpy as np

from fddbench.blocks.layout import Layout, Rows

__all__ = ["EnergyMonitor"]


@dataclass(frozen=True, kw_only=True)
class EnergyMonitor:
    """Trips on a sensor when `count` of its last `window` derivatives exceed `limit_deg_s2`.

    The window is a shift register in one number: 52 yes-or-no fit exactly into a float64, so no buffer has to move.

    Attributes
    ----------
    window, count : int
        Samples looked at, and how many of them must exceed the limit.
    limit_deg_s2 : float
        Limit of the numerical derivative [deg/s^2].
    sample_s : float
        Sample time [s].
    n_sites : int
        Sensors watched, each by itself.
    """

    window: int
    count: int
    limit_deg_s2: float
    sample_s: float
    n_sites: int

    @property
    def states(self) -> Layout:
        """Previous sample, register, exceedances in the window, mean square derivative, and 1 after the first sample."""
        n = self.n_sites
        return Layout(before=n, register=n, exceedances=n, energy=n, begun=0)

    def step(self, state: Rows, sensors_deg_s: Rows) -> tuple[Rows, Rows, Rows]:
        """State, which sensors have tripped (boolean) and their energies, (n_sites, n_cases).

        The energy is the mean square derivative over about one window, in units of the limit squared.
        """
        x = self.states.unpack(state)
        slope = np.where(x.begun > 0.0, (sensors_deg_s - x.before) / (self.sample_s * self.limit_deg_s2), 0.0)
        exceeds = np.where(np.abs(slope) > 1.0, 1.0, 0.0)
        top = 2.0 ** (self.window - 1)
        oldest = np.where(x.register >= top, 1.0, 0.0)
        register = 2.0 * (x.register - oldest * top) + exceeds
        exceedances = x.exceedances - oldest + exceeds
        energy = x.energy + (slope * slope - x.energy) / self.window
        after = self.states.pack(
            before=sensors_deg_s, register=register, exceedances=exceedances, energy=energy, begun=np.ones_like(x.begun)
        )
        return after, exceedances >= float(self.count), energy
