"""Commands of fddbench. Exit codes: 0 done, 1 done but some cases failed, 2 a mistake in what the user wrote."""

import os
import sys
import warnings
from io import TextIOWrapper
from pathlib import Path
from typing import Any

from fddbench.cli.arguments import parser
from fddbench.errors import FddbenchError, ResultsWarning

__all__ = ["entry", "main", "parser"]


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
    try:
        with warnings.catch_warnings():
            _say_in_words()
            if getattr(args, "trust", False):
                _trust(args.source if "source" in args else args.folder)
            code: int = args.command(args)
        sys.stdout.flush()
        return code
    except FddbenchError as error:
        print(f"fddbench: {error}", file=sys.stderr)
        return 2
    except BrokenPipeError:
        # the reader of a pipe (head, less) has gone: that is no mistake; keep Python from flushing once more
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        print(f"fddbench: {place}{error.strerror or error}; what is finished is kept, run again", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("fddbench: interrupted", file=sys.stderr)
        return 130


def _trust(folder: Path) -> None:
    from fddbench.api.trusting import trust

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
    sys.exit(main())
