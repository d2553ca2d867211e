"""Pictures of a table or of one flight, for reports and notebooks: PNG as bytes."""

from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from fddbench.api.flights import signals
from fddbench.errors import FddbenchError
from fddbench.reporting.reconstruction import reconstruction_png
from fddbench.reporting.tradeoffs import tradeoff_png

__all__ = ["reconstruction_picture", "tradeoff_picture"]

_COLUMNS = {
    "gamma_here": "γ with the weights\nof the first (log)",
    "rms_0": "rms, first point",
    "rms_1": "rms, second point",
    "chatter_1_s": "chatter, first point\n[1/s] (log)",
}


def tradeoff_picture(table: pd.DataFrame, *, title: str, columns: Mapping[str, str] | None = None) -> bytes:
    """PNG of a table of `tradeoff`: a line per design, a panel per column, what differs from the first as a bar.

    Parameters
    ----------
    table : DataFrame
    title : str
    columns : mapping of str to str, optional
        Columns with the titles of their panels, "(log)" at the end for a logarithmic axis.
    """
    chosen = {name: said for name, said in (columns or _COLUMNS).items() if name in table.columns}
    return tradeoff_png(table, chosen, title=title)


def reconstruction_picture(source: str | Path, case: str, detector: str) -> bytes:
    """PNG of one flight of the yaw-rate benchmark as Figs 4 and 5 of its paper show it.

    Parameters
    ----------
    source : str or Path
        A campaign, its file or name, or a folder of results.
    case : str
        Name of the flight, ``figure_4/0/0/0``.
    detector : str
        A `sliding_mode` design with ``record_observer: true``.

    Raises
    ------
    FddbenchError
        There is no such flight, or this detector does not show its inside.
    """
    recording = signals(source, case.partition("/")[0], [case])
    shown = recording.detectors.get(detector, {})
    if "output_error" not in shown:
        raise FddbenchError(
            f"{detector!r} shows no inside of an observer; name a sliding_mode design with record_observer: true. Those of "
            f"this campaign: {', '.join(n for n, s in recording.detectors.items() if 'output_error' in s) or 'none'}"
        )
    return reconstruction_png(recording, detector, 0, title=f"{case}: {detector}")
