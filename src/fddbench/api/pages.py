"""The page of a folder of results, of several side by side, and its pictures one by one."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from fddbench.api import report_pictures
from fddbench.api.comparison_data import comparison_data
from fddbench.api.report_data import report_data
from fddbench.errors import FddbenchError, ResultsError
from fddbench.reporting.page.comparison import write_comparison
from fddbench.reporting.page.writing import write_page
from fddbench.reporting.svg.picture import Picture

__all__ = ["Report", "newest", "report"]


class Report:
    """Pages and pictures of results; called it writes a page, its functions draw one picture each.

    Examples
    --------
    >>> import fddbench
    >>> fddbench.report("results/smoke")  # doctest: +SKIP
    >>> fddbench.report.outcome_matrix("results/smoke").save("matrix.pdf")  # doctest: +SKIP
    """

    def __call__(
        self,
        folder: str | Path | Sequence[str | Path] | None = None,
        output: str | Path | None = None,
        *,
        replay: bool = True,
    ) -> Path:
        """Write a page: one HTML file that needs no network; where it was written.

        Parameters
        ----------
        folder : str, Path or sequence of them, optional
            Folder of results, by default the newest under ``results/``; of several their comparison.
        output : str or Path, optional
            File to write; by default ``report.html`` in the folder, ``comparison.html`` beside the first of several.
        replay : bool
            Whether flights are flown again for signals, bands and the bound.

        Raises
        ------
        FddbenchError
            No folder of results, a damaged one, or a file that cannot be written.
        """
        several = [folder] if isinstance(folder, str | Path) else list(folder or [newest()])
        paths = [Path(each) for each in several]
        for path in paths:
            if not path.is_dir():
                raise ResultsError(f"{path} is no folder; name one that `fddbench run` wrote")
        single = len(paths) == 1
        usual = paths[0] / "report.html" if single else paths[0].parent / "comparison.html"
        target = usual if output is None else Path(output)
        data: Any = report_data(paths[0], replay=replay) if single else comparison_data(paths)
        try:
            write_page(data, target) if single else write_comparison(data, target)
        except OSError as error:
            raise FddbenchError(f"cannot write {target}: {error.strerror}; name another file with --output") from error
        return target

    @staticmethod
    def outcome_matrix(folder: str | Path) -> Picture:
        """Outcomes of every scenario with every detector; see `fddbench.api.report_pictures`."""
        return report_pictures.outcome_matrix(folder)

    @staticmethod
    def incidence(folder: str | Path, detector: str = "", scenario: str = "") -> Picture:
        """Share found right by each time, with bands; without a detector those of all."""
        return report_pictures.incidence(folder, detector, scenario)

    @staticmethod
    def failures(folder: str | Path, detector: str, scenario: str, parameter: str = "") -> Picture:
        """Failed share over the parts of a parameter."""
        return report_pictures.failures(folder, detector, scenario, parameter)

    @staticmethod
    def size_curve(folder: str | Path, detector: str, scenario: str) -> Picture:
        """Share found in time over the size of the fault."""
        return report_pictures.size_curve(folder, detector, scenario)

    @staticmethod
    def operating_curve(folder: str | Path, scenario: str = "", **chosen: Any) -> Picture:
        """False alarms per hour against missed or delay; `design`, `gain`, `measure` choose the curve."""
        return report_pictures.operating_curve_picture(folder, scenario, **chosen)

    @staticmethod
    def envelope(folder: str | Path, detector: str, x: str = "", y: str = "") -> Picture:
        """Failed share over two parameters as a map."""
        return report_pictures.envelope(folder, detector, x, y)


def newest(parent: str | Path = "results") -> Path:
    """Folder of results that was written to last, of those under `parent`.

    Raises
    ------
    ResultsError
        There is none.
    """
    found = [path.parent for path in Path(parent).glob("*/manifest.jsonl")]
    if not found:
        raise ResultsError(f"{parent}/ holds no folder of results; fly a campaign first, or name a folder")
    return max(found, key=lambda path: (path / "manifest.jsonl").stat().st_mtime_ns)


report = Report()
"""Writes pages; see `Report`."""
