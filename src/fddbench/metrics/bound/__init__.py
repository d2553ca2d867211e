"""How well any detector can do: the ideal test that knows the model, the fault and its time."""

from fddbench.metrics.bound.beside import BESIDE, breaches, with_bounds
from fddbench.metrics.bound.ideal_test import MOST_D, Faults, detectability
from fddbench.metrics.bound.lines import BOUNDS, bound_line, bounds_table
from fddbench.metrics.bound.power import P_FA, power

__all__ = [
    "BESIDE",
    "BOUNDS",
    "MOST_D",
    "P_FA",
    "Faults",
    "bound_line",
    "bounds_table",
    "breaches",
    "detectability",
    "power",
    "with_bounds",
]
