"""What a worker does: read the frozen campaign, fly a chunk, write its shard, say what is in it."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from threading import Lock

import numpy as np
import numpy.typing as npt

from fddbench.results.manifest import Shard
from fddbench.runner.assembling import assemble, with_detectors
from fddbench.runner.chunks import Spans, expand
from fddbench.runner.fingerprint import frozen_to_fly, kept_by
from fddbench.runner.flight import Flyer
from fddbench.runner.given_up import GivenUps
from fddbench.runner.rows import rows_and_events
from fddbench.runner.writing import write_shard

__all__ = ["Work", "fly_and_write", "flyer_of", "lent"]

Cases = npt.NDArray[np.int64]

_making, _writing = Lock(), Lock()


@dataclass(frozen=True, kw_only=True)
class Work:
    """What a worker is given beside its cases; it crosses as plain data.

    Attributes
    ----------
    folder, fingerprint, backend : str
        Folder of results, the fingerprint of what flies, and the back end.
    given_up : tuple
        Detectors that are given up.
    detectors : tuple of str
        Those that rows are written of; empty: all of the campaign.
    label : str
        Digits in the names of its shards, "" in a folder that never grew.
    """

    folder: str
    fingerprint: str
    backend: str
    given_up: GivenUps = ()
    detectors: tuple[str, ...] = ()
    label: str = ""


_lent: dict[Work, Flyer] = {}


@contextmanager
def lent(flyer: Flyer, work: Work) -> Iterator[None]:
    """Fly a frozen campaign in the threads of this process with what flies it already, compiled now; forgotten afterwards."""
    flyer.prepare()
    _lent[work] = flyer
    try:
        yield
    finally:
        with _writing:  # a thread that is writing comes to its end, and none begins
            del _lent[work]


def flyer_of(work: Work) -> Flyer:
    """What flies a frozen campaign, lent or made and compiled once per process."""
    known = _lent.get(work)
    if known is not None:
        return known
    with _making:
        return _flyer(work)


@lru_cache(maxsize=2)
def _flyer(work: Work) -> Flyer:
    campaign = with_detectors(frozen_to_fly(Path(work.folder), work.fingerprint), work.detectors)
    flyer = Flyer(assemble(campaign), work.backend, dict(work.given_up))
    flyer.prepare()
    return flyer


def fly_and_write(work: Work, case_spans: Spans) -> Shard:
    """Fly the cases and write their shard into the folder of results."""
    cases, in_thread = expand(case_spans), work in _lent
    flyer = flyer_of(work)
    rows, events = rows_and_events(flyer, cases, work.detectors)
    with _writing:
        if in_thread and work not in _lent:
            raise InterruptedError("the run that gave out this work has ended")
        return write_shard(
            Path(work.folder),
            cases,
            rows,
            events,
            fingerprint=work.fingerprint,
            kept=kept_by(flyer.assembly.plan.campaign),
            detectors=work.detectors,
            label=work.label,
        )
