"""Cuts the cases of a campaign into chunks; where the cuts fall changes no result."""

from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt

from fddbench.campaign.plan import Plan

__all__ = ["CHUNK", "COMPILED_CHUNK", "OPAQUE_CHUNK", "cut", "expand", "missing", "spans"]

Cases = npt.NDArray[np.int64]
Spans = tuple[tuple[int, int], ...]

CHUNK = 256
"""Cases flown side by side with NumPy: wide enough to hide NumPy's cost per call, narrow enough to stay in the cache."""

COMPILED_CHUNK = 1024
"""Cases of one shard when compiled code flies them, a vector of cases at a time: few enough that all workers have some."""


OPAQUE_CHUNK = 64
"""Cases of one shard when detectors of ordinary Python fly them one by one: wide enough to hide the cost of scoring."""


def cut(plan: Plan, cases: Cases, *, size: int, jobs: int) -> list[Cases]:
    """Chunks of cases, longest flights first so that the workers end together.

    Flights of equal length fly together, since a chunk flies as long as its longest, and so do those of one manoeuvre, point
    and run, which share a healthy twin. No chunk holds more than `size` cases, nor more than its share when there are too few
    for all workers.
    """
    length = plan.n_samples(cases)
    chunks: list[Cases] = []
    for samples in sorted(set(length.tolist()), reverse=True):
        alike = cases[length == samples]
        n_chunks = max(-(-len(alike) // size), 1)
        n_chunks = min(-(-n_chunks // jobs) * jobs, max(n_chunks, -(-len(alike) // 16)))
        chunks += [np.sort(part) for part in np.array_split(_twins_together(plan, alike), n_chunks) if len(part)]
    return chunks


def _twins_together(plan: Plan, cases: Cases) -> Cases:
    """Cases in the order of their manoeuvres, points and runs."""
    at = plan.locate(cases)
    known = list(dict.fromkeys(scenario.manoeuvre for scenario in plan.scenarios))
    flown = np.array([known.index(scenario.manoeuvre) for scenario in plan.scenarios], dtype=np.int64)
    return cases[np.lexsort((cases, at.run, at.point, flown[at.scenario]))]


def spans(cases: Cases) -> Spans:
    """Case numbers as (first, count) of their unbroken stretches.

    >>> spans(np.array([0, 1, 2, 7]))
    ((0, 3), (7, 1))
    """
    breaks = np.flatnonzero(np.diff(cases) != 1) + 1
    return tuple((int(part[0]), len(part)) for part in np.split(cases, breaks) if len(part))


def expand(spans_: Iterable[Sequence[int]]) -> Cases:
    """Case numbers of stretches.

    >>> expand([(0, 3), (7, 1)])
    array([0, 1, 2, 7])
    """
    parts = [np.arange(first, first + count, dtype=np.int64) for first, count in spans_]
    return np.concatenate([*parts, np.empty(0, dtype=np.int64)])


def missing(n_cases: int, done: Iterable[Spans]) -> Cases:
    """Cases that no chunk has flown yet, in order."""
    left = np.ones(n_cases, dtype=bool)
    for each in done:
        left[expand(each)] = False
    return np.flatnonzero(left).astype(np.int64)
