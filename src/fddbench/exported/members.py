"""What a detector is made of: its parts by class, and its numbers by the names that its author gave them."""

import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from inspect import cleandoc
from typing import Any

import numpy as np
import numpy.typing as npt
from pydantic import BaseModel

from fddbench.blocks.layout import Layout
from fddbench.blocks.table import Table

__all__ = ["Constant", "Members"]

_DEEPEST, _LARGEST = 7, 20000
_PARAGRAPHS = 4
_TRIVIAL = {0.0, 1.0, -1.0, 2.0, 0.5}


@dataclass(frozen=True, eq=False)
class Constant:
    """A number or an array of numbers that has a name.

    Attributes
    ----------
    name, path : str
        Of the attribute, and the way to it from the detector.
    values : array
        Its numbers, without axes of length 1.
    """

    name: str
    path: str
    values: npt.NDArray[np.float64] = field(repr=False)

    def place_of(self, value: float, after: int = -1) -> int | None:
        """Flat index of an entry with these bits, the next one behind `after` if there is one; None without any."""
        same = np.flatnonzero(self.values.ravel().view(np.int64) == np.float64(value).view(np.int64))
        if not len(same):
            return None
        later = same[same > after]
        return int(later[0] if len(later) else same[0])


class Members:
    """Parts and numbers of a detector.

    Parameters
    ----------
    detector : object
        What a kind's ``from_design`` made.
    """

    def __init__(self, detector: Any) -> None:
        self._numbers: dict[str, list[Constant]] = {}
        self.parts: dict[str, list[Any]] = {}
        self.tables: dict[Table, str] = {}
        self._seen: set[int] = set()
        self._kept: list[Any] = []  # so that no id is given twice
        self._walk(detector, "", 0)

    def named(self, value: float, words: Sequence[str], filename: str) -> Iterator[Constant]:
        """Constants of these names that have a number, in the order of the names."""
        if value in _TRIVIAL or not np.isfinite(value):
            return
        for word in words:
            for constant in (*self._numbers.get(word, ()), *self._of_module(word, filename)):
                if constant.place_of(value) is not None:
                    yield constant

    def about(self, block: str) -> list[str]:
        """Paragraphs on the class of a part: its module's first one, its own, and the literature."""
        for part in self.parts.get(block, ()):
            own = type(part)
            module = (getattr(sys.modules.get(own.__module__), "__doc__", "") or "").strip()
            paragraphs = cleandoc(own.__doc__ or "").split("\n\n")
            text = [each for each in paragraphs if not re.search(r"\n-{3,}", each)][:_PARAGRAPHS]
            literature = [each.split("\n", 2)[2] for each in paragraphs if each.startswith("References\n")]
            return [module.split("\n\n")[0], *text, *literature]
        return []

    def _of_module(self, word: str, filename: str) -> Iterator[Constant]:
        """Numbers at the top of the file."""
        value = self._modules.get(filename, {}).get(word)
        if isinstance(value, float | int | tuple | np.ndarray) and not isinstance(value, bool):
            yield from self._constant(word, f"{filename}.{word}", value)

    @cached_property
    def _modules(self) -> dict[str, dict[str, Any]]:
        return {str(getattr(module, "__file__", "")): vars(module) for module in list(sys.modules.values()) if module}

    def _walk(self, value: Any, path: str, depth: int) -> None:
        if depth > _DEEPEST or id(value) in self._seen or isinstance(value, str | bytes | type | Layout):
            return
        if isinstance(value, bool | int | float | np.ndarray | np.number):
            self._number(value, path)
            return
        self._seen.add(id(value))
        self._kept.append(value)
        if isinstance(value, Table):
            self.tables.setdefault(value, path)
        elif isinstance(value, list | tuple):
            self._number(value, path)
            for number, each in enumerate(value):
                self._walk(each, f"{path}.{number}", depth + 1)
        elif isinstance(value, Mapping):
            for key, each in value.items():
                self._walk(each, f"{path}.{key}", depth + 1)
        elif isinstance(value, BaseModel) or hasattr(value, "__dict__") or hasattr(value, "__dataclass_fields__"):
            self._part(value, path, depth)

    def _part(self, value: Any, path: str, depth: int) -> None:
        """An object: its class, and what it holds."""
        if type(value).__module__.split(".")[0] in {"builtins", "numpy", "functools"} or callable(value):
            return
        self.parts.setdefault(type(value).__name__, []).append(value)
        names = getattr(value, "__dataclass_fields__", None) or getattr(value, "__dict__", {})
        for name in names:
            self._walk(getattr(value, name, None), f"{path}.{name}" if path else str(name), depth + 1)

    def _number(self, value: Any, path: str) -> None:
        name = next((part for part in reversed(path.split(".")) if not part.isdigit()), "")
        if isinstance(value, bool) or path.rsplit(".", 1)[-1].isdigit():
            return
        for constant in self._constant(name, path, value):
            self._numbers.setdefault(name, []).append(constant)

    def _constant(self, name: str, path: str, value: Any) -> Iterator[Constant]:
        try:
            array = np.asarray(value, dtype=float)
        except (TypeError, ValueError):
            return
        if 0 < array.size <= _LARGEST and array.dtype.kind == "f":
            yield Constant(name, path, np.array(np.squeeze(array), order="C"))
