"""Where an operation was written: the line of the user's code and the blocks that were stepping."""

import sys
from pathlib import Path
from types import FrameType
from typing import NamedTuple

import numpy as np

__all__ = ["Locator", "Origin", "outside"]

_FOLDERS = (str(Path(__file__).parent), str(Path(np.__file__).parent), "<")


class Origin(NamedTuple):
    """Where an operation comes from; no part of what is computed.

    Attributes
    ----------
    block : str
        Classes whose ``step`` was running, from the outside in, as ``Fused.LateralLoop.Observer``; "" outside any.
    line : str
        ``file:line`` of the innermost line that is neither this package's floor nor NumPy.
    """

    block: str
    line: str


class _Ours(dict[str, bool]):
    """Whether a file is one of `fddbench.blocks` or NumPy's; asked for every node, so a look into a dictionary."""

    def __missing__(self, filename: str) -> bool:
        self[filename] = ours = filename.startswith(_FOLDERS)
        return ours


_OURS = _Ours()


def outside(frame: FrameType) -> FrameType:
    """The frame itself or the nearest caller that is neither one of `fddbench.blocks` nor NumPy's."""
    while _OURS[frame.f_code.co_filename] and frame.f_back is not None:
        frame = frame.f_back
    return frame


class Locator:
    """Finds the origin of what is being written down; call `forget` when done, because it holds a frame."""

    def __init__(self) -> None:
        self._frame: FrameType | None = None
        self._line = 0
        self._block = ""
        self._origin = Origin("", "")

    def __call__(self) -> Origin:
        """Origin of the operation that the caller's caller writes down."""
        frame = outside(sys._getframe(2))
        if frame is not self._frame or frame.f_lineno != self._line:
            if frame is not self._frame:  # many lines of one call share the way out
                self._block = _block(frame)
            self._frame, self._line = frame, frame.f_lineno
            self._origin = Origin(self._block, f"{frame.f_code.co_filename}:{self._line}")
        return self._origin

    def forget(self) -> None:
        """Let go of the frame."""
        self._frame = None


def _block(frame: FrameType | None) -> str:
    """Classes of ``self`` of all functions called ``step`` on the way out, outermost first."""
    owners: list[object] = []
    while frame is not None:
        if frame.f_code.co_name == "step" and "self" in frame.f_code.co_varnames[:1]:
            owner = frame.f_locals.get("self")
            if not owners or owner is not owners[-1]:  # a step that calls its base class's is one
                owners.append(owner)
        frame = frame.f_back
    return ".".join(type(owner).__name__ for owner in reversed(owners))
