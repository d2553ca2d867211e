"""Where in the envelope flights fail: the failed share over two parameters, cell by cell, and where nothing can be flown."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.interfaces import Floats
from fddbench.reporting.formats import count, percent, shorts
from fddbench.reporting.labels import label
from fddbench.reporting.names import TITLE, shortened
from fddbench.reporting.page.columns import Columns
from fddbench.reporting.svg.axes import ticks_texts
from fddbench.reporting.svg.heat import HeatCell, Side, heat_scene
from fddbench.reporting.svg.scene import Scene

__all__ = ["FEW", "Corner", "envelope_maps", "envelope_pairs", "failed_map", "infeasible_map", "worst_and_best"]

FEW = 20
"""Flights below which a cell is hatched."""

_PARTS, _MOST_VALUES, _MOST_PAIRS = 5, 8, 2
Index = npt.NDArray[np.int64]


def envelope_pairs(columns: Columns, axes: Sequence[tuple[str, str]], swept: Sequence[str]) -> list[tuple[str, str]]:
    """Pairs of columns to map over: what the campaign sweeps on a grid, then what the benchmark names; those that vary."""
    every = np.arange(len(columns))
    varied = set(columns.varied(every, ("p_",)))
    grid = [name for name in swept if name in varied]
    pairs = [(f"p_{x}", f"p_{y}") for x, y in axes]
    found = [pair for pair in pairs if set(pair) <= varied]
    if len(grid) >= 2 and not any(set(grid[:2]) == set(pair) for pair in found):
        found.insert(0, (grid[0], grid[1]))
    return found[:_MOST_PAIRS]


def envelope_maps(columns: Columns, pairs: Sequence[tuple[str, str]], chosen: Sequence[int]) -> list[list[Scene]]:
    """Of each pair the maps of these detectors; pairs over which nothing is decided are left out."""
    found = []
    for x, y in pairs:
        scenes = [scene for d in chosen if (scene := failed_map(columns, d, x, y)) is not None]
        found += [scenes] if scenes else []
    return found


def failed_map(columns: Columns, detector: int, x: str, y: str) -> Scene | None:
    """Failed share of the decided faulty flights of a detector; None: none is decided, or a parameter does not vary."""
    places = columns.of(detector)
    cuts = _both(columns, places, x, y)
    if cuts is None:
        return None
    n, k = _decided(columns, places, cuts)
    if not n.any():
        return None
    lost = _counted(columns, places[columns.texts("status")[places] == "infeasible"], cuts)
    cells = []
    for i, j, ends in _grid(cuts):
        if n[i, j]:
            share = k[i, j] / n[i, j]
            text, below = f"{percent(100.0 * share)}", f"n {count(n[i, j])}"
            cells.append(HeatCell(**ends, dark=share, text=text, below=below, hatched=n[i, j] < FEW))
        elif lost[i, j]:
            cells.append(HeatCell(**ends, dark=None, text="inf."))
    name = columns.detectors[detector]
    return heat_scene(
        cells, x=cuts[0].side, y=cuts[1].side, title=shortened(columns.detectors, TITLE)[name],
        label=f"Failed share [%] of {name} over {label(x)} and {label(y)}",
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Corner:
    """A cell of the map in words, ``v tas [m/s] 160 to 182, altitude [m] 2000 to 3700``, its flights, and cells alike."""

    where: str
    failed: int
    decided: int
    alike: int


def worst_and_best(columns: Columns, detector: int, x: str, y: str) -> tuple[Corner, Corner] | None:
    """Cells of `failed_map` with the largest and the smallest failed share; None: no two with `FEW` flights differ in it."""
    places = columns.of(detector)
    cuts = _both(columns, places, x, y)
    if cuts is None:
        return None
    n, k = _decided(columns, places, cuts)
    known = [(i, j) for i, j, _ in _grid(cuts) if n[i, j] >= FEW]
    shares = [float(k[at] / n[at]) for at in known]
    if len(set(shares)) < 2:
        return None
    worst, best = (
        Corner(
            where=f"{cuts[0].words(i)}, {cuts[1].words(j)}", failed=int(k[i, j]), decided=int(n[i, j]),
            alike=shares.count(share),
        )
        for share in (max(shares), min(shares))
        for i, j in [known[shares.index(share)]]
    )  # fmt: skip
    return worst, best


def infeasible_map(columns: Columns, x: str, y: str) -> Scene | None:
    """Share of flights that cannot be flown, of all that were asked for; None: all can."""
    places = columns.of(0) if len(columns) else np.zeros(0, dtype=np.int64)
    lost = places[columns.texts("status")[places] == "infeasible"]
    cuts = _both(columns, places, x, y)
    if cuts is None or not len(lost):
        return None
    n, k = _counted(columns, places, cuts), _counted(columns, lost, cuts)
    cells = [
        HeatCell(**ends, dark=k[i, j] / n[i, j], text=percent(100.0 * k[i, j] / n[i, j]), below=f"n {count(n[i, j])}")
        for i, j, ends in _grid(cuts)
        if n[i, j]
    ]
    return heat_scene(
        cells, x=cuts[0].side, y=cuts[1].side, title="infeasible [%]", look="ts",
        label=f"Infeasible share [%] over {label(x)} and {label(y)}",
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class _Cut:
    """An axis cut into cells: few values that were asked for a cell each, side by side; of others parts of equal width."""

    name: str
    edges: Floats
    values: Floats | None

    def place(self, values: Floats) -> Index:
        """Cell of each value."""
        if self.values is not None:
            return np.clip(np.searchsorted(self.values, values), 0, len(self.values) - 1)
        return np.clip(np.searchsorted(self.edges, values, side="right") - 1, 0, len(self.edges) - 2)

    def words(self, i: int) -> str:
        """Cell `i`: its name and its value, or its ends."""
        ends = self.edges[i : i + 2] if self.values is None else self.values[i : i + 1]
        return f"{label(self.name)} {' to '.join(shorts(ends.tolist()))}"

    @property
    def side(self) -> Side:
        """The axis of the picture."""
        marked = self.edges if self.values is None else self.values
        at = self.edges if self.values is None else np.arange(len(self.values), dtype=np.float64)
        ticks = list(zip(at.tolist(), ticks_texts(marked.tolist()), strict=True))
        return Side(name=label(self.name), low=float(self.edges[0]), high=float(self.edges[-1]), ticks=ticks)


def _cut(columns: Columns, places: Index, name: str) -> _Cut | None:
    values = columns.numbers(name)[places]
    own = np.unique(values[~np.isnan(values)])
    if len(own) < 2:
        return None
    if len(own) <= _MOST_VALUES and not columns.drawn(name, places):
        return _Cut(name, np.arange(len(own) + 1, dtype=np.float64) - 0.5, own.astype(np.float64))
    return _Cut(name, np.linspace(own[0], own[-1], _PARTS + 1).astype(np.float64), None)


def _decided(columns: Columns, places: Index, cuts: tuple[_Cut, _Cut]) -> tuple[Index, Index]:
    """Decided faulty flights in each cell, and those of them that failed, (n_x, n_y)."""
    faulty = places[columns.faulty[places] & columns.decided[places]]
    return _counted(columns, faulty, cuts), _counted(columns, faulty[columns.failed[faulty]], cuts)


def _counted(columns: Columns, places: Index, cuts: tuple[_Cut, _Cut]) -> Index:
    """Rows in each cell, (n_x, n_y)."""
    values = [columns.numbers(cut.name)[places] for cut in cuts]
    known = ~np.isnan(values[0]) & ~np.isnan(values[1])
    found = np.zeros((len(cuts[0].edges) - 1, len(cuts[1].edges) - 1), dtype=np.int64)
    np.add.at(found, tuple(cut.place(v[known]) for v, cut in zip(values, cuts, strict=True)), 1)
    return found


def _grid(cuts: tuple[_Cut, _Cut]) -> list[tuple[int, int, dict[str, Any]]]:
    return [
        (i, j, {"x": x, "y": y})
        for j, y in enumerate(pairwise(cuts[1].edges.tolist()))
        for i, x in enumerate(pairwise(cuts[0].edges.tolist()))
    ]


def _both(columns: Columns, places: Index, x: str, y: str) -> tuple[_Cut, _Cut] | None:
    first, second = _cut(columns, places, x), _cut(columns, places, y)
    return None if first is None or second is None else (first, second)
