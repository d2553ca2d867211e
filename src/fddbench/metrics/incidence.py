"""Cumulative incidence: which share of all flights has been declared right by each time, and which was lost to another outcome.

A wrong declaration is no reason to stop counting: who declares a healthy site can no longer be right, so a flight lost that way
stays in n for ever (competing outcomes), other than in a curve of Kaplan and Meier that would censor it. At time t after the
onset, of n flown flights::

    found(t) = share found by t, in time or late       wrong(t) = share with a healthy site declared by t
    alarmed  = share with an alarm before the onset, at every t

Nothing is estimated where everything is seen: the shares are counts of n, their bands exact (Clopper and Pearson; by run, Korn
and Graubard, where flights share runs). They end where the first flight ends whose outcome was still open, for beyond it the
count is a lower bound only.

References
----------
Gooley, Leisenring, Crowley and Storer (1999), Estimation of failure probabilities in the presence of competing risks,
Statistics in Medicine 18(6), 695-706.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fddbench.interfaces import Floats
from fddbench.metrics.clustered import pooled_intervals

__all__ = ["MOST_TIMES", "Incidence", "incidence"]

_ENDED = ("right", "late", "wrong_site", "false_alarm")
MOST_TIMES = 11
"""Times at which a curve is kept; between them it stands at the last one."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Incidence:
    """Shares over time.

    Attributes
    ----------
    flights : int
        All flights n.
    time_s : (n_time,) array
        After the onset [s]: 0, and those at which something was counted.
    found, wrong : (n_time,) arrays of int
        Flights found, and with a healthy site declared, by then.
    alarmed : int
        Flights with an alarm before the onset.
    low, high : (n_time,) arrays
        Ends of the 95 % interval of the share found [-]; NaN: a single run has none.
    end_s : float
        Until when everything is seen [s]; NaN: nothing was flown.
    """

    flights: int
    time_s: Floats
    found: npt.NDArray[np.int64]
    wrong: npt.NDArray[np.int64]
    alarmed: int
    low: Floats
    high: Floats
    end_s: float


def incidence(
    outcome: npt.NDArray[np.object_],
    *,
    found_s: Floats,
    wrong_s: Floats,
    seen_s: Floats,
    run: npt.ArrayLike,
    most: int = MOST_TIMES,
) -> Incidence:
    """Cumulative incidence of the flown faulty flights of one scenario and detector.

    Parameters
    ----------
    outcome : (n,) array of str
        As in the rows.
    found_s, wrong_s : (n,) arrays
        Columns ``detection_time_s`` and ``wrong_site_time_s`` [s]; NaN: never.
    seen_s : (n,) array
        How long each flight was watched after its onset [s].
    run : (n,) array
        Run of each flight.
    most : int
        At most so many times: quantiles of those counted, and the last.

    Examples
    --------
    >>> seen = incidence(
    ...     np.array(["right", "late", "wrong_site", "undecided"], dtype=object), found_s=np.array([0.1, 0.5, 0.7, np.nan]),
    ...     wrong_s=np.array([np.nan, np.nan, 0.2, np.nan]), seen_s=np.full(4, 10.0), run=np.arange(4))
    >>> seen.time_s.tolist(), seen.found.tolist(), seen.wrong.tolist(), seen.end_s
    ([0.0, 0.1, 0.2, 0.5], [0, 1, 1, 2], [0, 0, 1, 1], 10.0)
    """
    right, late, wrong, alarmed = (np.asarray(outcome == name, dtype=bool) for name in _ENDED)
    right |= late
    found_at = np.where(right, found_s, np.inf)
    wrong_at = np.where(wrong, wrong_s, np.inf)
    open_still = ~(right | wrong | alarmed)
    end = float(np.min(seen_s[open_still] if open_still.any() else seen_s, initial=np.inf)) if len(outcome) else np.nan
    times = np.concatenate([found_at[right], wrong_at[wrong]])
    end = max(end, float(np.max(times, initial=0.0))) if not open_still.any() else end
    at = np.concatenate([[0.0], _thinned(np.unique(times[(times <= end) & (times > 0.0)]), most - 1)])
    by_run, runs = _counts(found_at, at, run)
    trials = np.bincount(runs, minlength=by_run.shape[0]).astype(np.float64)
    low, high = pooled_intervals(by_run, np.repeat(trials[:, np.newaxis], len(at), axis=1))
    return Incidence(
        flights=len(outcome), time_s=at, found=by_run.sum(axis=0).astype(np.int64),
        wrong=np.searchsorted(np.sort(wrong_at), at, side="right").astype(np.int64), alarmed=int(alarmed.sum()),
        low=low, high=high, end_s=end,
    )  # fmt: skip


def _thinned(times: Floats, most: int) -> Floats:
    """At most so many of sorted times, the first and the last among them."""
    if len(times) <= most:
        return times
    return times[np.unique(np.linspace(0, len(times) - 1, most).round().astype(np.int64))]


def _counts(found_at: Floats, at: Floats, run: npt.ArrayLike) -> tuple[Floats, npt.NDArray[np.int64]]:
    """Flights of each run found by each time, (n_runs, n_time), and the number of the run of each flight."""
    _, runs = np.unique(np.asarray(run), return_inverse=True)
    n_runs = int(runs.max(initial=-1)) + 1
    place = np.searchsorted(at, found_at)  # the first kept time that is not earlier
    inside = place < len(at)
    counts = np.zeros((n_runs, len(at)))
    np.add.at(counts, (runs[inside], place[inside]), 1.0)
    return np.cumsum(counts, axis=1), runs
