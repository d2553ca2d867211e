"""Campaigns that do not keep all their rows: which they keep, and what may be concluded from these.

All rows are flown and counted (`fddbench.results.tallies`). Kept are those of the first runs of every scenario, which are a
campaign by themselves, drawn like the whole (of ``sampling: table`` they are its first rows); every other row that ended in an
error; and, where that is asked for, those that were scored and are wrong. Rates, intervals and comparisons come from the
tallies or from the first runs alone, never from rows kept because they failed.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc

from fddbench.errors import ResultsError
from fddbench.results.folder import provenance_of
from fddbench.results.schema import FAILED

__all__ = ["Kept", "kept_in", "kept_of"]

_WRONG = ("false_alarm", "wrong_site", "late", "missed")
_ADDRESS = ("scenario", "point", "level", "run", "detector")


@dataclass(frozen=True)
class Kept:
    """Which rows of a campaign are kept.

    Attributes
    ----------
    runs : int
        First runs of every scenario of which all rows are.
    failures : bool
        Whether, of other runs, beside rows that ended in an error (`fddbench.results.schema.FAILED`) those are whose outcome
        is a false alarm, a wrong site, late or missed.

    Examples
    --------
    >>> print(Kept(runs=100, failures=False))
    the rows of runs 0 to 99, and of others those that ended in an error
    """

    runs: int
    failures: bool

    def __str__(self) -> str:
        more = "those that failed" if self.failures else "those that ended in an error"
        return f"{self.first}, and of others {more}"

    @property
    def first(self) -> str:
        """Rows that rates may be taken of, in words."""
        return f"the rows of runs 0 to {self.runs - 1}" if self.runs > 1 else "the rows of run 0"

    def thinned(self, rows: pa.Table, events: pa.Table) -> tuple[pa.Table, pa.Table]:
        """Rows that are kept of some, and their events."""
        keep = pc.or_(pc.less(rows["run"], self.runs), pc.is_in(rows["status"], value_set=pa.array(sorted(FAILED))))
        if self.failures:
            keep = pc.or_(keep, pc.is_in(rows["outcome"], value_set=pa.array(_WRONG)))
        own = rows.filter(keep)
        return own, events.filter(pc.is_in(_addresses(events), value_set=_addresses(own).combine_chunks()))

    def plain(self) -> dict[str, Any]:
        """Data for provenance.json."""
        return {"kept": asdict(self)}


def kept_in(provenance: Mapping[str, Any]) -> Kept | None:
    """Which rows a folder keeps, by its provenance; None: all.

    Raises
    ------
    ResultsError
        The provenance is not as it was written.
    """
    written = provenance.get("kept")
    if written is None:
        return None
    try:
        found = Kept(**written)
        if isinstance(found.runs, int) and found.runs > 0 and isinstance(found.failures, bool):
            return found
    except TypeError:
        pass
    raise ResultsError(f"the entry kept of provenance.json is not as it was written, got {written!r}; put it back")


def kept_of(folder: Path) -> Kept | None:
    """Which rows a folder of results keeps; None: all.

    Raises
    ------
    ResultsError
        No folder of results, or its provenance is damaged.
    """
    return kept_in(provenance_of(folder))


def _addresses(table: pa.Table) -> pa.ChunkedArray:
    """Names of rows, one text each."""
    return pc.binary_join_element_wise(*[pc.cast(table[name], pa.string()) for name in _ADDRESS], "/")
