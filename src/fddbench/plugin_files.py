"""Kinds in a Python file of one's own, with the files beside it that it needs.

A file may import modules that lie beside it and read data that lie beside it. Both are noticed while it is imported; what it
reads later it must declare, as ``FILES = ("weights.npy",)`` in the file. All of them travel into the folder of results, so
that replay and report read the same.
"""

import importlib.abc
import importlib.util
import re
import sys
import traceback
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass, field
from hashlib import sha256
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path
from threading import RLock
from types import ModuleType
from typing import Any

from fddbench.errors import FddbenchError, reason_of

__all__ = ["LoadedClass", "code_in", "is_file_kind", "load_class", "none_run", "noticed_reads"]

_PATTERN = re.compile(r"([A-Za-z_][A-Za-z0-9_]*\.py):([A-Za-z_][A-Za-z0-9_]*)")
_LARGEST = 200_000_000
"""Bytes of a file beside a plug-in that is carried along."""


@dataclass(frozen=True)
class LoadedClass:
    """Something in a file, and the files it stands on, by their names in that folder."""

    member: Any
    files: Mapping[str, bytes] = field(repr=False)


@dataclass(frozen=True)
class _Loaded:
    """A module, and the files beside it that it stands on."""

    module: ModuleType
    others: Mapping[str, bytes]


_loaded: dict[tuple[str, str], list[_Loaded]] = {}
"""By the sha256 of the file and its place: each set of siblings it has been loaded with."""
_lock = RLock()
_refused: ContextVar[list[str] | None] = ContextVar("_refused", default=None)


def is_file_kind(name: str) -> bool:
    """Whether a kind names a file rather than a registered member."""
    return ".py" in name or ":" in name


@contextmanager
def none_run() -> Iterator[list[str]]:
    """Run no file of anybody's meanwhile; gives the names of those that were asked for."""
    asked: list[str] = []
    token = _refused.set(asked)
    try:
        yield asked
    finally:
        _refused.reset(token)


def load_class(name: str, folder: Path) -> LoadedClass:
    """What ``FILE.py:Name`` names in a folder.

    Raises
    ------
    FddbenchError
        The file is missing, does not run, lies elsewhere or has no such name; the message has one line.
    """
    match = _PATTERN.fullmatch(name)
    if not match:
        raise FddbenchError(f"{name!r} is no plug-in; write FILE.py:ClassName for a file beside this one")
    refused = _refused.get()
    if refused is not None:
        refused.append(match[1])
        raise FddbenchError(f"{match[1]} is not run")
    path = folder / match[1]
    if not path.is_file() or not path.resolve().is_relative_to(folder.resolve()):
        raise FddbenchError(f"no file {match[1]} in {folder}; a plug-in lies beside the file that names it")
    text = path.read_bytes()
    with _lock:
        loaded = _load(path, text)
    if match[2] not in vars(loaded.module):
        names = [each for each, value in vars(loaded.module).items() if _defined_in(value, loaded.module)]
        raise FddbenchError(f"{path} has no {match[2]!r}. It has: {', '.join(names) or 'none'}")
    return LoadedClass(getattr(loaded.module, match[2]), {path.name: text, **loaded.others})


_INCLUDES = re.compile(r"""\s*#\s*include\s*(?:"([^"]*)"|<(?=/|[^>]*\.\.)([^>]*)>)""")
"""Line of C that includes a file by quotes, or one of nobody's library."""


def code_in(name: str, folder: Path) -> dict[str, bytes]:
    """Headers and sources of C in a folder beside a design, by their names from there; self-tests and vectors left out.

    Raises
    ------
    FddbenchError
        It is not beside the design, holds no source, or includes what does not travel with it.
    """
    plain = name.rstrip("/")
    if not plain or plain != Path(plain).as_posix() or Path(plain).is_absolute() or ".." in Path(plain).parts:
        raise FddbenchError(f"{name!r} is no name of a folder beside the design; write it from there, such as supplier")
    refused = _refused.get()
    if refused is not None:
        refused.append(name)
        raise FddbenchError(f"{name} is not run")
    where = folder / name
    if (
        not where.is_dir()
        or not where.resolve().is_relative_to(folder.resolve())
        or where.resolve() == folder.resolve()
    ):
        raise FddbenchError(f"no folder {name!r} in {folder}; code lies in a folder beside the design that names it")
    files = sorted(path for path in where.iterdir() if path.suffix in {".c", ".h"} and path.is_file())
    kept = [path for path in files if not path.stem.endswith(("_selftest", "_vectors"))]
    if not any(path.suffix == ".c" for path in kept):
        raise FddbenchError(
            f"{where} holds no .c file; it needs the source, and the header that fddbench export writes"
        )
    found = {path.name: path.read_bytes() for path in kept}
    for file, text in found.items():
        for number, line in enumerate(text.decode("utf-8", "replace").splitlines(), 1):
            beside = _INCLUDES.match(line)
            if beside and beside[1] not in found:
                raise FddbenchError(
                    f"{where / file}:{number} includes {beside[1] or beside[2]!r}, which is no file of this folder and "
                    "would not travel with the results; put it there and write its bare name"
                )
    return {f"{plain}/{file}": text for file, text in found.items()}


