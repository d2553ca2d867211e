"""How each estimate settles as runs are added: share right of the first m runs, with its interval."""

from dataclasses import dataclass

import numpy as np

from fddbench.interfaces import Floats
from fddbench.metrics.clustered import pooled_intervals
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.page.ranking import Rank
from fddbench.reporting.svg.axes import Plot, Scale, linear
from fddbench.reporting.svg.palette import band, series
from fddbench.reporting.svg.scene import Mark, Path, Scene, Text

__all__ = ["Settling", "convergence_scene", "settling"]

_LOOKS = 8


@dataclass(frozen=True, eq=False)
class Settling:
    """Numbers of runs, (n,), and the share right of the decided faulty flights of the first so many, with its interval [-]."""

    runs: Floats
    share: Floats
    low: Floats
    high: Floats


def settling(columns: Columns, detector: int) -> Settling | None:
    """Course of a detector over its runs in their order; None with fewer than two runs."""
    places = columns.of(detector)
    sure = places[columns.decided[places] & columns.faulty[places]]
    known, run = np.unique(columns.whole("run", sure), return_inverse=True)
    if len(known) < 2:
        return None
    right = columns.texts("outcome")[sure] == "right"
    trials = np.bincount(run, minlength=len(known)).astype(np.float64)
    hits = np.bincount(run, weights=right.astype(np.float64), minlength=len(known))
    looks = np.unique(np.geomspace(2, len(known), min(_LOOKS, len(known))).round().astype(np.int64))
    seen = np.arange(len(known))[:, np.newaxis] < looks  # (n_runs, n_looks)
    low, high = pooled_intervals(np.where(seen, hits[:, np.newaxis], 0.0), np.where(seen, trials[:, np.newaxis], 0.0))
    share = (hits @ seen) / (trials @ seen)
    return Settling(looks.astype(np.float64), share, low, high)


def convergence_scene(columns: Columns, rank: Rank) -> Scene | None:
    """Picture of the course; None with fewer than two runs."""
    own = settling(columns, rank.number)
    if own is None:
        return None
    plot = Plot(50, 18, 272, 100, linear(0.0, float(own.runs[-1]), 6), Scale(0.0, 100.0, (0.0, 50.0, 100.0)))
    up, down = plot.at(own.runs, 100.0 * own.high), plot.at(own.runs, 100.0 * own.low)
    marks: list[Mark] = [Text(50, 12, rank.detector, bold=True), *plot.frame("", "right [%]")]
    marks.append(Path([*up, *reversed(down)], band(rank.number), closed=True))
    marks.append(Path(plot.at(own.runs, 100.0 * own.share), series(rank.number)))
    return Scene(330, 140, f"Share right of {rank.detector} over the number of runs", marks)
