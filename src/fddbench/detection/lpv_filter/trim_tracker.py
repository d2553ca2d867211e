"""Takes slow offsets out of fault estimates: a trim change that the model misses looks like a fault.

The offset of each estimate follows it with a time constant, but stands still while both are further apart than a given
distance, so that a fault is not taken for a trim change. The price: what grows more slowly than that distance per time constant
is never seen, a fault smaller than the distance is forgotten after a few time constants, and an offset that jumps by more than
the distance (or has been wrong since before a fault) stays. The distance is a number of its own and no share of the
threshold: thresholds are tuned on what this leaves.
"""

import numpy as np

from fddbench.blocks.functions import exp
from fddbench.blocks.layout import ROW, Row, Rows, record
from fddbench.blocks.linear import column
from fddbench.detection.confirmation import samples
from fddbench.detection.lpv_filter.gains import TrimEntry

__all__ = ["TrimState", "TrimTracker"]


@record
class TrimState:
    """Offset of each estimate, in the unit of its site, and how many samples have been seen."""

    offset: Rows
    seen_samples: Row


class TrimTracker:
    """Offset of every estimate.

    Parameters
    ----------
    entry : TrimEntry
    sample_s : float
        Time between two samples [s].
    """

    def __init__(self, entry: TrimEntry, sample_s: float) -> None:
        self.freeze = column(entry.freeze_above)
        self.share = float(1.0 - exp(np.array(-sample_s / entry.time_constant_s)))
        self.learn_samples = samples("trim.learn_s", entry.learn_s, sample_s)
        self.shape = TrimState(offset=len(entry.freeze_above), seen_samples=ROW)

    def start(self) -> TrimState:
        """No offset yet."""
        return TrimState(offset=0.0, seen_samples=0.0)

    def step(self, x: TrimState, estimate: Rows) -> tuple[TrimState, Rows]:
        """State after this sample, and the estimates without the offset of the sample before; 0 while it is learnt."""
        left = estimate - x.offset
        learning = x.seen_samples < self.learn_samples
        share = np.where(learning, 1.0 / (x.seen_samples + 1.0), np.where(np.abs(left) < self.freeze, self.share, 0.0))
        after = TrimState(offset=x.offset + share * left, seen_samples=x.seen_samples + 1.0)
        return after, np.where(learning, 0.0, left)
