"""A campaign with plug-ins is read by a process that may die of them before it is read by the one that flies.

What a step does is met flight by flight (`fddbench.runner.supervised.server`); what a file does when it is imported, when its
detector is made and when its step is traced would be done to whoever reads the campaign. So a process of its own does all of
this first, and says that it came to its end; mistakes that are exceptions are told where the campaign is read. Started as a
module.
"""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from fddbench.campaign.load import read_campaign
from fddbench.campaign.meaning import Campaign
from fddbench.errors import FddbenchError, signal_name
from fddbench.plugin_files import none_run
from fddbench.runner.assembling import assemble
from fddbench.runner.supervised.manners import die_with, limit_data, print_little
from fddbench.runner.supervised.stages import can_supervise

__all__ = ["LONGEST_S", "MOST_GB", "read_safely"]

LONGEST_S = 120.0
"""Longest time that the plug-ins of a campaign take to be imported, made and traced [s]."""
MOST_GB = 4.0
"""Memory that they may write to for that [GB]."""
_DONE, _MEMORY, _INTERRUPT = b"DONE", b"MEMORY", b"INTERRUPT"


def read_safely(path: Path, overrides: Sequence[str] = ()) -> Campaign:
    """Campaign of a file; plug-ins that it names are tried in a process of their own first.

    Raises
    ------
    FddbenchError
        A mistake in it, or a plug-in that ends, hangs or exhausts the process that imports or makes it.
    """
    try:
        with none_run() as asked:
            return read_campaign(path, overrides)
    except FddbenchError:
        files = [name for name in dict.fromkeys(asked) if name.endswith(".py")]
        if not asked:
            raise
    if files and can_supervise():
        harm = _harm(path, overrides)
        if harm:
            raise FddbenchError(
                f"{path}: importing {', '.join(files)} and making what they define {harm}. Nothing was flown or written; "
                "mend the file, what it does when it is imported or made is done to every program that reads it"
            )
    return read_campaign(path, overrides)


def _harm(path: Path, overrides: Sequence[str]) -> str:
    """What the plug-ins of a campaign do to the process that reads it, in words; "" for nothing."""
    ours, theirs = os.pipe()
    asked = json.dumps({"path": str(path), "overrides": list(overrides), "search": [str(each) for each in sys.path]})
    line = [sys.executable, "-m", "fddbench.runner.supervised.trial", str(theirs), str(os.getpid()), asked]
    process = subprocess.Popen(
        line, pass_fds=[theirs], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, start_new_session=True,
        env={**os.environ, "PYTHONSAFEPATH": "1"},
    )  # fmt: skip
    os.close(theirs)
    try:
        status = process.wait(LONGEST_S)
    except subprocess.TimeoutExpired:
        return f"did not come to an end in {LONGEST_S:g} s"
    finally:
        with suppress(OSError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        os.set_blocking(ours, False)
        said = b""
        with suppress(BlockingIOError):  # somebody whom it started still holds the other end, and it has said nothing
            said = os.read(ours, len(_INTERRUPT))
        os.close(ours)
    return _in_words(said, status)


def _in_words(said: bytes, status: int) -> str:
    if said == _DONE:
        return ""
    if said == _MEMORY:
        return f"needs more than {MOST_GB:g} GB of memory"
    if said == _INTERRUPT:
        return "raises KeyboardInterrupt"
    if status < 0:
        return f"ends the process with {signal_name(-status)}"
    return f"ends the process with exit code {status}, or closes files that are not its own"


def _main(fd: int, parent: int, path: str, overrides: Sequence[str], search: Sequence[str]) -> None:
    """Read, make and trace, then say so; whatever is an exception is told by whoever reads the campaign next."""
    own = os.getpid()
    die_with(parent)
    print_little()
    limit_data(MOST_GB)
    # now that what is ours is imported: a file of anybody's may be called as a module of Python is
    sys.path[:] = search
    word = _DONE
    try:
        for detector in assemble(read_campaign(Path(path), overrides)).detectors.values():
            _ = detector.obstacle
    except KeyboardInterrupt:
        word = _INTERRUPT
    except BaseException as error:  # the mistakes of a campaign are told in words
        word = _MEMORY if isinstance(error, MemoryError) or "MemoryError" in str(error) else _DONE
    if os.getpid() == own:  # a file that forks says it once
        with suppress(OSError):
            os.write(fd, word)
    os._exit(0)


if __name__ == "__main__":
    _main(int(sys.argv[1]), int(sys.argv[2]), **json.loads(sys.argv[3]))
