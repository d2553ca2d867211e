"""Both engines as one: share of the thrust with a lag, slower near idle."""

import numpy as np

from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Row
from fddbench.flight.transport.aircraft import Thrust

__all__ = ["spooled"]


def spooled(thrust: Thrust, ratio: Row, ordered: Row, sample_s: float) -> Row:
    """Share of the thrust one sample later [-]: first order, exact for an order held over the sample."""
    slow, fast = (float(1.0 - exp(np.array(-sample_s / lag))) for lag in (thrust.spool_lag_s, thrust.lag_s))
    within = np.minimum(np.maximum(ordered, thrust.idle_ratio), 1.0)
    return ratio + np.where(ratio < thrust.spool_ratio, slow, fast) * (within - ratio)
