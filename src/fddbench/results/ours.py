"""What in a folder fddbench wrote: everything else is somebody's, and is neither written over nor deleted."""

import os
import re
import shutil
from collections.abc import Collection, Iterator
from pathlib import Path, PurePosixPath

from fddbench.errors import ResultsError
from fddbench.results.manifest import SHARD_FILE, survey

__all__ = ["RESERVED", "TABLES", "clear", "refuse_foreign", "sweep"]

_JUDGED = "requirements.junit.xml"
_FIXED = (
    *("campaign.yaml", "manifest.jsonl", "report.html", "summary.parquet", _JUDGED),
    *("provenance.json", ".lock", ".pid", ".token"),
)
TABLES = ("rows", "events", "tallies")
"""Folders of a folder of results that hold its shards."""
RESERVED = frozenset({*_FIXED, *TABLES})
"""Names in a folder of results that no file beside a campaign can have when it travels there."""
_LEFT = re.compile(r"(.*/)?(\.[^/]+\.[0-9]+\.tmp|__pycache__/[^/]+\.pyc)")
"""What a crash in the middle of a write leaves behind, and what Python leaves beside the plug-ins."""
_ASIDE = re.compile(r"\.[^/]+\.[0-9]+\.tmp")


def refuse_foreign(folder: Path, carried: Collection[str] | None, *, fresh: bool) -> None:
    """Do nothing to a folder that is missing, empty or of results.

    Parameters
    ----------
    folder : Path
        The folder.
    carried : collection of str or None
        Names of the frozen files, from its provenance; None when there is none that can be read.
    fresh : bool
        Whether everything in it is about to be replaced.

    Raises
    ------
    ResultsError
        It is a file, holds a link or files that fddbench did not write, or nobody knows of what its results are.
    """
    if not folder.is_dir():
        if folder.exists():
            raise ResultsError(f"{folder} is a file, no folder of results; name another with --out")
        return
    names = dict(_walk(folder))
    links = [name for name, is_link in names.items() if is_link]
    if links:
        raise ResultsError(
            f"{folder / links[0]} is a link; results are not written through links. Put the file or folder itself there, or "
            "name another folder with --out"
        )
    recognised = carried is None and _is_listed(folder)
    foreign = [name for name in names if not _is_ours(name, carried or (), anything_frozen=recognised)]
    unknown = carried is None and not _is_blank(folder, names) and not (fresh and recognised)
    if unknown and (not foreign or any(map(SHARD_FILE.fullmatch, names))):
        _refuse_unknown(folder, names, recognised=recognised)
    if foreign:
        more = ", ..." if len(foreign) > 3 else ""
        raise ResultsError(
            f"{folder} is no folder of results: it holds {', '.join(foreign[:3])}{more}; name another with --out"
        )


def _refuse_unknown(folder: Path, names: Collection[str], *, recognised: bool) -> None:
    """Refuse a folder without a provenance that can be read.

    Raises
    ------
    ResultsError
        Always.
    """
    n_shards = sum(bool(SHARD_FILE.fullmatch(name)) for name in names)
    what = f"{n_shards} shard{'' if n_shards == 1 else 's'}" if n_shards else f"{', '.join(sorted(names)[:3])}"
    path = folder / "provenance.json"
    how = "that is missing" if not path.exists() else "that cannot be read"
    anew = "fly everything anew with --fresh" if recognised else "remove the folder yourself"
    raise ResultsError(
        f"{folder} holds {what} and a provenance.json {how}, so nobody knows of which campaign they are. Nothing was "
        f"deleted: put the file back, name another folder with --out, or {anew}"
    )


def clear(folder: Path, carried: Collection[str]) -> None:
    """Remove what fddbench writes, the provenance last: a folder that is half cleared is still known as ours."""
    frozen = [name for name in carried if _may_be_frozen(name)]
    for name in (
        "manifest.jsonl",
        *TABLES,
        "detectors",
        *frozen,
        "campaign.yaml",
        "report.html",
        "summary.parquet",
        _JUDGED,
    ):
        path = folder / name
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)
    (folder / "provenance.json").unlink(missing_ok=True)


def sweep(folder: Path) -> None:
    """Remove the files that a killed run was writing aside; who holds the lock of a folder is its only writer."""
    for below in (folder, *(folder / name for name in (*TABLES, "detectors"))):
        if below.is_dir() and not below.is_symlink():
            for path in below.iterdir():
                if _ASIDE.fullmatch(path.name):
                    path.unlink(missing_ok=True)


def _walk(folder: Path) -> Iterator[tuple[str, bool]]:
    """Names of files and links in a folder and below it, and whether each is a link; links are not followed."""
    for base, folders, files in os.walk(folder):
        for name in sorted([*folders, *files]):
            path = Path(base, name)
            if path.is_symlink() or name in files:
                yield path.relative_to(folder).as_posix(), path.is_symlink()


def _is_ours(name: str, carried: Collection[str], *, anything_frozen: bool) -> bool:
    known = name in _FIXED or bool(SHARD_FILE.fullmatch(name)) or bool(_LEFT.fullmatch(name))
    return known or (name in carried and _may_be_frozen(name)) or (anything_frozen and name.startswith("detectors/"))


def _may_be_frozen(name: str) -> bool:
    """Whether a file of this name may be kept beside results: it stays in the folder, and is none of our own."""
    path = PurePosixPath(name)
    return path.parts[:1] != () and not path.is_absolute() and ".." not in path.parts and path.parts[0] not in RESERVED


def _is_listed(folder: Path) -> bool:
    """Whether a manifest of ours lies there, undamaged."""
    try:
        found = survey(folder)
    except ResultsError:
        return False
    return bool(found.shards) and not found.wrong


def _is_blank(folder: Path, names: Collection[str]) -> bool:
    """Whether nothing is in a folder but what the first moments of a run leave there."""
    manifest = folder / "manifest.jsonl"
    begun = {".lock", ".pid", ".token"} | (
        {"manifest.jsonl"} if manifest.is_file() and not manifest.stat().st_size else set()
    )
    return all(name in begun or _LEFT.fullmatch(name) for name in names)
