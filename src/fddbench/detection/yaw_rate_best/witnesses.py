"""Three Kalman filters, each of which believes one sensor."""

import numpy as np

from fddbench.blocks.layout import ROW, Layout, Row, Rows, record
from fddbench.detection.yaw_rate_best.gains import YawRateBestGains
from fddbench.detection.yaw_rate_best.lateral_model import Drives

__all__ = ["Innovations", "WitnessState", "Witnesses"]

_MOST = 5.0
"""Innovations count no more than this [deg/s, deg]: a sensor at its stop is no worse than one that is far off."""


@record
class WitnessState:
    """Predictions of every witness for the next sample, (3, n_cases), their smoothed innovations, and the vane's last reading.

    Yaw rate [deg/s], unknown yaw acceleration [deg/s^2], path angle [deg], gust angle [deg], unknown turn rate [deg/s].
    """

    r: Rows
    acceleration: Rows
    path: Rows
    gust: Rows
    turn: Rows
    of_rate: Rows
    of_slip: Rows
    beta_deg: Row
    begun: Row


@record
class Innovations:
    """Smoothed innovations of every witness in yaw rate [deg/s] and in sideslip [deg], (3, n_cases)."""

    rate: Rows
    slip: Rows


class Witnesses:
    """Steady Kalman filters of the yaw-moment and of the side-force equation, a pair for each sensor.

    The first predicts the sensor: ``r' = drives + N_r r + a`` with an unknown acceleration a, first-order Gauss-Markov. The
    second predicts the vane from where the aircraft goes if the sensor is right: ``path' = drives + Y_r r / V + d``,
    ``beta = path - gust``, with a gust angle, first-order Gauss-Markov, and an unknown turn rate d that hardly changes; it
    takes in biases of sensor, vane and bank angle. Gains are common, so witnesses of equal sensors agree to the bit.
    """

    def __init__(self, gains: YawRateBestGains, smooth: float) -> None:
        self.gains, self.smooth = gains, smooth
        self.lag_samples = gains.beta_lag_s / gains.sample_s

    @property
    def states(self) -> Layout[WitnessState]:
        """Layout of what they keep."""
        three = dict.fromkeys(("r", "acceleration", "path", "gust", "turn", "of_rate", "of_slip"), 3)
        return Layout(WitnessState(**three, beta_deg=ROW, begun=ROW))

    def start(self) -> WitnessState:
        """Nothing seen."""
        three = dict.fromkeys(("r", "acceleration", "path", "gust", "turn", "of_rate", "of_slip"), 0.0)
        return WitnessState(**three, beta_deg=0.0, begun=0.0)

    def step(self, x: WitnessState, d: Drives, r_deg_s: Rows, beta_deg: Row) -> tuple[WitnessState, Innovations]:
        """State at the next sample, and the smoothed innovations of this one."""
        g, T = self.gains, self.gains.sample_s
        begun = x.begun > 0.0
        predicted = np.where(begun, x.r, r_deg_s)
        path = np.where(begun, x.path, beta_deg)
        before = np.where(begun, x.beta_deg, beta_deg)
        of_rate, of_slip = r_deg_s - predicted, beta_deg - (path - x.gust)
        r = predicted + g.yaw_gain[0] * of_rate
        acceleration = x.acceleration + g.yaw_gain[1] * of_rate
        path = path + g.slip_gain[0] * of_slip
        gust = x.gust + g.slip_gain[1] * of_slip
        turn = x.turn + g.slip_gain[2] * of_slip
        # the vane shows late what the air does now: beta + lag beta' is what turns the aircraft
        ahead = d.yaw_per_beta * (self.lag_samples * (beta_deg - before))
        after = WitnessState(
            r=r + T * (d.yaw_deg_s2 + ahead + d.yaw_per_r * r + acceleration),
            acceleration=g.keeps[0] * acceleration,
            path=path + T * (d.slip_deg_s + d.slip_per_r * r + turn),
            gust=g.keeps[1] * gust,
            turn=g.keeps[2] * turn,
            of_rate=x.of_rate + self.smooth * (_limited(of_rate) - x.of_rate),
            of_slip=x.of_slip + self.smooth * (_limited(of_slip) - x.of_slip),
            beta_deg=beta_deg,
            begun=np.ones_like(x.begun),
        )
        return after, Innovations(rate=after.of_rate, slip=after.of_slip)


def _limited(rows: Rows) -> Rows:
    return np.minimum(np.maximum(rows, -_MOST), _MOST)
