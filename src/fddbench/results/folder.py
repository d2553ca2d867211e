"""A folder of results: opened for one campaign, refused to any other."""

import json
import os
import re
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from difflib import unified_diff
from pathlib import Path

from fddbench.errors import ResultsError
from fddbench.results.shards import write_bytes

__all__ = ["RESERVED", "claim", "locked", "provenance_of", "refuse_foreign"]

_PROVENANCE = "provenance.json"
_WRITTEN = ("campaign.yaml", "detectors", "manifest.jsonl", _PROVENANCE, "rows", "events", "report.html")
_OURS = (*_WRITTEN, ".lock", ".pid")
RESERVED = frozenset(_OURS) - {"detectors"}
"""Names in a folder of results that no file beside a campaign can have when it travels there."""
_LEFT = re.compile(r"\..+\.[0-9]+\.tmp")
"""What a crash in the middle of a write leaves behind."""
_PLUGIN = re.compile(r"[A-Za-z_][A-Za-z0-9_-]*(\.[A-Za-z0-9_-]+)*")
"""Part of the name of a file of a plug-in beside a campaign; never a way out of the folder."""


def claim(folder: Path, *, files: Mapping[str, bytes], provenance: Mapping[str, object], fresh: bool) -> bool:
    """Make a folder this campaign's; True when it already was and the work continues.

    Parameters
    ----------
    folder : Path
        Where the results go; made when missing.
    files : mapping of str to bytes
        Frozen campaign, designs and what they stand on, by their names in the folder.
    provenance : mapping
        Written once, at the beginning; its ``campaign_sha256`` decides whose folder it is.
    fresh : bool
        Throw away what an earlier run left.

    Raises
    ------
    ResultsError
        The folder holds another campaign's results (the difference is shown) or files that are not fddbench's.
    """
    if folder.is_dir() and (folder / _PROVENANCE).is_file() and not fresh:
        if _campaign_of(folder) != provenance["campaign_sha256"]:
            raise ResultsError(_difference(folder, files))
        _put_back(folder, files)
        return True
    refuse_foreign(folder)
    _clear(folder)
    _put_back(folder, files)
    write_bytes(folder / _PROVENANCE, json.dumps(provenance, indent=2).encode())
    return False


def refuse_foreign(folder: Path) -> None:
    """Do nothing to a folder that is missing, empty or of results.

    Raises
    ------
    ResultsError
        It is a file, or holds files that fddbench did not write.
    """
    if folder.is_dir():
        names = sorted(path.name for path in folder.iterdir())
        ours = {*_OURS, *(name.parts[0] for name in _carried(folder))}
        foreign = [name for name in names if name not in ours and not _LEFT.fullmatch(name)]
        if foreign:
            more = ", ..." if len(foreign) > 3 else ""
            raise ResultsError(
                f"{folder} is no folder of results: it holds {', '.join(foreign[:3])}{more}; name another with --out"
            )
    elif folder.exists():
        raise ResultsError(f"{folder} is a file, no folder of results; name another with --out")


def _carried(folder: Path) -> list[Path]:
    """Names in the folder of what the campaign's own kinds came from, as its provenance lists them."""
    try:
        listed = provenance_of(folder).get("files")
    except ResultsError:
        return []
    names = [Path(name) for name in listed] if isinstance(listed, dict) else []
    return [name for name in names if name.parts and all(_PLUGIN.fullmatch(part) for part in name.parts)]


def _put_back(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write the frozen files that are missing or not as they were."""
    for name, content in files.items():
        path = folder / name
        if not path.is_file() or path.read_bytes() != content:
            write_bytes(path, content)


def _campaign_of(folder: Path) -> object:
    """Fingerprint of the campaign a folder belongs to; None when it cannot be read."""
    try:
        return provenance_of(folder)["campaign_sha256"]
    except ResultsError:
        return None


def provenance_of(folder: Path) -> dict[str, object]:
    """What is known of how the results came to be.

    Raises
    ------
    ResultsError
        The folder is missing or is not one of results.
    """
    path = folder / _PROVENANCE
    if not path.is_file():
        raise ResultsError(
            f"{folder} is no folder of results: it has no provenance.json; name one that `fddbench run` wrote"
        )
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ResultsError(f"{path} cannot be read ({error}); run the campaign again with --fresh") from error
    if not isinstance(found, dict) or not {"campaign_sha256", "designs_sha256"} <= found.keys():
        raise ResultsError(f"{path} is no provenance of fddbench; run the campaign again with --fresh")
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

    refuse_foreign(folder)
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
    """Remove what fddbench writes, and nothing else; a link is removed, not what it points to."""
    for carried in _carried(folder):
        (folder / carried).unlink(missing_ok=True)
        for parent in carried.parents[:-1]:  # folders that are empty now
            with suppress(OSError):
                (folder / parent).rmdir()
    for name in _WRITTEN:
        path = folder / name
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)


def _difference(folder: Path, files: Mapping[str, bytes]) -> str:
    """What differs between the folder's campaign and this one, as a short diff."""
    lines: list[str] = []
    for name, content in sorted(files.items(), key=lambda item: item[0] != "campaign.yaml"):
        before = (folder / name).read_bytes() if (folder / name).is_file() else b""
        if before != content:
            lines = [f"{name}: other bytes"] if b"\0" in content + before else _lines(before, content)
        if lines:
            break
    shown = "\n".join(f"  {line}" for line in lines[:12]) or "  (another version of a design or plug-in)"
    return (
        f"{folder} holds results of another campaign:\n{shown}\n"
        "Name another folder with --out, or replace the results with --fresh."
    )


def _lines(before: bytes, after: bytes) -> list[str]:
    """What differs between two texts, without their places."""
    there, here = (content.decode("utf-8", "replace").splitlines() for content in (before, after))
    return [line for line in unified_diff(there, here, "there", "here", n=0, lineterm="") if line[:3] != "@@ "]
