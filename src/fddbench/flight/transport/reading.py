"""Reads the file of an aircraft; refuses what is missing, unknown or cannot be, with its name and what is plausible."""

from functools import cache
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError

from fddbench.errors import FddbenchError, did_you_mean
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.shipped import SHIPPED

__all__ = ["SHIPPED", "read_aircraft", "read_data", "twin_jet"]

_SLIPS = {
    "_m": ("feet", 3.280839895013123),
    "_m2": ("square feet", 10.763910416709722),
    "_kt": ("m/s", 1.9438444924406046),
    "_kg": ("pounds", 2.2046226218487757),
    "_n": ("pounds", 4.4482216152605),
    "_kg_m2": ("slug square feet", 1.3558179483314),
    "_deg": ("radians", 57.29577951308232),
    "_deg_s": ("radians", 57.29577951308232),
    "_ratio": ("percent", 100.0),
    "_pa": ("pounds a square foot", 47.88025898033584),
}
"""Ending of a name → the unit it is mixed up with, and its factor; what has no unit is per radian."""


def read_aircraft(path: Path) -> Aircraft:
    """Aircraft in a YAML file.

    Raises
    ------
    FddbenchError
        A line for each mistake: the file, the name, what is wrong and what is plausible.
    """
    data = {name: part for name, part in read_data(path).items() if name != "law"}
    try:
        return Aircraft.model_validate(data)
    except ValidationError as error:
        lines = "\n".join(f"{path}: {_line(each)}" for each in error.errors())
        raise FddbenchError(f"{lines}\nSee {SHIPPED} for a whole one") from None


def read_data(path: Path) -> dict[str, Any]:
    """What an aircraft's file says, unchecked; beside the aircraft it may have gains as ``law``."""
    try:
        if (
            path.exists() and not path.is_file() and not path.is_dir()
        ):  # a pipe without a writer keeps its readers waiting
            raise FddbenchError(f"{path}: is a pipe or a device; give a file")
        data = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise FddbenchError(f"{path}: cannot be read: {error.strerror or error}") from error
    except (UnicodeDecodeError, yaml.YAMLError, RecursionError) as error:
        raise FddbenchError(f"{path}: cannot be read as the YAML of an aircraft: {error}") from error
    if not isinstance(data, dict):
        got = {"NoneType": "an empty file", "str": "text", "list": "a list"}.get(type(data).__name__, repr(data))
        raise FddbenchError(f"{path}: an aircraft is a mapping as in {SHIPPED.name}, got {got}")
    return data


@cache
def twin_jet() -> Aircraft:
    """The shipped aircraft, read once."""
    return read_aircraft(SHIPPED)


def _line(error: Any) -> str:
    """One mistake in the words of its author."""
    name, received = ".".join(str(part) for part in error["loc"]), error.get("input")
    if error["type"] == "missing":
        return f"{name} is missing; an aircraft needs every number of {SHIPPED.name}"
    if error["type"] == "extra_forbidden":
        known = _fields(error["loc"][:-1])
        return " ".join(filter(None, (f"{name} is no number of an aircraft.", did_you_mean(error["loc"][-1], known))))
    text: str = error["msg"].removeprefix("Value error, ")
    if not name:
        return text
    return f"{name}: {text}{_slip(name, text)}" if "plausible" in text else f"{name}: {text}, got {received!r:.60}"


def _fields(loc: tuple[Any, ...]) -> list[str]:
    """Names that belong to a part."""
    model: Any = Aircraft
    for part in loc:
        model = model.model_fields[part].annotation
    return list(model.model_fields)


def _slip(name: str, text: str) -> str:
    """Which unit was meant, if its factor would make the number plausible."""
    words = text.replace(",", "").split()
    at = words.index("is") + 1
    low, high, value = float(words[at]), float(words[at + 2]), float(words[-1])
    ending = max((each for each in _SLIPS if name.endswith(each)), key=len, default="")
    unit, factor = _SLIPS.get(ending, ("per degree", 57.29577951308232))
    return f"; is it in {unit}?" if any(low <= value * f <= high for f in (factor, 1.0 / factor)) else ""
