"""A folder of results: opened for one campaign, refused to any other."""

import json
import os
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from difflib import unified_diff
from pathlib import Path

from fddbench.errors import ResultsError
from fddbench.results.shards import write_bytes

__all__ = ["claim", "locked", "provenance_of"]

_OURS = ("campaign.yaml", "detectors", "manifest.jsonl", "provenance.json", "rows", "events", "report.html")


def claim(folder: Path, *, files: Mapping[str, str], provenance: Mapping[str, object], fresh: bool) -> bool:
    """Make a folder this campaign's; True when it already was and the work continues.

    Parameters
    ----------
    folder : Path
        Where the results go; made when missing.
    files : mapping of str to str
        Frozen campaign and designs by their names in the folder.
    provenance : mapping
        Written once, at the beginning; its ``campaign_sha256`` decides whose folder it is.
    fresh : bool
        Throw away what an earlier run left.

    Raises
    ------
    ResultsError
        The folder holds another campaign's results (the difference is shown) or files that are not fddbench's.
    """
    if fresh:
        _clear(folder)
    if folder.is_dir() and (folder / "provenance.json").is_file():
        before = provenance_of(folder)
        if before.get("campaign_sha256") == provenance["campaign_sha256"]:
            return True
        raise ResultsError(_difference(folder, files))
    if folder.exists() and (
        not folder.is_dir() or any(p.name not in (*_OURS, ".lock", ".pid") for p in folder.iterdir())
    ):
        raise ResultsError(f"{folder} exists and is no folder of results; name another with --out")
    for name, text in files.items():
        write_bytes(folder / name, text.encode())
    write_bytes(folder / "provenance.json", json.dumps(provenance, indent=2).encode())
    return False


def provenance_of(folder: Path) -> dict[str, object]:
    """What is known of how the results came to be.

    Raises
    ------
    ResultsError
        The folder is missing or is not one of results.
    """
    path = folder / "provenance.json"
    if not path.is_file():
        raise ResultsError(
            f"{folder} is no folder of results: it has no provenance.json; name one that `fddbench run` wrote"
        )
    try:
        found: dict[str, object] = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ResultsError(f"{path} cannot be read ({error}); run the campaign again with --fresh") from error
    return found


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Keep other runs out of a folder; the lock dies with the process.

    Raises
    ------
    ResultsError
        Another process is writing; its pid is named.
    """
    from filelock import FileLock, Timeout

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ResultsError(f"cannot make the folder {folder}: {error.strerror}; name another with --out") from error
    lock = FileLock(folder / ".lock")
    try:
        lock.acquire(timeout=0)
    except Timeout as error:
        pid = (folder / ".pid").read_text() if (folder / ".pid").is_file() else "unknown"
        raise ResultsError(
            f"{folder} is being written by process {pid}; wait for it, or name another folder with --out"
        ) from error
    try:
        (folder / ".pid").write_text(str(os.getpid()))
        yield
    finally:
        lock.release()


def _clear(folder: Path) -> None:
    """Remove what fddbench writes, and nothing else."""
    if (folder / "provenance.json").is_file():
        for name in _OURS:
            path = folder / name
            if path.is_dir():
                shutil.rmtree(path)
            else:
                path.unlink(missing_ok=True)


def _difference(folder: Path, files: Mapping[str, str]) -> str:
    """What differs between the folder's campaign and this one, as a short diff."""
    lines: list[str] = []
    for name, text in sorted(files.items()):
        before = (folder / name).read_text(encoding="utf-8").splitlines() if (folder / name).is_file() else []
        lines += [
            line
            for line in unified_diff(before, text.splitlines(), "there", "here", n=0, lineterm="")
            if line[:3] != "@@ "
        ]
    shown = "\n".join(f"  {line}" for line in lines[:20]) or "  (another version of a design or plug-in)"
    return (
        f"{folder} holds results of another campaign:\n{shown}\n"
        "Name another folder with --out, or replace the results with --fresh."
    )
