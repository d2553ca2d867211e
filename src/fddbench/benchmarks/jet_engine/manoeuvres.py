"""Input histories of the jet engine as breakpoint tables; the paper does not print its own."""

from collections.abc import Mapping, Sequence

import numpy as np

from fddbench.interfaces import Floats

__all__ = ["DURATIONS_S", "KNOTS", "inputs"]

KNOTS = 6
_STEPS = (
    ((2.0, 0.0), (2.0, 1.0)),
    ((6.0, 0.0), (6.0, -1.0), (18.0, -1.0), (18.0, 0.5)),
    ((10.0, 0.0), (10.0, 1.0), (22.0, 1.0), (22.0, 0.0)),
)
_RAMPS = (((2.0, 0.0), (12.0, 1.0)), ((4.0, 0.0), (14.0, -1.0)), ((8.0, 0.0), (18.0, 1.0), (28.0, 0.0)))
_TABLES: Mapping[str, tuple[float, tuple[tuple[tuple[float, float], ...], ...]]] = {
    "idle": (0.0, _STEPS),  # u = 0
    "half_steps": (0.5, _STEPS),  # |u_i| <= 0.5
    "steps": (1.0, _STEPS),  # |u_i| <= 1: all three inputs step, one after the other
    "ramps": (1.0, _RAMPS),  # to the same sizes in 10 s
}

DURATIONS_S: Mapping[str, float] = dict.fromkeys(_TABLES, 40.0)
"""Manoeuvre → length of a healthy flight [s]."""


def inputs(manoeuvres: Sequence[str]) -> tuple[Floats, Floats]:
    """Times [s] and sizes [-] of the breakpoints of the three inputs, (3 KNOTS, n_cases) each, input after input."""
    time_s, size = np.empty((2, 3, KNOTS, len(manoeuvres)))
    for i, name in enumerate(manoeuvres):
        scale, tables = _TABLES[name]
        for j, table in enumerate(tables):
            padded = np.array([*table, *[table[-1]] * (KNOTS - len(table))])
            time_s[j, :, i], size[j, :, i] = padded[:, 0], scale * padded[:, 1]
    return time_s.reshape(3 * KNOTS, -1), size.reshape(3 * KNOTS, -1)
