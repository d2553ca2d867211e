"""What was made of a kernel, on disk: it is merged and compiled once per machine and loaded in milliseconds afterwards.

The folder is the user's alone (`fddbench.private`): in one that others may write nothing is kept and nothing is read.
"""

import tempfile
from functools import cache
from hashlib import sha256
from pathlib import Path

from fddbench import private
from fddbench.errors import ResultsWarning, warn

__all__ = ["key", "load", "source", "store"]

_DIGEST = 32


def key(*parts: str) -> str:
    """Name of an entry: sha256 of everything that the machine code depends on."""
    return sha256("\0".join(parts).encode()).hexdigest()


@cache
def source() -> str:
    """Identity of the code that writes machine code: sha256 of this package's source."""
    files = sorted(Path(__file__).parent.rglob("*.py"))
    return sha256(b"\0".join(file.read_bytes() for file in files)).hexdigest()


def load(name: str) -> bytes | None:
    """Object stored under a name; None when there is none, when it is not what was stored or could be another user's."""
    try:
        where = private.folder()
        _warn_once(where, private.trouble(where))
        content = private.read(where / f"{name}.o")
    except OSError:
        return None
    if content is None:
        return None
    digest, body = content[:_DIGEST], content[_DIGEST:]
    return body if sha256(body).digest() == digest else None


@cache
def _warn_once(where: Path, trouble: str) -> None:
    if trouble:
        warn(
            f"machine code of flights is not kept: {where} {trouble}, and what lies there is run. Make it yours alone "
            f"(chmod 700 {where}) or name another folder in FDDBENCH_CACHE",
            ResultsWarning,
        )


def store(name: str, body: bytes) -> None:
    """Keep an object; a full or read-only disk is no reason to stop."""
    try:
        where = private.made(private.folder())
        with tempfile.NamedTemporaryFile(dir=where, delete=False) as file:
            aside = Path(file.name)
            file.write(sha256(body).digest() + body)
    except OSError:
        return
    try:
        aside.replace(aside.with_name(f"{name}.o"))
    except OSError:
        aside.unlink(missing_ok=True)
