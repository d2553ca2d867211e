"""Where in its author's file a detector went wrong."""

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from fddbench.errors import DesignError, did_you_mean, reason_of
from fddbench.interfaces import Bus

__all__ = ["line_of", "missing_signal", "reason_at", "same_line"]

_LONGEST = 200
"""Characters of a reason in a row."""


def line_of(error: BaseException, detector: Any, method: str) -> str:
    """Line of the author's code that raised, in brackets; where nothing raised, that of the method itself."""
    code = getattr(getattr(detector, method, None), "__code__", None)
    if code is None:
        return ""
    frames = list(_own_lines(error, detector, method))
    file, line = frames[-1] if frames else (code.co_filename, code.co_firstlineno)
    return f" ({file}:{line})"


def reason_at(error: BaseException, detector: Any) -> str:
    """What a step raised and in which line of its file, in at most 200 characters; the same in whichever folder it lies."""
    frames = list(_own_lines(error, detector, "step"))
    place = f" ({Path(frames[-1][0]).name}:{frames[-1][1]})" if frames else ""
    said = " ".join(str(error).split()) if isinstance(error, DesignError) else reason_of(error)
    if len(said) + len(place) > _LONGEST:
        said = said[: _LONGEST - len(place) - 3] + "..."
    return said + place


def same_line(error: BaseException, detector: Any) -> tuple[str, str]:
    """What two errors share that are the same error at the same line, whatever numbers their texts show."""
    frames = list(_own_lines(error, detector, "step"))
    return type(error).__name__, f"{frames[-1][0]}:{frames[-1][1]}" if frames else reason_of(error)


def missing_signal(error: BaseException, bus: Bus) -> str:
    """Which signals there are, when a step asked for one that is not measured."""
    asked = error.obj if isinstance(error, AttributeError) else None
    if not isinstance(asked, SimpleNamespace) or vars(asked).keys() != bus.signals.keys():
        return ""
    assert isinstance(error, AttributeError)
    close = did_you_mean(str(error.name), bus.signals)
    return f". Measured are {', '.join(bus.signals)}{'. ' + close if close else ''}"


def _own_lines(error: BaseException, detector: Any, method: str) -> Iterator[tuple[str, int]]:
    """Files and lines of the author's code that an exception passed, outermost first."""
    code = getattr(getattr(detector, method, None), "__code__", None)
    step = error.__traceback__
    while step is not None:
        file = step.tb_frame.f_code.co_filename
        if code is not None and Path(file).is_relative_to(Path(code.co_filename).parent):
            yield file, step.tb_lineno
        step = step.tb_next
