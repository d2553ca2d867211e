"""Refuses banks whose matrices do not fit each other, the bus or the scheduling, and banks that diverge."""

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np

from fddbench.detection.lpv_filter.gains import FilterEntry, LpvFilterGains
from fddbench.detection.lpv_filter.propagation import rest_of_series
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Floats, Scheduling

__all__ = ["require_fit"]

_LARGEST_REST = 1e-7
"""Of the series by which a filter whose N moves is stepped [-]."""
_SIDES = {
    "N": ("k", "k"), "G": ("k", "y"), "F": ("k", "u"), "PL": ("k", "one"), "M": ("r", "k"), "H": ("r", "y"),
    "start": ("k", "y"),
}  # fmt: skip
"""Rows and columns: states, outputs, inputs, residuals."""
_FAMILIES = ("N", "G", "F", "PL")


def require_fit(gains: LpvFilterGains, bus: Bus, scheduling: Scheduling | None) -> None:
    """Do nothing for a bank that can fly.

    Raises
    ------
    DesignError
        Sizes differ, a site is watched twice, or a filter diverges.
    """
    sites = [entry.site for entry in gains.filters]
    if len(set(sites)) < len(sites):
        raise DesignError(f"two filters speak for one site: {sites}; each site has one")
    counts = {"thresholds": len(gains.thresholds)}
    counts |= {} if gains.trim is None else {"trim.freeze_above": len(gains.trim.freeze_above)}
    for name, count in counts.items():
        if count != len(sites):
            raise DesignError(f"{name} has {count} numbers for {len(sites)} filters; give one for each")
    _require_sensors(gains)
    n_rho = 0 if scheduling is None else len(scheduling.parameters)
    _require_family("bend", gains.bend, (len(gains.outputs), len(gains.outputs)), n_rho)
    for number, entry in enumerate(gains.filters):
        _require_shapes(f"filters[{number}]", entry, len(gains.outputs), len(gains.inputs), n_rho)
        _require_stable(f"filters[{number}]", entry, scheduling, bus.sample_s)


def _require_sensors(gains: LpvFilterGains) -> None:
    """Outputs of sensors exist and are seen by their filters; a decision among sensors has two and only such."""
    for number, entry in enumerate(gains.filters):
        if entry.output is not None and entry.output >= len(gains.outputs):
            raise DesignError(
                f"filters[{number}].output: {entry.output}, there are outputs 0 to {len(gains.outputs) - 1}"
            )
        if entry.output is not None and not any(row[entry.output] for row in entry.H if len(row) > entry.output):
            raise DesignError(f"filters[{number}].output: H does not see output {entry.output}; its column is zero")
    if gains.sensors is not None and (len(gains.filters) < 2 or any(entry.output is None for entry in gains.filters)):
        raise DesignError("sensors: needs two filters or more, each with the output of its sensor")


def _require_shapes(where: str, entry: FilterEntry, n_y: int, n_u: int, n_rho: int) -> None:
    sizes = {"k": len(entry.M[0]), "y": n_y, "u": n_u, "one": 1, "r": len(entry.M)}
    for name, (rows, columns) in _SIDES.items():
        given = getattr(entry, name)
        family = given if name in _FAMILIES else (given,)
        _require_family(f"{where}.{name}", family, (sizes[rows], sizes[columns]), n_rho)


def _require_family(name: str, family: tuple[Any, ...], need: tuple[int, int], n_rho: int) -> None:
    if len(family) not in (1, n_rho + 1):
        raise DesignError(
            f"{name} has {len(family)} matrices for {n_rho} scheduling parameters; it needs 1 or {n_rho + 1}"
        )
    for matrix in family:
        widths = {len(row) for row in matrix}
        found = (len(matrix), widths.pop() if len(widths) == 1 else -1)
        if found != need:
            raise DesignError(f"{name} is {found[0]} x {found[1]}, needs {need[0]} x {need[1]}")


def _require_stable(where: str, entry: FilterEntry, scheduling: Scheduling | None, sample_s: float) -> None:
    """Poles at the corners of the box of the parameters that move N, where a scheduling says its box."""
    for N in _corners(np.array(entry.N), scheduling):
        poles = np.linalg.eigvals(N)
        if np.any(poles.real >= 0.0):
            raise DesignError(
                f"{where} diverges: N has poles {np.round(poles, 4).tolist()} in continuous time, all real parts must be "
                "negative"
            )
        rest = rest_of_series(float(np.linalg.norm(N, 2)) * sample_s)
        if len(entry.N) > 1 and rest > _LARGEST_REST:
            raise DesignError(
                f"{where} is too fast for samples of {sample_s} s: the series that steps it would be off by {rest:.1g}; take "
                "shorter samples or a smaller decay"
            )


def _corners(N: Floats, scheduling: Scheduling | None) -> Iterator[Floats]:
    box = getattr(scheduling, "box", None)
    moving = [j for j in range(len(N) - 1) if np.any(N[j + 1])]
    if not moving or box is None or len(moving) > 10:
        if not moving:
            yield N[0]
        return
    for corner in product(*(box[j] for j in moving)):
        yield N[0] + sum(value * N[j + 1] for value, j in zip(corner, moving, strict=True))