def _defined_in(value: Any, module: ModuleType) -> bool:
    return isinstance(value, type) and value.__module__ == module.__name__


def _load(path: Path, text: bytes) -> _Loaded:
    digest = sha256(text).hexdigest()
    place = (digest, str(path.absolute()))  # a copy elsewhere reads what lies there
    for known in _loaded.get(place, ()):  # a second reading is the same class, if its siblings are the same
        if all(_read(path.parent, name) == content for name, content in known.others.items()):
            return known
    siblings = _Siblings(path.parent)
    with siblings, noticed_reads(path.parent) as read:
        # named by content, so that two plug-ins of one file name do not meet
        module = _executed(path, f"fddbench_plugin_{path.stem}_{digest[:16]}_{sum(map(len, _loaded.values()))}")
    names = [*siblings.found, *read, *_declared(module, path)]
    others = {name: _read(path.parent, name) or b"" for name in dict.fromkeys(names) if name != path.name}
    loaded = _Loaded(module, others)
    _loaded.setdefault(place, []).append(loaded)
    return loaded


def _executed(path: Path, name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except BaseException as error:
        del sys.modules[name]
        if isinstance(error, KeyboardInterrupt):
            raise
        lines = [
            frame.lineno
            for frame in traceback.extract_tb(error.__traceback__)
            if Path(frame.filename) == path.absolute()
        ]
        place = f"{path}:{lines[-1]}" if lines else str(path)
        raise FddbenchError(f"{place} does not run: {reason_of(error)}") from error
    return module


def _declared(module: ModuleType, path: Path) -> Sequence[str]:
    """Files that a plug-in says it needs."""
    names = getattr(module, "FILES", ())
    if not isinstance(names, tuple | list) or not all(isinstance(name, str) for name in names):
        raise FddbenchError(f"{path}: FILES is a tuple of file names beside it, got {names!r:.80}")
    for name in names:
        inside = (path.parent / name).resolve().is_relative_to(path.parent.resolve())
        if not inside or not (path.parent / name).is_file():
            raise FddbenchError(f"{path} declares the file {name!r}, which is not in {path.parent}; put it there")
    return list(names)


def _read(folder: Path, name: str) -> bytes | None:
    """Content of a file beside a plug-in, None where there is none."""
    try:
        if (folder / name).stat().st_size > _LARGEST:
            raise FddbenchError(
                f"{folder / name} is larger than {_LARGEST / 1e6:g} MB; it cannot travel with the results"
            )
        return (folder / name).read_bytes()
    except OSError:
        return None


class _Siblings(importlib.abc.MetaPathFinder):
    """Finds modules beside a plug-in while it is imported, unless one of that name is installed."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.found, self.modules = folder, list[str](), list[str]()

    def find_spec(self, name: str, path: Any, target: Any = None) -> ModuleSpec | None:
        """Spec of a sibling."""
        del target
        file = self.folder / f"{name}.py"
        if path is not None or not file.is_file() or name in sys.stdlib_module_names:
            return None
        # a notebook has the folder it works in on its path: what is found there is a sibling too, and must travel
        installed = PathFinder.find_spec(name)
        if installed is not None and (installed.origin is None or Path(installed.origin).resolve() != file.resolve()):
            return None
        self.found.append(file.name)
        self.modules.append(name)
        return importlib.util.spec_from_file_location(name, file)

    def __enter__(self) -> "_Siblings":
        sys.meta_path.insert(0, self)
        return self

    def __exit__(self, *_: object) -> None:
        sys.meta_path.remove(self)
        for name in self.modules:  # another plug-in may have another module of this name
            sys.modules.pop(name, None)


_recorders: list[tuple[Path, list[str]]] = []
_hooked = False


@contextmanager
def noticed_reads(folder: Path) -> Iterator[list[str]]:
    """Names of the files of a folder that are opened meanwhile, other than Python modules."""
    global _hooked
    if not _hooked:
        sys.addaudithook(_notice)
        _hooked = True
    found: list[str] = []
    _recorders.append((folder.resolve(), found))
    try:
        yield found
    finally:
        _recorders.pop()


def _notice(event: str, arguments: tuple[Any, ...]) -> None:
    if event != "open" or not _recorders or not isinstance(arguments[0], str):
        return
    folder, found = _recorders[-1]
    with suppress(OSError, ValueError, RuntimeError):  # an odd name is for `open` to refuse
        path = Path(arguments[0])
        path = path.parent.resolve() / path.name  # a link counts where it lies
        ours = path.suffix in {".py", ".pyc"} or "__pycache__" in path.parts
        if not ours and path.is_relative_to(folder) and path.is_file():
            found.append(str(path.relative_to(folder)))
