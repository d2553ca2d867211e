"""Folders of results as views of a data base: SQL over the files themselves, numbered as the campaign of today."""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy.typing as npt

from fddbench.results.folder import provenance_of
from fddbench.results.kept import kept_of
from fddbench.results.schema import CASE, EVENTS, rows_schema
from fddbench.results.shards import open_table
from fddbench.results.stages import Numbering
from fddbench.results.table import column_names, files
from fddbench.results.tallies import TALLIES

__all__ = ["views"]


def views(folder: Path) -> Iterator[tuple[str, str]]:
    """Name and statement of the views ``rows`` and ``events`` of a folder; every file is checked first.

    Of a folder that does not keep all rows, ``tallies`` are what is counted of all.

    Yields
    ------
    (str, str)
        ``rows``, and a SELECT that DuckDB reads.

    Raises
    ------
    ResultsError
        As `fddbench.results.table.load`.
    """
    for name, columns in (("rows", column_names(folder)), ("events", [CASE.name, *EVENTS.names])):
        yield name, _statement(folder, name, columns[1:])
    if kept_of(folder) is not None:
        yield "tallies", _statement(folder, "tallies", TALLIES.names)


def _statement(folder: Path, which: str, columns: list[str]) -> str:
    """SELECT over all shards, those of a fingerprint together."""
    schema = {"events": EVENTS, "tallies": TALLIES}.get(which) or rows_schema(())
    numbering, paths, own = Numbering(provenance_of(folder)), dict[str, list[Path]](), dict[str, set[str]]()
    for path, sha256, fingerprint in files(folder, which):
        found = open_table(path, sha256, schema=schema, fingerprint=fingerprint)
        paths.setdefault(fingerprint, []).append(path)
        own[fingerprint] = set(found.schema_arrow.names)
    named = which != "tallies"  # a tally is of many flights
    parts = [_part(paths[each], columns, own[each], numbering.points_of(each), named=named) for each in paths]
    return "\nUNION ALL\n".join(parts or [_nothing()])


def _part(
    paths: list[Path],
    columns: list[str],
    own: set[str],
    points: npt.NDArray | None,  # type: ignore[type-arg]
    *,
    named: bool,
) -> str:
    """SELECT over files of one fingerprint: names of flights, points as they are numbered today, null for what came later."""
    point = '"point"' if points is None else f'[{", ".join(map(str, points.tolist()))}]["point" + 1]'
    case = f"concat_ws('/', scenario, {point}, level, run) AS \"case\""
    chosen = [*([case] if named else []), *[_column(name, point, own) for name in columns]]
    listed = ", ".join(_quoted(re.sub(r"([*?\[])", r"[\1]", path.absolute().as_posix())) for path in paths)
    return f"SELECT {', '.join(chosen)} FROM read_parquet([{listed}])"


def _column(name: str, point: str, own: set[str]) -> str:
    if name == "point":
        return f"CAST({point} AS BIGINT) AS point"
    return f'"{name}"' if name in own else f'CAST(NULL AS DOUBLE) AS "{name}"'


def _nothing() -> str:
    """Events of a folder that has none."""
    types = {"string": "VARCHAR", "int64": "BIGINT", "double": "DOUBLE"}
    columns = [f'CAST(NULL AS {types[str(field.type)]}) AS "{field.name}"' for field in [CASE, *EVENTS]]
    return f"SELECT {', '.join(columns)} WHERE false"


def _quoted(text: str) -> str:
    return "'" + text.replace("'", "''") + "'"
