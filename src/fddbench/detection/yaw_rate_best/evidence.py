"""Evidence against each sensor: how much worse its witness explains the flight than the best one."""

import numpy as np

from fddbench.blocks.layout import ROW, Layout, Row, Rows, record
from fddbench.blocks.linear import total
from fddbench.detection.yaw_rate_best.difference import smallest
from fddbench.detection.yaw_rate_best.gains import YawRateBestGains
from fddbench.detection.yaw_rate_best.witnesses import Innovations

__all__ = ["Evidence", "EvidenceState", "Judgement"]

_OUT = 1e9
"""Added to a declared sensor: it is no longer the one that others are compared with."""


@record
class EvidenceState:
    """Levels of the innovations [(deg/s)^2, deg^2]; evidence, and how much each pair of sensors could have given [-].

    Pair i is sensor i and the next one.
    """

    level_rate: Row
    level_slip: Row
    against: Rows
    possible: Rows


@record
class Judgement:
    """Evidence against every sensor beyond the best one over what declares it [-], and accusations (boolean), (3, n_cases)."""

    ratio: Rows
    accused: Rows


class Evidence:
    """Sums of squared, normalised innovations since the sensors began to differ.

    Half of a difference of two sums is the logarithm of how much likelier one sensor makes the flight than the other, a
    likelihood ratio between the hypotheses "sensor i tells the truth", whatever the other sensors show.
    """

    def __init__(self, gains: YawRateBestGains, weight: float, learn: float) -> None:
        self.gains, self.weight, self.learn = gains, weight, learn

    @property
    def states(self) -> Layout[EvidenceState]:
        """Layout of what it keeps."""
        return Layout(EvidenceState(level_rate=ROW, level_slip=ROW, against=3, possible=3))

    def start(self) -> EvidenceState:
        """None."""
        return EvidenceState(level_rate=0.0, level_slip=0.0, against=0.0, possible=0.0)

    def step(self, x: EvidenceState, e: Innovations, declared: Rows, gathering: Row) -> tuple[EvidenceState, Judgement]:
        """State at the next sample, and the judgement of this one; `gathering` says whether sensors lately differed."""
        g = self.gains
        rate, slip = e.rate * e.rate, e.slip * e.slip
        per_rate = 1.0 / (g.floor_deg_s**2 + g.level_ratio[0] * x.level_rate)
        per_slip = 1.0 / (g.floor_deg**2 + g.level_ratio[1] * x.level_slip)
        worse = np.minimum(rate * per_rate + slip * per_slip, g.most)
        d_rate, d_slip = e.rate - _next(e.rate), e.slip - _next(e.slip)
        apart = np.minimum(d_rate * d_rate * per_rate + d_slip * d_slip * per_slip, g.most)
        gathered = x.against + self.weight * worse
        best = smallest(gathered + _OUT * declared)
        against = np.where(gathering, gathered - best, 0.0)
        possible = np.where(gathering, x.possible + self.weight * apart, 0.0)
        after = EvidenceState(
            # of the best witness: what the model does not know of the air and the aircraft, not what a fault does
            level_rate=x.level_rate + self.learn * (smallest(rate) - x.level_rate),
            level_slip=x.level_slip + self.learn * (smallest(slip) - x.level_slip),
            against=against,
            possible=possible,
        )
        return after, self._judged(against, possible, declared)

    def _judged(self, against: Rows, possible: Rows, declared: Rows) -> Judgement:
        """Two sensors at once need other evidence than one: a common fault has a shorter time limit."""
        g = self.gains
        of_two = against > g.evidence_two
        two = total(np.where(of_two, 1.0, 0.0)) > 1.5
        need = np.where(two, g.evidence_two, g.evidence_one)
        next_is_best = _next(against + _OUT * declared) <= 0.0
        with_best: Rows = np.where(next_is_best, possible, _next(_next(possible)))
        contrast = against > g.contrast * with_best
        return Judgement(ratio=against / need, accused=(against > need) & contrast)


def _next(rows: Rows) -> Rows:
    """Rows of the next sensor of three, the first after the last."""
    return np.stack([rows[1], rows[2], rows[0]])
