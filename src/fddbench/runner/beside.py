"""Flies the healthy twins of a batch, and keeps of each what stands beside its flights."""

import numpy as np

from fddbench.interfaces import NEVER, Floats
from fddbench.runner.assembly import Batch
from fddbench.runner.flight import Flyer
from fddbench.runner.twins import Kept, paired

__all__ = ["beside"]


def beside(flyer: Flyer, batch: Batch, departed: Floats) -> Floats | None:
    """What is kept of the healthy twins of a batch that was flown, (n_rows, n_cases); None where nothing needs any.

    Not-a-number stands for flights without a twin: healthy ones, those that departed before a faulty sample, and those whose
    twin departs itself.
    """
    own, twins = flyer.assembly, flyer.twins
    if twins is None:
        return None
    pairs = paired(own.plan, twins.assembly.plan, batch, last_scored=own.last_scored(batch, departed))
    kept, n_twins = Kept(own.consequences, pairs), len(pairs.cases)
    if not n_twins:
        return kept.rows(len(batch.cases), np.ones(0, dtype=bool))
    needed = np.zeros(n_twins)
    np.maximum.at(needed, pairs.twin, pairs.end)
    healthy = twins.assembly.shortened(twins.assembly.batch(pairs.cases), needed)
    gone = np.full(n_twins, NEVER)
    for first, signals, gone in twins.stretches(healthy, flyer.of_twins):  # noqa: B007  (the last is the one that counts)
        kept.feed(first, {name.removeprefix("truth:"): rows[:, 0] for name, rows in signals.items()})
    able = np.array([reason == "" for reason in healthy.infeasible_reason], dtype=bool)
    return kept.rows(len(batch.cases), able[pairs.twin] & (gone[pairs.twin] > pairs.end))
