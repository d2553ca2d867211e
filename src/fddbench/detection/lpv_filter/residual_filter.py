"""One filter of a bank: its residual, and the size of its fault that explains it."""

import numpy as np

from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Row, Rows
from fddbench.blocks.linear import affine, column, product, total
from fddbench.blocks.solve import solve
from fddbench.detection.lpv_filter.course import Course
from fddbench.detection.lpv_filter.gains import FilterEntry
from fddbench.detection.lpv_filter.propagation import Constant, Varying
from fddbench.interfaces import Floats

__all__ = ["ResidualFilter", "table_of"]


class ResidualFilter:
    """``w' = N(rho) w - G(rho) y + F(rho) u, r = M w - H y``, and the fault ``v = g' r / g' g`` with ``g = M N^-1 PL``.

    Of a sensor g is the column of -H of its output: what a fault that has just begun leaves.

    Parameters
    ----------
    entry : FilterEntry
    sample_s : float
        Time between two samples [s].
    """

    def __init__(self, entry: FilterEntry, sample_s: float) -> None:
        self.N, self.G, self.F, self.PL = (table_of(family) for family in (entry.N, entry.G, entry.F, entry.PL))
        self.M, self.H, self.first = column(entry.M), column(entry.H), column(entry.start)
        self.fresh = None if entry.output is None else self.H[:, entry.output]
        self.unit, self.least = entry.unit_per_fault, entry.least_gain * entry.least_gain
        self.share = float(1.0 - exp(np.array(-sample_s / entry.smooth_s))) if entry.smooth_s else 1.0
        self.order, self.varies = self.N.shape[1], len(self.N) > 1
        N = self.N[0, :, :, 0]
        self.constant, self.varying = Constant(N, sample_s), Varying(sample_s)
        self.shown = self.M if self.varies else column(np.linalg.solve(N.T, np.array(entry.M).T).T)  # M N^-1

    def begin(self, y: Rows) -> Rows:
        """State at the first sample, (k, n_cases)."""
        return product(self.first, y)

    def move(self, w: Rows, course: Course, rho: Rows) -> Rows:
        """State after one more sample, (k, n_cases), over which y and u take a course and rho is held."""
        G, F = affine(self.G, rho), affine(self.F, rho)
        a = tuple(-product(G, y) for y in course.y)
        a = (a[0] + product(F, course.u[0]), a[1] + product(F, course.u[1]), a[2])
        return self.varying.step(affine(self.N, rho), w, a) if self.varies else self.constant.step(w, a)

    def smoothed(self, before: Row, fault: Row, first: Row) -> Row:
        """Estimate behind its lag, (n_cases,), of that of the sample before."""
        return fault if self.share == 1.0 else np.where(first, fault, before + self.share * (fault - before))

    def fault(self, w: Rows, y: Rows, rho: Rows) -> Row:
        """Size of the fault, (n_cases,) in the unit of its site, that leaves this residual: steady, or on a sensor at once."""
        residual = product(self.M, w) - product(self.H, y)
        if self.fresh is not None:
            return -self.unit * total(self.fresh * residual) / total(self.fresh * self.fresh)
        PL = affine(self.PL, rho)[:, 0]
        g = product(self.shown, solve(affine(self.N, rho), PL) if self.varies else PL)
        return self.unit * total(g * residual) / np.maximum(total(g * g), self.least)


def table_of(family: tuple[tuple[tuple[float, ...], ...], ...]) -> Floats:
    """A family as (n, rows, columns, 1); one without any part that moves is constant."""
    table = column(family)
    return table if np.any(table[1:]) else table[:1]
