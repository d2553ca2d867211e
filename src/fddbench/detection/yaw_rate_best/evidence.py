"""Evidence against each sensor: how much worse its witness explains the flight than the best one."""

import numpy as np

from fddbench.blocks.layout import ROW, Layout, Row, Rows, record
from fddbench.blocks.linear import total
from fddbench.detection.yaw_rate_best.difference import smallest
from fddbench.detection.yaw_rate_best.gains import YawRateBestGains
from fddbench.detection.yaw_rate_best.witnesses import Innovations

__all__ = ["Evidence", "EvidenceState"]

_OUT = 1e9
"""Added to a declared sensor: it is no longer the one that others are compared with."""


@record
class EvidenceState:
    """Levels of the innovations [(deg/s)^2, deg^2], and evidence against every sensor beyond the best one [-]."""

    level_rate: Row
    level_slip: Row
    against: Rows


class Evidence:
    """Sums of squared, normalised innovations since the sensors began to differ.

    Half of a difference of two sums is the logarithm of how much likelier one sensor makes the flight than the other, a
    likelihood ratio between the hypotheses "sensor i tells the truth", whatever the other sensors show.
    """

    def __init__(self, gains: YawRateBestGains, weight: float, learn: float, keep: float) -> None:
        self.gains, self.weight, self.learn, self.keep = gains, weight, learn, keep

    @property
    def states(self) -> Layout[EvidenceState]:
        """Layout of what it keeps."""
        return Layout(EvidenceState(level_rate=ROW, level_slip=ROW, against=3))

    def start(self) -> EvidenceState:
        """None."""
        return EvidenceState(level_rate=0.0, level_slip=0.0, against=0.0)

    def step(self, x: EvidenceState, e: Innovations, declared: Rows, gathering: Row) -> tuple[EvidenceState, Rows]:
        """State at the next sample, and evidence against every sensor over what declares it [-], (3, n_cases).

        `gathering` says whether sensors lately differed.
        """
        g = self.gains
        rate, slip = e.rate * e.rate, e.slip * e.slip
        per_rate = 1.0 / (g.floor_deg_s**2 + g.level_ratio[0] * x.level_rate)
        per_slip = 1.0 / (g.floor_deg**2 + g.level_ratio[1] * x.level_slip)
        gathered = self.keep * x.against + self.weight * np.minimum(rate * per_rate + slip * per_slip, g.most)
        best = smallest(gathered + _OUT * declared)
        against = np.where(gathering, gathered - best, 0.0)
        after = EvidenceState(
            # of the best witness: what the model does not know of the air and the aircraft, not what a fault does
            level_rate=x.level_rate + self.learn * (smallest(rate) - x.level_rate),
            level_slip=x.level_slip + self.learn * (smallest(slip) - x.level_slip),
            against=against,
        )
        # a common fault has a shorter time limit, so two sensors at once may need other evidence than one
        two = total(np.where(against > g.evidence_two, 1.0, 0.0)) > 1.5
        return after, against / np.where(two, g.evidence_two, g.evidence_one)
