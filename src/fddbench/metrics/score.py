"""What a score keeps of a flight, and what it knows of it: the records of `fddbench.metrics.scoring`."""

import numpy as np

from fddbench.blocks.block import Part
from fddbench.blocks.layout import Row, Rows, record

__all__ = ["LOWEST", "FaultScore", "FaultTimes", "ScoreConstants", "ScoreState"]

LOWEST = -float(np.finfo(np.float64).max)
"""Margin before the first sample that counts."""


@record
class FaultTimes:
    """One fault of a flight: its first faulty sample (`NEVER`: none), the last (`NEVER`: to the end), its sites (1 or 0)."""

    first: Row
    last: Row
    own: Rows


@record
class ScoreConstants:
    """First faulty sample and last sample of the flight; of each site its first faulty sample (`NEVER`: none); the faults."""

    k0: Row
    last: Row
    faulty_from: Rows
    faults: tuple[FaultTimes, ...]


@record
class FaultScore:
    """Number of a fault, see `fddbench.metrics.found`, and the sums of the errors of its estimate, if there is one."""

    found: Row
    sums: Part


@record
class ScoreState:
    """What was declared at the sample before, first samples of what can go wrong, flags and extremes, and the faults.

    `alarm` is 1 where something was declared or an alarm stood. `false_alarm`, `raised` and `wrong` are samples, `NEVER` for
    none: of the first alarm before the onset, of the first raised after it, and of the first declared site outside of F.
    """

    declared: Rows
    alarm: Row
    false_alarm: Row
    raised: Row
    wrong: Row
    over_declared: Row
    changes: Row
    margin_healthy: Row
    margin_faulty: Row
    nonfinite: Row
    faults: tuple[FaultScore, ...]
