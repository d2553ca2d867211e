"""One lateral Kalman filter that knows gusts: it coasts while the sensors differ, and whoever is far from it is accused."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.blocks.linear import total
from fddbench.detection.decision import Nearest, NearestGains, NearestState
from fddbench.detection.gust_filter import LATERAL_SIGNALS, GustFilter, GustFilterGains, GustFilterState, lateral
from fddbench.interfaces import Bus, Verdict
from fddbench.units import DEG_PER_RAD, RAD_PER_DEG

__all__ = ["KalmanGust", "KalmanGustGains"]


class KalmanGustGains(NearestGains):
    """Numbers of the decision, and of its filter.

    Attributes
    ----------
    filter : GustFilterGains
        Made by ``fddbench design``.
    """

    filter: GustFilterGains


@record
class KalmanGustState:
    """The filter; lagged distances of the sensors from it [deg/s]; the decision."""

    filter: GustFilterState
    distance_deg_s: Rows
    decision: NearestState


class KalmanGust:
    """Accuses the sensors that differ from the one nearest to a Kalman filter that coasts while they differ.

    Model assumed: the lateral LPV model scheduled by measured mass, X_cg, altitude and airspeed, white sensor noise, a
    Gauss-Markov gust that enters the sideslip with its derivative, and a slow yaw acceleration that the model does not have.
    The gust state keeps sideslip and bank angle worth something in turbulence: they hold the yaw rate where the yaw-moment
    equation alone would drift. Blind to faults below the gate; a pair that drifts away slowly teaches the filter its drift
    before the gate opens, and some are then declared as one. Off with errors of the measured parameters in turns.
    Knobs: the gate trades small and slow faults for false alarms of sensors that differ anyway; less `yaw_drift_deg_s3` makes
    the filter harder to teach; a longer `confirm_one_s` leaves slow pairs more time to show. Cost: 539 operations a sample.

    References
    ----------
    Willsky (1976), A survey of design methods for failure detection in dynamic systems, Automatica 12(6), 601-611; Mehra,
    Peschon (1971), An innovations approach to fault detection and diagnosis in dynamic systems, Automatica 7(5), 637-640. Gust,
    coasting and decision are ours.

    Examples
    --------
    >>> import fddbench
    >>> smoke = fddbench.read("smoke", ["detectors=[kalman_gust]", "duration_s=2.5"])
    >>> flight = fddbench.signals(smoke, "jam_b", ["jam_b/0/0/0"])  # two sensors from 2 s on
    >>> flight.detectors["kalman_gust"]["n_declared"][[200, 215], 0]
    array([0., 2.])
    """

    about = "lateral Kalman filter with a gust state, coasts while the sensors differ"
    recorded = ("r_model_deg_s",)
    Gains = KalmanGustGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: KalmanGustGains, bus: Bus) -> None:
        self.watches = bus.redundant("r_deg_s", least=3)
        self.filter, self.decision = GustFilter(gains.filter, bus), Nearest.of(gains, bus, len(self.watches))
        self.states = Layout(
            KalmanGustState(
                filter=self.filter.states.shape, distance_deg_s=len(self.watches), decision=self.decision.states.shape
            )
        )

    @classmethod
    def from_design(cls, gains: KalmanGustGains, bus: Bus) -> "KalmanGust":
        """Detector for a bus with the lateral signals and three or more yaw rates."""
        bus.require(*LATERAL_SIGNALS)
        return cls(gains, bus)

    def start(self, c: Nothing) -> KalmanGustState:
        """In trim."""
        return KalmanGustState(filter=self.filter.start(c), distance_deg_s=0.0, decision=self.decision.start(c))

    def step(
        self, x: KalmanGustState, c: Nothing, n: Nothing, measured: SimpleNamespace
    ) -> tuple[KalmanGustState, Verdict]:
        """Verdict after one sample."""
        r_deg_s, declared = measured.r_deg_s, x.decision.standing.declared
        _, differ = self.decision.apart(x.decision, r_deg_s)
        believed = 1.0 - declared
        n_declared = total(declared)
        mean = total(believed * r_deg_s) / np.maximum(total(believed), 1.0)
        fed = np.where(n_declared > 0.0, mean, measured.r_voted_deg_s)
        trust = np.where((differ > 0.0) & (n_declared < 1.0), 0.0, 1.0)
        now = lateral(measured)
        e = self.filter.innovation(x.filter, now, fed * RAD_PER_DEG)
        filtered, r_rad_s = self.filter.step(x.filter, c, n, now, e, trust)
        far = np.abs(r_deg_s - DEG_PER_RAD * r_rad_s)
        distance = x.distance_deg_s + self.decision.share * (far - x.distance_deg_s)
        decided, decision = self.decision.step(x.decision, c, n, r_deg_s, distance)
        after = KalmanGustState(filter=filtered, distance_deg_s=distance, decision=decided)
        return after, Verdict(decision.declared, decision.residual, signals={"r_model_deg_s": DEG_PER_RAD * r_rad_s})
