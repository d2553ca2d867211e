"""Where in its author's file a detector went wrong."""

from pathlib import Path
from traceback import walk_tb
from types import SimpleNamespace
from typing import Any

from fddbench.errors import DesignError, EndedError, did_you_mean, one_line, reason_of
from fddbench.interfaces import Bus

__all__ = ["missing_signal", "place_in", "reason_at", "same_line"]

_LONGEST = 200
"""Characters of a reason in a row."""


def place_in(error: BaseException, detector: Any, method: str) -> str:
    """Line of the author's code that raised, in brackets; where nothing raised, that of the method itself."""
    code = getattr(getattr(detector, method, None), "__code__", None)
    if code is None:
        return ""
    file, line = (_lines(error, code.co_filename) or [(code.co_filename, code.co_firstlineno)])[-1]
    return f" ({file}:{line})"


def reason_at(error: BaseException, detector: Any) -> str:
    """What a step raised and in which line of its file, in at most 200 characters; the same in whichever folder it lies."""
    ended = isinstance(error, EndedError)  # its line is ours
    lines = [] if ended else _own_lines(error, detector)
    place = f" ({Path(lines[-1][0]).name}:{lines[-1][1]})" if lines else ""
    said = one_line(str(error)) if ended or isinstance(error, DesignError) else reason_of(error)
    if len(said) + len(place) > _LONGEST:
        said = said[: _LONGEST - len(place) - 3] + "..."
    return said + place


def same_line(error: BaseException, detector: Any) -> tuple[str, str]:
    """What two errors share that are the same error at the same line, whatever numbers their texts show."""
    if isinstance(error, EndedError):
        return error.status, error.message
    lines = _own_lines(error, detector)
    return type(error).__name__, f"{lines[-1][0]}:{lines[-1][1]}" if lines else reason_of(error)


def missing_signal(error: BaseException, bus: Bus) -> str:
    """Which signals there are, when a step asked for one that is not measured."""
    asked = error.obj if isinstance(error, AttributeError) else None
    if not isinstance(asked, SimpleNamespace) or vars(asked).keys() != bus.signals.keys():
        return ""
    assert isinstance(error, AttributeError)
    close = did_you_mean(str(error.name), bus.signals)
    return f". Measured are {', '.join(bus.signals)}{'. ' + close if close else ''}"


def _own_lines(error: BaseException, detector: Any) -> list[tuple[str, int]]:
    """Lines of a detector's author that an exception passed; none where its step is no Python function."""
    code = getattr(getattr(detector, "step", None), "__code__", None)
    return [] if code is None else _lines(error, code.co_filename)


def _lines(error: BaseException, beside: str) -> list[tuple[str, int]]:
    """Files in the folder of this one that an exception passed, and in which line, outermost first."""
    folder = Path(beside).resolve().parent
    passed = [(frame.f_code.co_filename, line) for frame, line in walk_tb(error.__traceback__)]
    return [(file, line) for file, line in passed if Path(file).resolve().parent == folder]
