"""The page of a folder of results."""

from pathlib import Path

from fddbench.api.report_data import report_data
from fddbench.errors import FddbenchError, ResultsError
from fddbench.reporting.page.writing import write_page

__all__ = ["report"]


def report(folder: str | Path, output: str | Path | None = None) -> Path:
    """Write the page of a folder of results: one HTML file that needs no network; where it was written.

    Parameters
    ----------
    folder : str or Path
        Folder of results.
    output : str or Path, optional
        File to write, ``report.html`` in the folder by default.

    Raises
    ------
    FddbenchError
        No folder of results, a damaged one, or a file that cannot be written.
    """
    path = Path(folder)
    if not path.is_dir():
        raise ResultsError(f"{path} is no folder; name one that `fddbench run` wrote")
    target = path / "report.html" if output is None else Path(output)
    data = report_data(path)
    try:
        write_page(data, target)
    except OSError as error:
        raise FddbenchError(f"cannot write {target}: {error.strerror}; name another file with --output") from error
    return target
