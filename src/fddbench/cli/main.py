"""Commands of fddbench.

Exit codes: 0 done, 1 done but some cases failed, 2 a mistake in what the user wrote, 74 a disk that is full or fails, 130
interrupted, 143 ended from outside.
"""

import argparse
import errno
import os
import signal
import sys
import threading
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import TextIOWrapper
from pathlib import Path
from types import FrameType
from typing import Any

from fddbench.cli.arguments import parser
from fddbench.errors import FddbenchError, ResultsWarning

__all__ = ["entry", "main", "parser"]

_INTERRUPTED, _TERMINATED, _DISK = 130, 143, 74
_PATIENCE_S = 10.0
"""How long what is finished may be counted before a second Ctrl-C ends that too."""
_PERMISSION = "change its permissions, or name another file or folder"
_DISK_ERRORS = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EROFS}


def main(argv: list[str] | None = None) -> int:
    """Run one command and return its exit code."""
    top = parser()
    args = top.parse_args(argv)
    if "command" not in args:
        top.print_help()
        return 0
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # a file's name may hold what a terminal cannot print
    ended: list[int] = []
    try:
        with warnings.catch_warnings(), _signals(ended):
            _say_in_words()
            if getattr(args, "trust", False):
                _trust(args)
            code: int = args.command(args)
        sys.stdout.flush()
        return _TERMINATED if ended and code == _INTERRUPTED else code
    except FddbenchError as error:
        print(f"fddbench: {error}", file=sys.stderr)
        return 2
    except BrokenPipeError:
        # the reader of a pipe (head, less) has gone: that is no mistake; keep Python from flushing once more
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        disk = error.errno in _DISK_ERRORS
        other = _PERMISSION if isinstance(error, PermissionError) else "name another file or folder"
        cure = "what is finished is kept, run again" if disk else other
        print(f"fddbench: {place}{error.strerror or error}; {cure}", file=sys.stderr)
        return _DISK if disk else 2
    except KeyboardInterrupt:
        print(f"fddbench: {'ended from outside' if ended else 'interrupted'}", file=sys.stderr)
        return _TERMINATED if ended else _INTERRUPTED


@contextmanager
def _signals(ended: list[int]) -> Iterator[None]:
    """End once at Ctrl-C or SIGTERM, what is finished saved and counted; `ended` then has the number of a SIGTERM.

    A second one does not disturb the counting, unless that lasts for long.
    """
    first: list[float] = []

    def interrupt(number: int, frame: FrameType | None) -> None:
        if number == signal.SIGTERM:
            ended.append(number)
        if not first or time.monotonic() - first[0] > _PATIENCE_S:
            first.append(time.monotonic())
            signal.default_int_handler(number, frame)  # not by a statement: that would be a detector's own

    before = {}
    for number in (signal.SIGTERM, signal.SIGINT):
        if number == signal.SIGINT and signal.getsignal(number) is not signal.default_int_handler:
            continue  # ignored, as of a job in the background, or somebody else's
        with suppress(ValueError):  # not the main thread
            before[number] = signal.signal(number, interrupt)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _trust(args: argparse.Namespace) -> None:
    """Let the plug-ins of the folders of a command run."""
    from fddbench.api.pages import newest
    from fddbench.api.trusting import trust

    named = args.source if "source" in args else args.folders if "folders" in args else args.folder
    for folder in [named] if isinstance(named, Path) else named or [newest()]:
        trust(folder)


def _say_in_words() -> None:
    """Print what must be known of a folder of results as a line, not as a warning with a place in the code."""
    as_usual = warnings.showwarning

    def show(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
        if issubclass(category, ResultsWarning):
            print(f"fddbench: {message}", file=sys.stderr)
        else:
            as_usual(message, category, *place, **more)

    warnings.simplefilter("always", ResultsWarning)
    warnings.showwarning = show


def entry() -> None:
    """Entry point of the installed command."""
    if "_ARGCOMPLETE" in os.environ:  # a shell asks for what may come next
        from fddbench.cli.completing import answer

        answer(parser())
    # what is freed goes back to the system: a tenth less memory for tables of many rows
    os.environ.setdefault("ARROW_DEFAULT_MEMORY_POOL", "system")
    code = main()
    if code in (_INTERRUPTED, _TERMINATED):
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # all is said
    if code and any(thread.daemon for thread in threading.enumerate()):
        # threads that still fly would meet an interpreter that is taken down, and abort the process instead of this code
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    sys.exit(code)
