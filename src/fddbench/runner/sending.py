"""Workers on other machines: they write where they see the folder of results, and send their shards where they do not.

Whether they see it is decided by a token: a file of random digits that the run leaves in the folder while it lasts.
"""

import atexit
import os
import secrets
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import lru_cache
from hashlib import sha256
from pathlib import Path

from fddbench.errors import FddbenchError, ResultsError
from fddbench.results.folder import provenance_of
from fddbench.results.manifest import Shard
from fddbench.results.shards import write_bytes
from fddbench.runner.chunks import Spans
from fddbench.runner.work import Work, fly_and_write

__all__ = ["Errand", "Sent", "Unseen", "carried_by", "errand", "fly_anywhere", "keep"]

_TOKEN = ".token"
Files = tuple[tuple[str, bytes], ...]


@dataclass(frozen=True, kw_only=True)
class Errand:
    """Work for a worker that may be anywhere.

    Attributes
    ----------
    work : Work
        What is flown.
    token : str
        What stands in the folder's token.
    files : tuple of (str, bytes)
        Frozen campaign, for who does not see the folder; empty until somebody asks.
    """

    work: Work
    token: str
    files: Files = ()


@dataclass(frozen=True)
class Unseen:
    """Answer of a worker that neither sees the folder nor has the campaign."""

    cases: Spans


@dataclass(frozen=True)
class Sent:
    """A shard from a worker that does not see the folder, with its files by name."""

    shard: Shard
    files: Files


@contextmanager
def errand(work: Work) -> Iterator[Errand]:
    """Errand for the time of a run."""
    path = Path(work.folder) / _TOKEN
    token = secrets.token_hex(16)
    write_bytes(path, token.encode())
    try:
        yield Errand(work=work, token=token)
    finally:
        path.unlink(missing_ok=True)


def carried_by(own: Errand) -> Errand:
    """The errand with the frozen campaign."""
    folder = Path(own.work.folder)
    names = ("provenance.json", "campaign.yaml", *provenance_of(folder)["files"])
    return replace(own, files=tuple((name, (folder / name).read_bytes()) for name in names))


def fly_anywhere(own: Errand, cases: Spans) -> Shard | Sent | Unseen | FddbenchError:
    """Fly cases on a worker; a mistake is an answer, so that it finds its way back from every engine."""
    try:
        if _sees(own):
            return fly_and_write(own.work, cases)
        if not own.files:
            return Unseen(cases)
        folder = _copy(own.token, own.files)
        shard = fly_and_write(replace(own.work, folder=str(folder)), cases)
        paths = [folder / name for name, _ in shard.files]
        sent = tuple((path.relative_to(folder).as_posix(), path.read_bytes()) for path in paths)
        for path in paths:
            path.unlink()
        return Sent(shard, sent)
    except FddbenchError as error:
        return FddbenchError(f"a worker ({os.uname().nodename if hasattr(os, 'uname') else 'elsewhere'}): {error}")


def keep(folder: Path, sent: Sent) -> Shard:
    """Write a shard that was sent into the folder of results.

    Raises
    ------
    ResultsError
        It is not what the worker wrote.
    """
    said = dict(sent.shard.files)
    for name, data in sent.files:
        if said.get(name) != sha256(data).hexdigest():
            raise ResultsError(f"{name} was damaged on its way from a worker; run the campaign again on {folder}")
        write_bytes(folder / name, data)
    return sent.shard


def _sees(own: Errand) -> bool:
    try:
        return (Path(own.work.folder) / _TOKEN).read_text(encoding="ascii") == own.token
    except (OSError, ValueError):
        return False


@lru_cache(maxsize=1)
def _copy(token: str, files: Files) -> Path:
    """Folder of this worker with the frozen campaign, for as long as it lives."""
    folder = Path(tempfile.mkdtemp(prefix=f"fddbench-{token[:8]}-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    for name, data in files:
        write_bytes(folder / name, data)
    return folder
