"""Parameters of a flight: fixed by its point, drawn by its run, a pure function of the seed."""

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from fddbench.blocks.consumers import DISPERSION, MAX_ATTEMPTS
from fddbench.blocks.philox import normals, uniforms
from fddbench.campaign.rules.dispersions import Dispersions, Distribution, TruncatedNormal
from fddbench.campaign.rules.model import Purpose
from fddbench.campaign.shares import drawn_together
from fddbench.campaign.streams import flight_stream, name_word
from fddbench.interfaces import Floats, Parameter

__all__ = ["Runs", "digits", "parameters", "point_radices"]

Runs = npt.NDArray[np.int64]


def point_radices(dispersions: Dispersions) -> tuple[int, ...]:
    """Radix of every digit of a point's number, slowest first; their product is the number of points.

    The digits are the parameters of the grid in alphabetical order, and the sequence, so that the order of keys in a file
    means nothing. Exact for any size: nothing is expanded.

    Examples
    --------
    >>> point_radices(Dispersions(grid={"h_ft": (0.0, 1e4), "mass_kg": (1.0, 2.0, 3.0)}))
    (2, 3, 1)
    """
    grid = tuple(len(dispersions.grid[name]) for name in sorted(dispersions.grid))
    return (*grid, max((len(values) for values in dispersions.sequence.values()), default=1))


def digits(runs: Runs, radices: Sequence[int]) -> list[Runs]:
    """Digits of numbers in a mixed radix, slowest first; each (n,).

    >>> [digit.tolist() for digit in digits(np.array([0, 1, 5]), (2, 3))]
    [[0, 0, 1], [0, 1, 2]]
    """
    found: list[Runs] = []
    rest = np.asarray(runs, dtype=np.int64)
    for radix in reversed(radices):
        rest, digit = np.divmod(rest, radix)
        found.append(digit)
    return found[::-1]


def parameters(
    dispersions: Dispersions,
    benchmark_parameters: Sequence[Parameter],
    *,
    key: int,
    purpose: Purpose,
    points: Runs,
    runs: Runs,
    table: Mapping[str, Floats] | None = None,
) -> dict[str, Floats]:
    """Parameters of flights, true values, each (n,) in the unit of its name.

    A parameter's draw has the counter (hash of its name, attempt, run, stream of the purpose): adding a parameter or a
    point, reordering keys or asking for other runs changes no draw, and a run has the same draws at every point.

    Parameters
    ----------
    benchmark_parameters : sequence of Parameter
        All that a flight needs; those the campaign does not disperse have their default.
    key : int
        Seed of the campaign.
    points, runs : (n,) integers
        Numbers of the points and of the Monte-Carlo draws.
    table : mapping of str to (n_rows,) array, optional
        Explicit cases, a row a run.
    """
    runs = np.asarray(runs, dtype=np.int64)
    *grid, sequence = digits(points, point_radices(dispersions))
    found = {entry.name: np.full(len(runs), float(entry.default)) for entry in benchmark_parameters}
    for name, digit in zip(sorted(dispersions.grid), grid, strict=True):
        found[name] = np.asarray(dispersions.grid[name], dtype=float)[digit]
    for name, values in dispersions.sequence.items():
        found[name] = np.asarray(values, dtype=float)[sequence]
    if dispersions.monte_carlo:
        stream = flight_stream(purpose)
        together = drawn_together(dispersions.monte_carlo, key=key, stream=stream, runs=runs)
        for name, distribution in dispersions.monte_carlo.parameters.items():
            alone = name not in together
            found[name] = _draw(distribution, name, key=key, stream=stream, runs=runs) if alone else together[name]
    for name, rows in (table or {}).items():
        found[name] = rows[runs]
    return found


def _draw(distribution: Distribution, name: str, *, key: int, stream: int, runs: Runs) -> Floats:
    counter = (name_word(name), DISPERSION, runs, stream)
    if distribution.uniform is not None:
        low, high = distribution.uniform
        drawn: Floats = low + uniforms(counter, key)[0] * (high - low)
        return drawn
    if distribution.normal is not None:
        bell: Floats = distribution.normal.mean + distribution.normal.std * normals(counter, key)[0]
        return bell
    assert distribution.truncated_normal is not None
    return _draw_truncated(distribution.truncated_normal, name, key=key, stream=stream, runs=runs)


def _draw_truncated(window: TruncatedNormal, name: str, *, key: int, stream: int, runs: Runs) -> Floats:
    # A window of 10 % (the least that is accepted) is missed 256 times with probability 2e-12; then the edge is flown.
    found = np.full(len(runs), np.nan)
    open_ = np.arange(len(runs))
    for attempt in range(MAX_ATTEMPTS):
        counter = (name_word(name), DISPERSION + attempt, runs[open_], stream)
        found[open_] = window.mean + window.std * normals(counter, key)[0]
        open_ = open_[(found[open_] < window.low) | (found[open_] > window.high)]
        if not len(open_):
            break
    inside: Floats = np.minimum(np.maximum(found, window.low), window.high)
    return inside
