"""The whole scheme of Fig. 2 of the paper, block by block."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.functions import exp, sin
from fddbench.blocks.layout import ROW, Layout, Nothing, Row, Rows, record
from fddbench.blocks.linear import largest, total
from fddbench.detection.confirmation import held_samples, samples
from fddbench.detection.consolidation import deviations_deg_s, largest_deviation_deg_s, outlier
from fddbench.detection.isolation import choose, latch
from fddbench.detection.sliding_mode.adaptive_threshold import AdaptiveThreshold, ThresholdState
from fddbench.detection.sliding_mode.energy_monitor import EnergyMonitor, EnergyState
from fddbench.detection.sliding_mode.gains import SlidingModeGains
from fddbench.detection.sliding_mode.observer import Observer, ObserverState
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Verdict
from fddbench.units import DEG_PER_RAD

__all__ = ["SlidingMode"]

_NEEDS = (
    "phi_deg", "beta_deg", "p_deg_s", "r_deg_s", "r_voted_deg_s", "surface_deg", "v_tas_m_s",
    "mass_kg", "x_cg_ratio", "altitude_ft", "v_cas_kt",
)  # fmt: skip
_INSIDE = ("output_error", "modulation_used", "rho_mass", "rho_x_cg", "rho_altitude", "rho_v_cas")
"""|e_y| with angles in rad and speeds in m/s; the largest share of K that an injection takes, below 1 while it slides (15)."""
_SAMPLE_S = (0.002, 0.1)
"""Sample times at which the numbers of the energy monitor (tuned for 10 ms) mean something."""


@record
class SlidingModeState:
    """Lagged inputs; the observer; its filtered reconstruction [deg/s]; threshold and energies; the logic."""

    lagged: Rows
    observer: ObserverState
    reconstruction_deg_s: Row
    threshold: ThresholdState
    energy: EnergyState
    held_samples: Row
    n_declared: Row
    declared: Rows


class SlidingMode:
    """Consolidation flag, plus an observer that tells whether the voted signal itself is wrong.

    Model assumed: the lateral LPV model, scheduled by measured mass, X_cg, altitude and airspeed. The reconstruction is
    noisy with sideslip noise and gusts (about 0.4 deg/s per m/s of lateral gust) and off with errors of the measured
    parameters in turns; blind where the flag is (0.3 deg/s held). Knobs: the floor of the threshold trades missed
    two-sensor faults for false ones; the confirmation times trade speed for false alarms.

    References
    ----------
    The yaw-rate sliding-mode observer paper of the ADDSAFE project, sections 4 to 6; where it is silent the logic is ours,
    chosen to reproduce its Table 8.
    """

    about = "LPV sliding-mode observer with flag, adaptive threshold, isolation and energy monitor"
    recorded: tuple[str, ...] = ("reconstruction_deg_s", "threshold_deg_s", "deviation_deg_s", "flag_threshold_deg_s")
    estimates = "r_voted_deg_s"
    Gains = SlidingModeGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: SlidingModeGains, bus: Bus) -> None:
        g, T = gains, bus.sample_s
        self.gains, self.sample_s, self.watches = g, T, bus.redundant("r_deg_s")
        self.observer = Observer(g, T)
        self.recorded = (*type(self).recorded, *(_INSIDE if g.record_observer else ()))
        self.threshold = AdaptiveThreshold(
            pole_1_s=g.threshold_pole_1_s, gain=g.threshold_gain, roll_surface_scale=g.roll_surface_scale,
            rudder_scale=g.rudder_scale, floor_deg_s=g.threshold_floor_deg_s, sample_s=T,
        )  # fmt: skip
        self.energy = EnergyMonitor(
            window=g.energy_window_samples, count=g.energy_count, limit_deg_s2=g.energy_limit_deg_s2, sample_s=T,
            n_sites=len(self.watches),
        )  # fmt: skip
        self.input_share = float(1.0 - exp(np.array(-T / g.input_lag_s)))
        self.output_share = float(1.0 - exp(np.array(-T / g.output_lag_s)))
        self.confirm_one = samples("confirm_one_s", g.confirm_one_s, T)
        self.confirm_two = samples("confirm_two_s", g.confirm_two_s, T)
        self.states = Layout(
            SlidingModeState(
                lagged=17, observer=self.observer.states.shape, reconstruction_deg_s=ROW,
                threshold=self.threshold.states.shape, energy=self.energy.states.shape, held_samples=ROW,
                n_declared=ROW, declared=len(self.watches),
            )
        )  # fmt: skip

    @classmethod
    def from_design(cls, gains: SlidingModeGains, bus: Bus) -> "SlidingMode":
        """Detector for a bus that has three yaw rates, their voted signal and the lateral measurements."""
        bus.require(*_NEEDS)
        if not _SAMPLE_S[0] <= bus.sample_s <= _SAMPLE_S[1]:
            raise DesignError(
                f"sample_s = {bus.sample_s} is outside {_SAMPLE_S[0]} to {_SAMPLE_S[1]}: the energy monitor counts samples of "
                "numerical derivatives, which drown in noise when the samples are short; choose another sample_s"
            )
        if gains.energy_count > gains.energy_window_samples:
            raise DesignError(
                f"energy_count = {gains.energy_count} can never be reached in a window of "
                f"{gains.energy_window_samples} samples; make it smaller than energy_window_samples"
            )
        return cls(gains, bus)

    def start(self, c: Nothing) -> SlidingModeState:
        """Nothing declared, observer at rest."""
        return SlidingModeState(
            lagged=0.0, observer=self.observer.start(c), reconstruction_deg_s=0.0, threshold=self.threshold.start(c),
            energy=self.energy.start(c), held_samples=0.0, n_declared=0.0, declared=0.0,
        )  # fmt: skip

    def step(
        self, x: SlidingModeState, c: Nothing, n: Nothing, measured: SimpleNamespace
    ) -> tuple[SlidingModeState, Verdict]:
        """Verdict after one sample."""
        lagged, observer, reconstruction, inside = self._reconstruct(x, measured)
        level, threshold = self.threshold.step(x.threshold, c, n, measured.surface_deg)
        ratio = np.abs(reconstruction) / threshold

        deviation = deviations_deg_s(measured.r_deg_s, measured.r_voted_deg_s)
        apart = largest_deviation_deg_s(deviation)
        energy, watched = self.energy.step(x.energy, c, n, measured.r_deg_s)
        trips = np.where(watched.tripped, 1.0, 0.0)
        flag = (apart > self.gains.flag_threshold_deg_s) | (largest(trips) > 0.0)

        held = held_samples(x.held_samples, flag)
        two = (held - 1.0 >= self.confirm_two) & (ratio > 1.0)
        one = held - 1.0 >= self.confirm_one
        n_now = np.maximum(x.n_declared, np.where(two, 2.0, np.where(one, 1.0, 0.0)))
        chosen = choose(outlier(deviation), n_now, trips, watched.energy)
        declared = latch(x.declared, chosen, n_before=x.n_declared, n_now=n_now)

        after = SlidingModeState(
            lagged=lagged, observer=observer, reconstruction_deg_s=reconstruction, threshold=level, energy=energy,
            held_samples=held, n_declared=n_now, declared=declared,
        )  # fmt: skip
        shown = {
            "reconstruction_deg_s": reconstruction,
            "threshold_deg_s": threshold,
            "deviation_deg_s": apart,
            "flag_threshold_deg_s": np.full_like(apart, self.gains.flag_threshold_deg_s),
        }
        if self.gains.record_observer:
            shown |= inside
        return after, Verdict(declared, ratio, signals=shown, estimate=reconstruction)

    def _reconstruct(self, x: SlidingModeState, m: SimpleNamespace) -> tuple[Rows, ObserverState, Row, dict[str, Row]]:
        """Lagged inputs, observer state, filtered reconstruction [deg/s], and the inside by the names of `_INSIDE`.

        All inputs pass the same lag: filtering the sideslip alone would cost gain and phase.
        """
        v_y_m_s = m.v_tas_m_s * sin(m.beta_deg / DEG_PER_RAD)
        lateral = np.stack([m.phi_deg / DEG_PER_RAD, v_y_m_s, m.p_deg_s / DEG_PER_RAD, m.r_voted_deg_s / DEG_PER_RAD])
        inputs = np.concatenate([lateral, m.surface_deg])
        lagged = x.lagged + self.input_share * (inputs - x.lagged)
        rho = self.observer.model.rho(m.mass_kg, m.x_cg_ratio, m.altitude_ft, m.v_cas_kt)
        observer, raw_rad_s, inside = self.observer.step(
            x.observer, Nothing(), Nothing(), lagged[:3], lagged[3], lagged[4:], rho
        )
        smooth = x.reconstruction_deg_s + self.output_share * (DEG_PER_RAD * raw_rad_s - x.reconstruction_deg_s)
        used = np.abs(inside.nu / self.observer.k)
        shown = (np.sqrt(total(inside.e_y * inside.e_y)), largest(used), *rho)
        return lagged, observer, smooth, dict(zip(_INSIDE, shown, strict=True))
