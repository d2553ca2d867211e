"""Code in folders of results that came from elsewhere."""

from pathlib import Path

from fddbench.results.folder import provenance_of
from fddbench.results.trust import code_digest, remember

__all__ = ["trust"]


def trust(folder: str | Path) -> None:
    """Let the plug-ins of a folder of results run here from now on, as those that were flown from here do.

    They run with your rights: read them first. What is trusted is the code, wherever it lies; changed code is not.

    Parameters
    ----------
    folder : str or Path
        Folder of results.

    Raises
    ------
    ResultsError
        No folder of results.
    """
    remember(code_digest(provenance_of(Path(folder))["files"]))
