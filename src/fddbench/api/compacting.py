"""The shards of a folder of results joined: few large files instead of many small ones."""

from pathlib import Path

from fddbench.results import compacting
from fddbench.results.compacting import Compacted
from fddbench.results.folder import provenance_of
from fddbench.results.lock import locked

__all__ = ["compact"]


def compact(folder: str | Path) -> Compacted:
    """Join the small shards of a folder of results, and remove tables that its list does not name.

    Rows keep their bits and `fddbench.load` its table. A run that ends joins by itself what it flew, from 100,000 rows on; this
    does it for any folder. A crash at any moment loses nothing.

    Parameters
    ----------
    folder : str or Path
        Folder of results that nobody is writing.

    Returns
    -------
    Compacted
        Shards before and after, and rows.

    Raises
    ------
    ResultsError
        No folder of results, a damaged one, or one that is being written.
    """
    path = Path(folder)
    provenance_of(path)
    with locked(path):
        found = compacting.compact(path)
        compacting.remove_unlisted(path)
    return found
