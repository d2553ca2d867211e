"""The engine of one flight: nominal matrices, closed with its Δ, discretised by Tustin, as constants per flight."""

from pathlib import Path

import numpy as np
import yaml

from fddbench.blocks.layout import Layout, Rows, record
from fddbench.blocks.linear import column
from fddbench.blocks.tustin import identity, inverse, times
from fddbench.interfaces import Floats
from fddbench.systems import DiscreteLti

__all__ = ["CONSTANTS", "DELTA_79", "MATRICES", "EngineConstants", "N", "closed", "constants", "engine"]

_DATA = yaml.safe_load((Path(__file__).parent / "data" / "jet_engine.yaml").read_text(encoding="utf-8"))
_NAMES = {"A": "Ao", "B": "Bo", "C": "Co", "D": "Do"}

N = 3
"""States, outputs, faults, disturbances and inputs: three of each."""

MATRICES = {
    name: np.array(_DATA[_NAMES.get(name, name)], dtype=float)
    for name in ("A", "Bf", "Bd", "B", "C", "Df", "Dd", "D", "FA", "FC", "EA", "Ef", "Ed", "EB", "H")
}
"""Matrices of the uncertain plant as printed, by the names of `fddbench.design.systems.UncertainPlant`."""

DELTA_79 = np.array(_DATA["Delta79"], dtype=float)
"""Δ of equation (79), (3, 3)."""


@record
class EngineConstants:
    """Discrete-time matrices from (f, d, u) of every flight, row by row."""

    A: Rows
    B: Rows
    C: Rows
    D: Rows


CONSTANTS = Layout(EngineConstants(A=N * N, B=N * 3 * N, C=N * N, D=N * 3 * N))
"""Rows per flight."""


def closed(delta: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """A, B, C, D of the engines, (rows, columns, n_cases), from inputs (f, d, u), equation (5)."""
    m = {name: column(value) for name, value in MATRICES.items()}
    delta_h = times(inverse(identity(N) - times(delta, m["H"])), delta)
    seen = np.concatenate([m["Ef"], m["Ed"], m["EB"]], axis=1)
    inputs = np.concatenate([m["Bf"], m["Bd"], m["B"]], axis=1)
    outputs = np.concatenate([m["Df"], m["Dd"], m["D"]], axis=1)
    x, y = times(m["FA"], delta_h), times(m["FC"], delta_h)
    return m["A"] + times(x, m["EA"]), inputs + times(x, seen), m["C"] + times(y, m["EA"]), outputs + times(y, seen)


def constants(delta: Floats, sample_s: float) -> EngineConstants:
    """Constants of engines with these Δ, (3, 3, n_cases)."""
    return EngineConstants(**DiscreteLti.tustin(*closed(delta), sample_s=sample_s).rows())


def engine(c: EngineConstants, sample_s: float) -> DiscreteLti:
    """Engines of these constants, from (f, d, u) in nine rows to three outputs."""
    return DiscreteLti.from_rows(c.A, c.B, c.C, c.D, n_states=N, n_outputs=N, sample_s=sample_s)
