"""The energy monitor: an abnormal noise signature on a single sensor."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record

__all__ = ["Energies", "EnergyMonitor", "EnergyState"]


@record
class EnergyState:
    """Previous sample [deg/s], register, exceedances in the window, mean square derivative, and 1 after the first sample."""

    before: Rows
    register: Rows
    exceedances: Rows
    energy: Rows
    begun: Row


@record
class Energies:
    """Which sensors have tripped (boolean), and their energies, (n_sites, n_cases).

    An energy is the mean square derivative over about one window, in units of the limit squared.
    """

    tripped: Rows
    energy: Rows


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

    constants: ClassVar[Layout[Any]] = NOTHING
    draws: ClassVar[Draws[Any]] = NO_DRAWS

    window: int
    count: int
    limit_deg_s2: float
    sample_s: float
    n_sites: int

    @property
    def states(self) -> Layout[EnergyState]:
        """Layout of what it keeps."""
        n = self.n_sites
        return Layout(EnergyState(before=n, register=n, exceedances=n, energy=n, begun=ROW))

    def start(self, c: Nothing) -> EnergyState:
        """Nothing seen."""
        del c
        return EnergyState(before=0.0, register=0.0, exceedances=0.0, energy=0.0, begun=0.0)

    def step(self, x: EnergyState, c: Nothing, n: Nothing, sensors_deg_s: Rows) -> tuple[EnergyState, Energies]:
        """State at the next sample, and the energies at this one."""
        del c, n
        slope = np.where(x.begun > 0.0, (sensors_deg_s - x.before) / (self.sample_s * self.limit_deg_s2), 0.0)
        exceeds = np.where(np.abs(slope) > 1.0, 1.0, 0.0)
        top = 2.0 ** (self.window - 1)
        oldest = np.where(x.register >= top, 1.0, 0.0)
        register = 2.0 * (x.register - oldest * top) + exceeds
        exceedances = x.exceedances - oldest + exceeds
        energy = x.energy + (slope * slope - x.energy) / self.window
        after = EnergyState(
            before=sensors_deg_s,
            register=register,
            exceedances=exceedances,
            energy=energy,
            begun=np.ones_like(x.begun),
        )
        return after, Energies(tripped=exceedances >= float(self.count), energy=energy)
