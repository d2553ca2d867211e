"""What is counted of all rows, also of those that are not kept: exact, and added up without the rows.

A tally has a line for each combination of place, detector, status, outcome and detection time that occurred, with how many
rows it stands for. Detection times are whole samples, so the lines of a scenario are an integer histogram: quantiles read from
it are those of the rows. Everything else is a count, an extreme or a sum of whole microseconds: what parts add up to does not
depend on how rows were parted. Each line names one of its runs, a flight that ``fddbench replay`` flies again.
"""

from collections.abc import Sequence

import pyarrow as pa
import pyarrow.compute as pc

from fddbench.results.schema import SCHEMA_VERSION

__all__ = ["TALLIES", "added", "tally"]


def _column(name: str, kind: pa.DataType, about: str) -> pa.Field:
    return pa.field(name, kind, metadata={"about": about})


_KEYS = [
    _column("scenario", pa.string(), "name of the scenario"),
    _column("manoeuvre", pa.string(), "what the aircraft flies"),
    _column("point", pa.int64(), "number of the grid and sequence values"),
    _column("level", pa.int64(), "number of the values that the scenario sweeps"),
    _column("detector", pa.string(), "name of the design"),
    _column("status", pa.string(), "ok, or why there is no score"),
    _column("outcome", pa.string(), "of the flights; null: no score"),
    _column("faulty", pa.bool_(), "whether any site is faulty in them"),
    _column("departed", pa.bool_(), "whether they left the limits of their model"),
    _column("detection_time_s", pa.float64(), "from the onset to when the last fault was found [s]; null: not found"),
    _column("isolated", pa.bool_(), "declared sites at the end = faulty sites; null: healthy, or only detects"),
    _column("over_declared", pa.bool_(), "more sites declared than have been faulty; null as isolated"),
]
_SQUARED = pa.decimal128(38, 0)
_VALUES = [
    ("sum", _column("rows", pa.int64(), "rows that the line stands for")),
    ("min", _column("example_run", pa.int64(), "lowest run of them: a flight to replay")),
    ("sum", _column("watched", pa.int64(), "those that had a healthy stretch")),
    ("sum", _column("healthy_us", pa.int64(), "time of these to their first alarm or the end of the stretch, summed [us]")),
    ("sum", _column("healthy_us2", _SQUARED, "squares of these times, summed [us2]")),
    ("min", _column("detection_time_limit_min_s", pa.float64(), "smallest requirement [s]; null: healthy flights")),
    ("max", _column("normalized_detection_time_max", pa.float64(), "largest detection time over its limit [-]")),
    ("max", _column("changes_max", pa.int64(), "most changes of a declaration since the onset")),
    ("max", _column("margin_healthy_max", pa.float64(), "largest residual over threshold while healthy [-]")),
]  # fmt: skip
_NAMES = [field.name for field in _KEYS]
_SUMMED = [(field.name, function) for function, field in _VALUES]

TALLIES = pa.schema([*_KEYS, *[field for _, field in _VALUES]], metadata={"fddbench_schema": SCHEMA_VERSION})
"""Columns of a tally."""


def tally(rows: pa.Table) -> pa.Table:
    """Tally of rows of `fddbench.results.schema.rows_schema`; columns of `TALLIES`."""
    stretch_s = pc.min_element_wise(rows["onset_s"], rows["flight_s"], rows["false_alarm_time_s"])
    alarmed = pc.is_valid(rows["false_alarm_time_s"])
    healthy_s = pc.min_element_wise(rows["onset_s"], rows["flight_s"])
    watched = pc.and_(pc.equal(rows["status"], "ok"), pc.or_(pc.fill_null(pc.greater(healthy_s, 0.0), False), alarmed))
    time_us = pc.cast(pc.round(pc.multiply(pc.if_else(watched, stretch_s, 0.0), 1e6)), pa.int64())
    exact = pc.cast(time_us, pa.decimal128(19, 0)).cast(pa.decimal128(13, 0))
    columns = {name: rows[name] for name in _NAMES if name in rows.column_names} | {
        "faulty": pc.greater(rows["n_faulty"], 0),
        "departed": pc.is_valid(rows["departed_s"]),
        "rows": pa.repeat(pa.scalar(1, pa.int64()), len(rows)),
        "example_run": rows["run"],
        "watched": pc.cast(watched, pa.int64()),
        "healthy_us": time_us,
        "healthy_us2": pc.cast(pc.multiply(exact, exact), _SQUARED),
        "detection_time_limit_min_s": rows["detection_time_limit_s"],
        "normalized_detection_time_max": rows["normalized_detection_time"],
        "changes_max": rows["changes"],
        "margin_healthy_max": rows["margin_healthy"],
    }
    return _summed(pa.table([columns[name] for name in TALLIES.names], schema=TALLIES))


def added(tallies: Sequence[pa.Table]) -> pa.Table:
    """Tally of all rows that some tallies stand for."""
    return _summed(pa.concat_tables([TALLIES.empty_table(), *tallies]))


def _summed(table: pa.Table) -> pa.Table:
    """Lines with the same keys as one, in the order of their keys, so that equal tallies are equal files."""
    found = table.group_by(_NAMES, use_threads=False).aggregate(_SUMMED)
    columns = [found[name] for name in _NAMES] + [found[f"{name}_{function}"] for name, function in _SUMMED]
    lines = pa.table([pc.cast(c, f.type) for c, f in zip(columns, TALLIES, strict=True)], schema=TALLIES)
    return lines.sort_by([(name, "ascending") for name in _NAMES]).combine_chunks()
