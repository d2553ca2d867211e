"""From what flights and their healthy twins kept to the columns of rows."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from fddbench.interfaces import NEVER, Floats
from fddbench.metrics.consequences import Consequences, Sum, begin_of

__all__ = ["consequence_columns"]

Booleans = npt.NDArray[np.bool_]


def consequence_columns(
    announced: Consequences, own: Floats, twins: Floats, *, k0: Floats, last_scored: Floats, valid: Booleans
) -> dict[str, pa.Array]:
    """Columns of flights, one entry a case; null where not valid, where no faulty sample was flown, and without a twin.

    Parameters
    ----------
    announced : Consequences
        Of the loop.
    own, twins : (n_rows, n_cases) arrays
        What was kept of the flights and of their healthy twins, by the layout of `announced`; not-a-number where there is no
        twin.
    k0, last_scored : (n_cases,) arrays
        First faulty sample (`NEVER`: healthy), and last scored sample.
    valid : (n_cases,) array of bool
        Where the flight has a score.
    """
    x, twin, begin = announced.states.unpack(own), announced.states.unpack(twins), begin_of(k0)
    flown = valid & (last_scored >= begin)
    faulty = flown & (k0 < NEVER)
    found: dict[str, pa.Array] = {}
    for each, mine, theirs in zip(announced.peaks, x.peaks, twin.peaks, strict=True):
        found[each.name] = _nullable(mine, flown)
        found[f"healthy_{each.name}"] = _nullable(theirs, faulty)
    for each, mine, theirs in zip(announced.errors, x.ends, twin.ends, strict=True):
        found[each.name] = _nullable(mine - theirs, faulty)
    count = np.maximum(last_scored - begin + 1.0, 1.0)
    for each, pair in zip(announced.rises, zip(x.sums, twin.sums, strict=True), strict=True):
        found[each.name] = _nullable(_rise_percent(*_means(pair, count)), faulty)
    return found


def _means(sums: tuple[Sum, Sum], count: Floats) -> Iterator[Floats]:
    for each in sums:
        yield (each.total - each.before) / count


def _rise_percent(own: Floats, healthy: Floats) -> Floats:
    """How much larger the mean is [%]; not-a-number where the healthy one is zero."""
    there = np.where(healthy != 0.0, healthy, np.nan)
    rise: Floats = 100.0 * (own - there) / np.abs(there)
    return rise


def _nullable(values: Any, valid: Booleans) -> pa.Array:
    """Values, null where not valid or not a finite number."""
    return pa.array(np.asarray(values), mask=~(valid & np.isfinite(values)), from_pandas=False)
