"""Whose plug-ins are run: code that lies in a folder of results runs only where this user flew it, or said so.

What a campaign runs when it is flown, its user chose. A folder of results that came from elsewhere brings code along; to look
at its page must not run that. So each set of plug-in files that was flown from here leaves its hash in the user's private
folder (`fddbench.private`), and code in a folder of results is run where its hash is there. It is the code that is known, not
the folder: one's own results may be moved and copied.
"""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from hashlib import sha256
from pathlib import Path

from fddbench import private

__all__ = ["code_digest", "is_known", "remember", "unlisted"]

_DATA = (".yaml", ".yml")
_known: set[str] = set()
"""Remembered in this process, where the disk keeps nothing."""


def code_digest(files: Mapping[str, str]) -> str:
    """Identity of the plug-ins among frozen files, given by name and sha256, with the data they read; "" without a plug-in.

    >>> code_digest({"campaign.yaml": "ab", "detectors/own.yaml": "cd"})
    ''
    """
    if not any(name.endswith((".py", ".c")) for name in files):
        return ""
    carried = sorted(f"{name} {digest}" for name, digest in files.items() if not name.endswith(_DATA))
    return sha256("\n".join(carried).encode()).hexdigest()


def unlisted(folder: Path, files: Mapping[str, str]) -> list[str]:
    """Code that lies where plug-ins of a folder of results would find it and is not among its frozen files."""
    return sorted(name for name in _code(folder) if name not in files)


def _code(folder: Path) -> Iterator[str]:
    """Modules that a plug-in would import, and all C: a folder of it beside a design is flown whole."""
    for below in (folder, folder / "detectors"):
        with suppress(OSError):
            yield from (
                path.relative_to(folder).as_posix() for path in below.iterdir() if path.suffix in {".py", ".so"}
            )
    yield from (path.relative_to(folder).as_posix() for path in folder.rglob("*.[ch]"))


def remember(digest: str) -> None:
    """Run this code from now on wherever it lies; where nothing can be kept, as long as this process lasts."""
    if not digest:
        return
    _known.add(digest)
    with suppress(OSError):
        (private.made(private.made(private.folder()) / "flown") / digest).touch(mode=0o600)


def is_known(digest: str) -> bool:
    """Whether this user flew this code from here, or said that it may run."""
    if digest in _known:
        return True
    try:
        return private.read(private.folder() / "flown" / digest) is not None
    except OSError:
        return False
