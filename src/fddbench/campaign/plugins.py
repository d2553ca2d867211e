"""Detectors in a Python file beside their design: ``plugin.py:ClassName``."""

import importlib.util
import re
import sys
import traceback
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fddbench.campaign.canonical import text_sha256
from fddbench.errors import FddbenchError, reason_of

__all__ = ["Plugin", "is_plugin", "load_plugin"]

_PATTERN = re.compile(r"([A-Za-z_][A-Za-z0-9_]*\.py):([A-Za-z_][A-Za-z0-9_]*)")


@dataclass(frozen=True, kw_only=True)
class Plugin:
    """A Python file that brings a detector.

    Attributes
    ----------
    file : str
        Its name, beside the design.
    text, sha256 : str
        What stood in it, and the fingerprint of that.
    """

    file: str
    text: str = field(repr=False)
    sha256: str


def is_plugin(kind: str) -> bool:
    """Whether a kind names a file rather than a registered detector."""
    return ".py" in kind or ":" in kind


def load_plugin(kind: str, folder: Path) -> tuple[Any, Plugin]:
    """Class of a plug-in, and the file it came from.

    Raises
    ------
    FddbenchError
        The file is missing, does not run, lies elsewhere or has no such class; the message has one line.
    """
    match = _PATTERN.fullmatch(kind)
    if not match:
        raise FddbenchError(f"{kind!r} is no plug-in; write FILE.py:ClassName for a file beside the design")
    path = folder / match[1]
    if not path.is_file() or not path.resolve().is_relative_to(folder.resolve()):
        raise FddbenchError(f"no file {match[1]} in {folder}; a plug-in lies beside its design")
    text = path.read_bytes().decode("utf-8", "replace")
    plugin = Plugin(file=match[1], text=text, sha256=text_sha256(text))
    module = _module(path, plugin)
    if not isinstance(getattr(module, match[2], None), type):
        classes = [name for name, value in vars(module).items() if isinstance(value, type)]
        raise FddbenchError(f"{path} has no class {match[2]!r}. It has: {', '.join(classes) or 'none'}")
    return getattr(module, match[2]), plugin


def _module(path: Path, plugin: Plugin) -> Any:
    # Named by content: two plug-ins of the same file name do not meet, and a second reading is the same class.
    name = f"fddbench_plugin_{path.stem}_{plugin.sha256[:16]}"
    if name in sys.modules:
        return sys.modules[name]
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        del sys.modules[name]
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)]
        place = f"{path}:{lines[-1]}" if lines else str(path)
        raise FddbenchError(f"{place} does not run: {reason_of(error)}") from error
    return module
