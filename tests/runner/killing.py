"""A run that is killed at its N-th file-system event, again and again; called by test_kills.py as a process of its own.

Everything is imported once; each run is a fork of that, so that hundreds of kills take seconds. An audit hook sees each event
on the folder of results before it happens, and the process kills itself there as the system would.
"""

import hashlib
import json
import os
import shutil
import signal
import sys
from pathlib import Path

import fddbench
from fddbench.campaign.load import read_campaign
from fddbench.runner.run import run_campaign

EVENTS = {
    "open",
    "os.rename",
    "os.remove",
    "os.mkdir",
    "os.rmdir",
    "os.truncate",
    "os.link",
    "os.chmod",
    "shutil.rmtree",
}


def _fly(source: str, out: Path) -> None:
    run_campaign(read_campaign(Path(source)), out, jobs=1, chunk=6)


def _killed_at(number: int, source: str, out: Path) -> int:
    """Fly in a fork that kills itself before event `number` on the folder; 9 if it did, 0 if it came to its end."""
    child = os.fork()
    if child == 0:
        seen = 0

        def hook(event: str, arguments: tuple[object, ...]) -> None:
            nonlocal seen
            # a file is opened for reading without being an event of a write
            if event in EVENTS and any(str(out) in str(a) for a in arguments) and not _reads(event, arguments):
                seen += 1
                if seen == number:
                    os.kill(os.getpid(), signal.SIGKILL)

        sys.addaudithook(hook)
        try:
            _fly(source, out)
        except BaseException as error:
            sys.stderr.write(f"{type(error).__name__}: {error}\n")
            os._exit(1)
        os._exit(0)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def _reads(event: str, arguments: tuple[object, ...]) -> bool:
    return (
        event == "open" and isinstance(arguments[2], int) and not arguments[2] & (os.O_WRONLY | os.O_RDWR | os.O_CREAT)
    )


def _state(out: Path) -> dict[str, object]:
    """What a folder holds, told by a fork so that this process stays as it was."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        rows = fddbench.load(out).sort_values(["case", "detector"])
        digest = hashlib.sha256(rows.to_csv(index=False).encode()).hexdigest()
        names = sorted(p.name for p in out.rglob("*") if p.name.endswith(".tmp"))
        os.write(write, json.dumps({"rows": digest, "n": len(rows), "left": names}).encode())
        os._exit(0)
    os.close(write)
    with os.fdopen(read) as file:
        text = file.read()
    os.waitpid(child, 0)
    return dict(json.loads(text))


def main(source: str, folder: Path) -> None:
    """Print as JSON what each kill left, of a run and of the going on of a killed run."""
    clean = folder / "clean"
    assert _killed_at(0, source, clean) == 0
    found: dict[str, object] = {"clean": _state(clean), "kills": []}
    kills: list[object] = []
    half = folder / "half"
    number = 1
    while (code := _killed_at(number, source, folder / "out")) == -signal.SIGKILL:
        if number == 30:
            shutil.copytree(folder / "out", half)
        kills.append(["run", number, _killed_at(0, source, folder / "out"), _state(folder / "out")])
        shutil.rmtree(folder / "out")
        number += 1
    found["run"], shown = code, folder / "again"
    number = 1
    while True:
        shutil.copytree(half, shown)
        code = _killed_at(number, source, shown)
        if code != -signal.SIGKILL:
            break
        kills.append(["going on", number, _killed_at(0, source, shown), _state(shown)])
        shutil.rmtree(shown)
        number += 1
    found["going on"], found["kills"] = code, kills
    sys.stdout.write(json.dumps(found))


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
