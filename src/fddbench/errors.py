"""What can go wrong by the user's hand, told so that it can be mended.

Every message names the place, what was received, what is allowed and what to do. The classes are dataclasses without an
``__init__`` of their own, because only those survive the way back from a worker process.
"""

import dis
import signal
import sys
import sysconfig
import traceback
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

__all__ = [
    "CampaignError",
    "DesignError",
    "EndedError",
    "FddbenchError",
    "Mistake",
    "OtherProgramWarning",
    "PartialResultsWarning",
    "ResultsError",
    "ResultsWarning",
    "UnknownNameError",
    "UntrustedError",
    "by_statement",
    "did_you_mean",
    "one_line",
    "place_of",
    "raise_interrupt",
    "reason_of",
    "signal_name",
    "warn",
]

_LONGEST = 200
"""Characters of a foreign message that are kept."""


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Sentence that suggests the nearest known name, or the empty string.

    >>> did_you_mean("medain", ["median", "closest_two"])
    "Did you mean 'median'?"
    """
    close = get_close_matches(name, list(known), n=1)
    return f"Did you mean {close[0]!r}?" if close else ""


def one_line(text: str) -> str:
    r"""Foreign text in one line, without characters that a terminal obeys.

    >>> one_line("two\nlines \x1b[31mred")
    'two lines \\x1b[31mred'
    """
    words = " ".join(text.encode("utf-8", "backslashreplace").decode().split())
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in words)


def reason_of(error: BaseException) -> str:
    r"""What an exception of foreign code says: its kind and text in one line of at most 200 characters; never raises.

    >>> reason_of(ValueError("two\nlines"))
    'ValueError: two lines'
    """
    try:
        text = one_line(str(error))
    except BaseException as worse:  # a foreign text may raise anything as well
        raise_interrupt(worse)
        text = "(its text cannot be made)"
    whole = f"{type(error).__name__}: {text}" if text else type(error).__name__
    return whole if len(whole) <= _LONGEST else whole[: _LONGEST - 3] + "..."


def signal_name(number: int) -> str:
    """Name of a signal that ended a process; of one without a name its number.

    >>> signal_name(11), signal_name(40)
    ('SIGSEGV', 'signal 40')
    """
    try:
        return signal.Signals(number).name
    except ValueError:  # those of real time
        return f"signal {number}"


def place_of(error: BaseException) -> str:
    """Innermost line of foreign code that an exception passed, in brackets; "" where it passed none."""
    ours = (Path(__file__).parent, *map(Path, (sysconfig.get_path("purelib"), sysconfig.get_path("stdlib"))))
    every = traceback.extract_tb(error.__traceback__)
    foreign = [f for f in every if not Path(f.filename).is_relative_to(ours[0])]
    # a package of somebody else's is installed like NumPy; where nothing lies outside, it is the one
    frames = [f for f in foreign if not any(Path(f.filename).is_relative_to(folder) for folder in ours)] or foreign
    return f" ({frames[-1].filename}:{frames[-1].lineno})" if frames else ""


def warn(message: str, category: type[Warning]) -> None:
    """Warn at the line outside this package that asked."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith("fddbench."):
        frame, level = frame.f_back, level + 1
    warnings.warn(message, category, stacklevel=level)


def raise_interrupt(error: BaseException) -> None:
    """Raise Ctrl-C again; anything else that foreign code raises is its own, a KeyboardInterrupt of its own included.

    For ``except BaseException`` around foreign code: a detector may raise SystemExit, GeneratorExit, MemoryError, whatever.
    """
    if isinstance(error, KeyboardInterrupt) and not by_statement(error):
        raise error


def by_statement(error: BaseException) -> bool:
    """Whether a ``raise`` in somebody's code raised this; Ctrl-C comes between two instructions, wherever they are."""
    last = error.__traceback__
    while last is not None and last.tb_next is not None:
        last = last.tb_next
    return last is not None and last.tb_frame.f_code.co_code[last.tb_lasti] == dis.opmap["RAISE_VARARGS"]


class FddbenchError(Exception):
    """Base of everything that is the user's to mend; `fddbench` prints it and exits with 2."""


@dataclass(eq=False)
class UnknownNameError(FddbenchError):
    """A campaign names a benchmark, fault, voter or detector that nobody registered."""

    family: str
    name: str
    known: tuple[str, ...]
    where: str = ""

    def __str__(self) -> str:
        """Name the place, the nearest known name, all of them, and the remedy."""
        lines = [
            f"{self.where + ': ' if self.where else ''}no {self.family} is called {self.name!r}.",
            did_you_mean(self.name, self.known),
            f"Known: {', '.join(sorted(self.known)) or 'none'}.",
            f'Register a new one under [project.entry-points."fddbench.{self.family}s"].',
        ]
        return "\n".join(filter(None, lines))


@dataclass(frozen=True)
class Mistake:
    """One mistake in a file: where it stands and what to do about it.

    Attributes
    ----------
    where : str
        ``file:line:column``; empty where it stands in no file, such as a design that a command names.
    message : str
        What was received, what is allowed, what to do.
    """

    where: str
    message: str

    def __str__(self) -> str:
        """One line, as compilers print it."""
        return f"{self.where}: {self.message}" if self.where else self.message


@dataclass(eq=False)
class CampaignError(FddbenchError):
    """All mistakes of a campaign or design file at once."""

    mistakes: tuple[Mistake, ...]

    def __str__(self) -> str:
        """Every mistake on its own line, with the count when there are several."""
        lines = [str(mistake) for mistake in self.mistakes]
        return "\n".join(lines if len(lines) == 1 else [f"{len(lines)} mistakes", *lines])


@dataclass(eq=False)
class DesignError(FddbenchError):
    """A detector's numbers do not make a detector (diverging observer, wrong sample time, wrong shape)."""

    message: str

    def __str__(self) -> str:
        """The message as written."""
        return self.message


@dataclass(eq=False)
class EndedError(FddbenchError):
    """A detector's process is gone, was ended, or is none: the status of its row, and what is known."""

    status: str
    message: str

    def __str__(self) -> str:
        """The message; before it the status, as rows have it, where that is more than an error."""
        return self.message if self.status == "error" else f"{self.status}: {self.message}"


@dataclass(eq=False)
class ResultsError(FddbenchError):
    """A folder of results is not what the command needs."""

    message: str

    def __str__(self) -> str:
        """The message as written."""
        return self.message


@dataclass(eq=False)
class UntrustedError(ResultsError):
    """A folder of results holds code that was not flown from here and is not run."""


class ResultsWarning(UserWarning):
    """Something about a folder of results that a reader must know; the commands print it."""


class PartialResultsWarning(ResultsWarning):
    """A folder holds some of the flights of its campaign."""


class OtherProgramWarning(ResultsWarning):
    """What reads or flies again is another program than the one that wrote the folder."""
