"""A folder of results as a data base, for questions in SQL."""

from pathlib import Path
from typing import TYPE_CHECKING

from fddbench.errors import FddbenchError
from fddbench.results.table import warn_if_partial
from fddbench.results.views import views

if TYPE_CHECKING:
    from duckdb import DuckDBPyConnection

__all__ = ["duckdb"]


def duckdb(folder: str | Path) -> "DuckDBPyConnection":
    """Data base in memory with the views ``rows`` and ``events`` of a folder of results; its files are read, never written.

    The columns are those of `fddbench.load` and `fddbench.load_events`; DuckDB reads what a question needs and no more, so a
    campaign of any size fits. The order of rows is the question's own (``ORDER BY``). The views are those of the moment: ask
    for another data base after the folder has grown. Keep it in a variable while its answers are read: DuckDB 1 closes a data
    base that nobody holds.

    Parameters
    ----------
    folder : str or Path
        Folder of results.

    Warns
    -----
    PartialResultsWarning
        The folder does not hold all flights of its campaign.

    Raises
    ------
    FddbenchError
        DuckDB is not installed, or as `fddbench.load`.

    Examples
    --------
    >>> base = duckdb("results/smoke")  # doctest: +SKIP
    >>> base.sql("SELECT detector, outcome, count(*) FROM rows GROUP BY ALL").df()  # doctest: +SKIP
    """
    try:
        import duckdb as library
    except ImportError as error:
        raise FddbenchError(
            "questions in SQL need DuckDB: pip install 'fddbench[sql]'; or read with fddbench.load(folder, columns, filters)"
        ) from error
    path = Path(folder)
    statements = dict(views(path))
    base = library.connect()
    for name, statement in statements.items():
        base.execute(f"CREATE VIEW {name} AS {statement}")
    warn_if_partial(path)
    return base
