"""What was made of a kernel, on disk: it is merged and compiled once per machine and loaded in milliseconds afterwards."""

import os
import tempfile
from functools import cache
from hashlib import sha256
from pathlib import Path

__all__ = ["folder", "key", "load", "source", "store"]

_DIGEST = 32


def folder() -> Path:
    """Where objects are kept: ``$FDDBENCH_CACHE``, else ``fddbench`` in the user's cache directory.

    Raises
    ------
    OSError
        The user has no home, as in many containers.
    """
    chosen = os.environ.get("FDDBENCH_CACHE")
    if chosen:
        return Path(chosen)
    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "fddbench"
    except RuntimeError as error:
        raise OSError(f"no cache without a home: {error}") from error


def key(*parts: str) -> str:
    """Name of an entry: sha256 of everything that the machine code depends on."""
    return sha256("\0".join(parts).encode()).hexdigest()


@cache
def source() -> str:
    """Identity of the code that writes machine code: sha256 of this package's source."""
    files = sorted(Path(__file__).parent.rglob("*.py"))
    return sha256(b"\0".join(file.read_bytes() for file in files)).hexdigest()


def load(name: str) -> bytes | None:
    """Object stored under a name; None when there is none, when it is not what was stored or where nothing can be kept."""
    try:
        content = (folder() / f"{name}.o").read_bytes()
    except OSError:
        return None
    digest, body = content[:_DIGEST], content[_DIGEST:]
    return body if sha256(body).digest() == digest else None


def store(name: str, body: bytes) -> None:
    """Keep an object; a full or read-only disk is no reason to stop."""
    try:
        folder().mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=folder(), delete=False) as file:
            aside = Path(file.name)
            file.write(sha256(body).digest() + body)
    except OSError:
        return
    try:
        aside.replace(aside.with_name(f"{name}.o"))
    except OSError:
        aside.unlink(missing_ok=True)
