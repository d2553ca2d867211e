"""Small files to start from, written for a name of one's own; they fly at once."""

import re
from collections.abc import Mapping
from keyword import kwlist
from pathlib import Path
from shutil import copyfile

from fddbench import gallery
from fddbench.api.schemas import HEADER, schema_text
from fddbench.errors import FddbenchError

__all__ = ["STARTERS", "copy_shipped", "start"]

STARTERS: Mapping[str, Mapping[str, str]] = {
    "detector": {
        "detectors/NAME.py": "detector.py.txt",
        "detectors/NAME.yaml": "design.yaml.txt",
        "campaigns/NAME.yaml": "detector_campaign.yaml.txt",
    },
    "benchmark": {
        "campaigns/NAME.py": "benchmark.py.txt",
        "detectors/NAME_difference.py": "benchmark_detector.py.txt",
        "detectors/NAME_difference.yaml": "benchmark_design.yaml.txt",
        "campaigns/NAME.yaml": "benchmark_campaign.yaml.txt",
    },
    "fault": {"campaigns/NAME.py": "fault.py.txt", "campaigns/NAME.yaml": "fault_campaign.yaml.txt"},
    "trained": {
        "detectors/NAME_features.py": "features.py.txt",
        "detectors/train_NAME.py": "train.py.txt",
        "detectors/NAME.py": "trained.py.txt",
        "detectors/NAME.yaml": "trained.yaml.txt",
        "campaigns/NAME.yaml": "trained_campaign.yaml.txt",
    },
    "campaign": {"campaigns/NAME.yaml": "campaign.yaml.txt"},
}
"""What is started → file to write → what it is made of; NAME stands for the name and CLASS for the name of its class."""

_DATA = "../benchmarks/recorded/data"
_RECORDED = {
    "campaigns/logs/doublet.csv": f"{_DATA}/doublet.csv",
    "campaigns/logs/jam.csv": f"{_DATA}/jam.csv",
    "campaigns/logs/faults.csv": f"{_DATA}/faults.csv",
    "campaigns/logs/mapping.yaml": f"{_DATA}/yaw_rate_flights.yaml",
    "campaigns/logged.yaml": "recorded_campaign.yaml.txt",
}
"""What ``--benchmark recorded`` writes: no benchmark of one's own, but logs, which may be exchanged for others."""

_NAME = re.compile(r"[a-z][a-z0-9_]{0,39}")
_NO_NAMES = {*kwlist, "true", "false", "null", "yes", "no", "on", "off", "y", "n"}


def start(folder: Path, what: str, name: str) -> list[Path]:
    """Write the files of a new detector, benchmark, fault or campaign, and the schema that an editor reads; last its campaign.

    Raises
    ------
    FddbenchError
        The name is none, or a file is there already; then nothing is written.
    """
    if not _NAME.fullmatch(name) or name in _NO_NAMES:
        raise FddbenchError(
            f"{name!r} is no name for a {what}: small letters, digits and _, a letter first, at most 40, no word "
            f"of YAML or Python (true, null, class), as in my_{what}"
        )
    if what in {"detector", "trained"} and (gallery.folder("detectors") / f"{name}.yaml").is_file():
        raise FddbenchError(
            f"a shipped design is called {name!r}; choose another name, so that nobody takes one for the other"
        )
    if what == "campaign" and (gallery.folder("campaigns") / f"{name}.yaml").is_file():
        raise FddbenchError(
            f"a shipped campaign is called {name!r}; choose another name, so that nobody takes one for the other"
        )
    sources = _RECORDED if (what, name) == ("benchmark", "recorded") else STARTERS[what]
    texts = {folder / path.replace("NAME", name): _text(source, name) for path, source in sources.items()}
    there = [str(path) for path in texts if path.exists()]
    if there:
        raise FddbenchError(f"{', '.join(there)} is there already and is left alone; choose another name or folder")
    try:
        for path, text in texts.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        *others, campaign = texts
        return [*others, *_schema_beside(campaign, texts[campaign]), campaign]
    except OSError as error:
        raise FddbenchError(f"cannot write into {folder}: {error.strerror}; name another folder") from error


def _schema_beside(campaign: Path, text: str) -> list[Path]:
    """Schema that a new campaign names to an editor, written where there is none yet."""
    line = next(line for line in text.splitlines() if line.startswith(HEADER))
    path = campaign.parent / line.removeprefix(HEADER)
    if path.exists():
        return []
    shipped = gallery.folder("campaigns") / "schema" / path.name
    own = f"{path.stem}.py:{_class(path.stem)}"
    content = shipped.read_text(encoding="utf-8") if shipped.is_file() else schema_text(own, campaign.parent)
    path.parent.mkdir(exist_ok=True)
    path.write_text(content, encoding="utf-8")
    return [path]


def _text(source: str, name: str) -> str:
    text = (Path(__file__).parents[1] / "starters" / source).read_text(encoding="utf-8")
    return text.replace("NAME", name).replace("CLASS", _class(name))


def _class(name: str) -> str:
    """Name of the class in the file of a name."""
    return "".join(part.capitalize() for part in name.split("_")) or "Own"


def copy_shipped(folder: Path) -> list[Path]:
    """Copy the shipped campaigns with the schemas that they name, and the designs; what is there already is left alone.

    Raises
    ------
    FddbenchError
        The folder cannot be written.
    """
    written = []
    for name in ("campaigns", "campaigns/schema", "detectors"):
        target = folder / name
        try:
            target.mkdir(parents=True, exist_ok=True)
            for path in sorted(_shipped(name).iterdir()):
                if path.is_file() and not (target / path.name).exists():
                    copyfile(path, target / path.name)
                    written.append(target / path.name)
        except OSError as error:
            raise FddbenchError(f"cannot write into {target}: {error.strerror}; name another folder") from error
    return written


def _shipped(name: str) -> Path:
    """Shipped folder, or one inside."""
    first, *rest = name.split("/")
    return gallery.folder(first).joinpath(*rest)
