"""Tables of a folder of results."""

from collections.abc import Collection, Sequence
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa

from fddbench.api.as_written import in_sample_as_written
from fddbench.api.detectability import detectable_of
from fddbench.errors import FddbenchError, UntrustedError
from fddbench.metrics.alarms import ALARMS, summarize_alarms
from fddbench.metrics.bound import BOUNDS
from fddbench.metrics.detectable import DETECTABLE
from fddbench.metrics.operating import OPERATING
from fddbench.metrics.requirements import JUDGEMENTS
from fddbench.metrics.summary import NEEDS, SUMMARY, summarize
from fddbench.metrics.tallied import summarize_tallies, tallied_alarms
from fddbench.results import table
from fddbench.results.counted import read_tallies
from fddbench.results.filters import Condition
from fddbench.results.fingerprint import Fingerprint
from fddbench.results.folder import provenance_of
from fddbench.results.kept import kept_of
from fddbench.results.schema import CASE, EVENTS, rows_schema
from fddbench.results.shards import write_table
from fddbench.results.tallies import TALLIES
from fddbench.runner.fingerprint import frozen

__all__ = ["alarms", "columns", "detectable", "in_sample", "leave_summary", "load", "load_events", "overview"]


def load(
    folder: str | Path, columns: Sequence[str] | None = None, filters: Sequence[Condition] | None = None
) -> pd.DataFrame:
    """Rows of a folder of results, one per case and detector; Arrow-backed pandas, null means none.

    See `fddbench.results.table.load`.

    Examples
    --------
    >>> load("results/smoke", ["case", "outcome"], [("detector", "=", "voting_monitor")])  # doctest: +SKIP
    """
    return table.load(folder, columns, filters)


def load_events(folder: str | Path) -> pd.DataFrame:
    """Events of a folder of results, one per case, detector and fault where faults are several or end."""
    return table.load_events(folder)


def alarms(folder: str | Path) -> pd.DataFrame:
    """One line per detector: false alarms of its distinct flights; columns of `fddbench.metrics.alarms.ALARMS`."""
    path = Path(folder)
    if kept_of(path) is not None:
        counted = tallied_alarms(read_tallies(path), in_sample=in_sample(folder))
        table.warn_if_partial(path, counted=True)
        return counted
    return summarize_alarms(table.load(folder, ["case", *NEEDS]), in_sample=in_sample(folder))


def overview(folder: Path) -> tuple[pd.DataFrame, pd.DataFrame]:
    """What `summary` and `alarms` give of all rows, kept or not, for those who say themselves whether the folder is whole.

    Of a large campaign the rows of one detector at a time are in memory.

    Raises
    ------
    ResultsError
        As `load`.
    """
    own = in_sample(folder)
    if kept_of(folder) is not None:
        tallies = read_tallies(folder)
        return summarize_tallies(tallies, in_sample=own), tallied_alarms(tallies, in_sample=own)
    # map lets go of one part before it asks for the next
    parts = list(map(partial(_summarized, own), table.read_in_parts(folder, NEEDS)))
    lines, of_alarms = (pd.concat(each, ignore_index=True) for each in zip(*parts, strict=True))
    # scenarios in the order of the rows, in each the detectors likewise
    order = np.argsort(pd.factorize(lines["scenario"])[0], kind="stable")
    return lines.iloc[order].reset_index(drop=True), of_alarms


def leave_summary(folder: Path) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Write ``summary.parquet`` beside the rows: what `overview` gives first; gives both."""
    lines, of_alarms = overview(folder)
    fingerprint = Fingerprint.of(provenance_of(folder)).sha256
    write_table(
        folder / "summary.parquet",
        pa.Table.from_pandas(lines, schema=SUMMARY, preserve_index=False),
        fingerprint=fingerprint,
    )
    return lines, of_alarms


def _summarized(own: Collection[str], rows: pd.DataFrame) -> tuple[pd.DataFrame, pd.DataFrame]:
    return summarize(rows, in_sample=own), summarize_alarms(rows, in_sample=own)


def detectable(folder: str | Path) -> pd.DataFrame:
    """Smallest faults found in 90 % of flights, over the whole envelope and cell by cell, where the benchmark asks for maps.

    The columns are those of `fddbench.metrics.detectable.DETECTABLE`.
    """
    return detectable_of(table.load(folder, fair=True), frozen(Path(folder)))


def in_sample(folder: str | Path) -> tuple[str, ...]:
    """Detectors of a folder of results whose designs were tuned on its flights; nothing of somebody else's runs for that."""
    try:
        return frozen(Path(folder)).in_sample
    except UntrustedError:
        return in_sample_as_written(Path(folder))


def columns(table: str = "rows") -> dict[str, str]:
    """What each column of a table means, by name.

    Parameters
    ----------
    table : {"rows", "events", "tallies", "summary", "alarms", "detectable", "bounds", "operating", "requirements"}
        As `load`, `load_events`, `summary`, `alarms`, `detectable`, `bounds`, `operating_curve` and `requirements` give
        them. Rows have besides a column ``p_<name>`` a parameter, ``f1_<key>`` what is drawn or swept of the first fault, and
        ``gain_<key>`` or ``factor_<key>`` what is swept of detectors.

    Examples
    --------
    >>> columns()["alarm_time_s"]
    'from the onset to the first alarm raised since [s]; null: none'
    """
    known = {"rows": [CASE, *rows_schema(())], "events": [CASE, *EVENTS], "summary": SUMMARY, "alarms": ALARMS}
    known |= {"tallies": TALLIES}
    known |= {"detectable": DETECTABLE, "bounds": BOUNDS, "operating": OPERATING, "requirements": JUDGEMENTS}
    if table not in known:
        raise FddbenchError(f"no table is called {table!r}; known: {', '.join(known)}")
    return {field.name: field.metadata[b"about"].decode() for field in known[table]}
