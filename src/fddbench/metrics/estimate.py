"""How well a detector estimates a fault that it has found, in one pass: three sums for each fault, in a traced step.

The error is the estimate minus what the fault really added, on the fault's own sites that the detector estimates, or on
the voted signal. It counts from 1 s after the detection, when the residual has settled, to the last faulty sample. A
step does not know yet whether a stretch of declarations lasts; so the sums begin anew whenever the number that
`fddbench.metrics.found` keeps for the fault changes. At the end they are those of the detection, if there was one.

State: count, sum and sum of squares for each fault, 0 at the start. Constants: besides those of `found` the samples of
1 s, and which estimated signals belong to the fault.
"""

import numpy as np

from fddbench.blocks.layout import Rows
from fddbench.blocks.linear import total
from fddbench.metrics.found import BEFORE, detected

__all__ = ["Sums", "add_errors", "bias_and_rms"]

Sums = tuple[Rows, Rows, Rows]
"""Count, sum and sum of squares of errors, (n_cases,) rows."""


def add_errors(
    sums: Sums,
    errors: Rows,
    own: Rows,
    *,
    found: Rows,
    before: Rows,
    settling: Rows,
    last: Rows,
    sample: Rows,
    active: Rows,
) -> Sums:
    """Sums of one fault after one more sample.

    Parameters
    ----------
    sums : three (n_cases,) rows
        After the sample before.
    errors : (n_signals, n_cases) rows
        Estimate minus truth of every estimated signal at this sample, in its unit.
    own : (n_signals, n_cases) rows
        1 for the signals that show this fault, else 0.
    found, before : (n_cases,) rows
        Number of the fault after this sample and after the one before, see `fddbench.metrics.found`.
    settling : (n_cases,) row
        Samples after the detection that do not count: 1 s of them, at least 1.
    last, sample, active : (n_cases,) rows
        Last faulty sample, number of the sample, and whether it is scored.

    Returns
    -------
    three (n_cases,) rows
        Count, sum and sum of squares.
    """
    # NEVER + settling is no larger than NEVER where it is rounded, but no sample reaches either
    counts = active & (found > BEFORE) & (sample >= found + settling) & (sample <= last)
    kept = [np.where(found == before, one, 0.0) for one in sums]
    errors = np.where(own > 0.0, errors, 0.0)
    more = (total(own), total(errors), total(errors * errors))
    n, first, second = (np.where(counts, one + new, one) for one, new in zip(kept, more, strict=True))
    return n, first, second


def bias_and_rms(sums: Sums, *, found: Rows) -> tuple[Rows, Rows, Rows]:
    """Count of errors, their mean and the root of their mean square over the faults of a flight, (n_cases,) each.

    Parameters
    ----------
    sums : three (n_faults, n_cases) rows
        Of each fault after the last sample.
    found : (n_faults, n_cases) rows
        Number of each fault of the whole flight; what is `NEVER` or `BEFORE` counts nothing.

    Returns
    -------
    n, bias, rms : (n_cases,) rows
        Bias and rms in the unit of the estimate, 0 where n is 0: there is no such number then.
    """
    n, first, second = (total(np.where(detected(found), one, 0.0)) for one in sums)
    some = np.maximum(n, 1.0)
    return n, first / some, np.sqrt(second / some)
