"""Numbers of a fault that differ from flight to flight: drawn, or swept through.

A campaign writes ``{uniform: [a, b]}``, ``{log_uniform: [a, b]}``, ``{normal: {mean: m, std: s}}`` or
``{grid: [a, b, c]}`` where it could write a number.
"""

import json
from collections.abc import Callable
from dataclasses import dataclass
from math import inf
from typing import Annotated, Any, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_core import core_schema

__all__ = ["Bell", "Number", "Varied", "bounds", "in_words"]

_Finite = Annotated[float, Field(allow_inf_nan=False)]
_Ends = Annotated[tuple[_Finite, ...], Field(min_length=2, max_length=2)]


class Bell(BaseModel):
    """A bell curve.

    Attributes
    ----------
    mean, std : float
        In the unit of the key.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    mean: _Finite
    std: Annotated[float, Field(gt=0.0, allow_inf_nan=False)]


class Varied(BaseModel):
    """A distribution, drawn for every run, or a sweep; exactly one is given.

    Attributes
    ----------
    uniform, log_uniform : (low, high)
        In the unit of the key; of the second the logarithm is uniform.
    normal : Bell
        A bell curve.
    grid : tuple of float
        A sweep: every value is flown, each a level of the scenario.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    uniform: _Ends | None = None
    log_uniform: _Ends | None = None
    normal: Bell | None = None
    grid: Annotated[tuple[_Finite, ...], Field(min_length=1)] | None = None

    @model_validator(mode="after")
    def _sound(self) -> Self:
        given = [name for name in type(self).model_fields if getattr(self, name) is not None]
        if len(given) != 1:
            every = " | ".join(type(self).model_fields)
            raise ValueError(f"need a number or exactly one of {every}, got {' and '.join(given) or 'none'}")
        ends = self.uniform or self.log_uniform
        if ends and not ends[0] < ends[1]:
            raise ValueError(f"{given[0]} needs low below high, got low {ends[0]:g} and high {ends[1]:g}")
        if self.log_uniform and self.log_uniform[0] <= 0.0:
            raise ValueError(f"log_uniform needs positive numbers, got low {self.log_uniform[0]:g}")
        twice = [value for n, value in enumerate(self.grid or ()) if value in (self.grid or ())[:n]]
        if twice:
            raise ValueError(f"grid lists {twice[0]:g} twice; every value is flown once, list it once")
        return self

    @property
    def name(self) -> str:
        """Which of the four it is."""
        return next(name for name in type(self).model_fields if getattr(self, name) is not None)

    @property
    def bounds(self) -> tuple[float, float]:
        """Smallest and largest number that can be flown."""
        ends = self.uniform or self.log_uniform
        if ends:
            return ends[0], ends[1]
        return (-inf, inf) if self.grid is None else (min(self.grid), max(self.grid))

    @property
    def written(self) -> tuple[float, ...]:
        """The numbers as they are written, for checks of each; none for a bell curve."""
        return self.grid or self.uniform or self.log_uniform or ()

    @property
    def example(self) -> float:
        """A number that may be flown."""
        return self.normal.mean if self.normal else self.written[0]


@dataclass(frozen=True)
class Number:
    """Annotation of a number of a fault: a finite number within bounds, or something `Varied` within them.

    ``Annotated[Any, Number(ge=0.0)]`` is a field that any kind of fault may have; in flight it is a number or an (n_cases,)
    array.

    Attributes
    ----------
    ge, gt, le : float or None
        Smallest number, or the number that it must exceed; largest number.
    time : bool
        A time: on the clock, so only ``uniform`` and ``grid`` can vary it.
    whole : bool
        A count: whole numbers, so only ``grid`` can vary it.
    """

    ge: float | None = None
    gt: float | None = None
    le: float | None = None
    time: bool = False
    whole: bool = False

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> core_schema.CoreSchema:
        """Validate a number as pydantic does, a mapping as `Varied`."""
        del source, handler
        return core_schema.no_info_wrap_validator_function(
            self._read,
            core_schema.float_schema(ge=self.ge, gt=self.gt, le=self.le, allow_inf_nan=False),
            serialization=core_schema.plain_serializer_function_ser_schema(_plain),
        )

    def __get_pydantic_json_schema__(self, core: Any, handler: Any) -> dict[str, Any]:
        """A number, or one of the ways to vary it that stay within its bounds."""
        del core, handler
        number: dict[str, Any] = {"type": "integer" if self.whole else "number"}
        bounds = {"minimum": self.ge, "exclusiveMinimum": self.gt, "maximum": self.le}
        number |= {word: bound for word, bound in bounds.items() if bound is not None}
        ends = {"type": "array", "items": number, "minItems": 2, "maxItems": 2}
        ways: dict[str, Any] = {"grid": {"type": "array", "items": number, "minItems": 1, "uniqueItems": True}}
        if not self.whole:
            ways["uniform"] = ends
        if not self.whole and not self.time:
            ways["log_uniform"] = {**ends, "items": {**number, "exclusiveMinimum": max(self.gt or 0.0, 0.0)}}
            if len(number) == 1:
                ways["normal"] = Bell.model_json_schema()
        return {"anyOf": [number, _one_of(ways)]}

    def _read(self, value: Any, number: Callable[[Any], float]) -> "float | Varied":
        if isinstance(value, dict):
            value = Varied.model_validate_json(json.dumps(value), strict=True)
        if not isinstance(value, Varied):
            return self._counted(number(value))
        if self.whole and value.name != "grid":
            raise ValueError(f"{value.name} cannot draw a whole number; use grid: [1, 2]")
        for each in value.written if self.whole else ():
            self._counted(each)
        if self.time and value.name not in ("uniform", "grid"):
            raise ValueError(
                f"{value.name} cannot draw a time: it must be bounded; use uniform: [a, b] or grid: [a, b]"
            )
        low, high = value.bounds
        limits = (
            (f">= {self.ge}", low, self.ge is not None and low < self.ge),
            (f"> {self.gt}", low, self.gt is not None and low <= self.gt),
            (f"<= {self.le}", high, self.le is not None and high > self.le),
        )
        for limit, end in ((text, end) for text, end, missed in limits if missed):
            found = "a bell curve draws any number; use uniform or log_uniform" if value.normal else f"got {end:g}"
            raise ValueError(f"{value.name} must stay {limit}, {found}")
        return value

    def _counted(self, value: float) -> float:
        if self.whole and not value.is_integer():
            raise ValueError(f"need a whole number, got {value:g}")
        return value


def _one_of(ways: dict[str, Any]) -> dict[str, Any]:
    """Schema of a mapping with exactly one of these keys."""
    return {
        "type": "object",
        "properties": ways,
        "additionalProperties": False,
        "minProperties": 1,
        "maxProperties": 1,
    }


def _plain(value: Any) -> Any:
    """What goes into a fingerprint: the number, or what is given of a variation."""
    return value.model_dump(mode="json", exclude_none=True) if isinstance(value, Varied) else value


def bounds(value: Any) -> tuple[float, float]:
    """Smallest and largest number that can be flown of a plain or varied number.

    >>> bounds(2.0), bounds(Varied(grid=(4.0, 1.0)))
    ((2.0, 2.0), (1.0, 4.0))
    """
    return value.bounds if isinstance(value, Varied) else (value, value)


def in_words(value: Any) -> str:
    """A number of a fault as messages and ``check`` write it.

    >>> in_words(2.0), in_words(Varied(grid=(4.0, 1.0))), in_words(Varied(log_uniform=(0.1, 4.0)))
    ('2', '4|1', 'log_uniform 0.1 to 4')
    """
    if not isinstance(value, Varied):
        return f"{value:g}" if isinstance(value, float) else str(value)
    if value.grid is not None:
        return "|".join(f"{each:g}" for each in value.grid)
    if value.normal is not None:
        return f"normal with mean {value.normal.mean:g}, std {value.normal.std:g}"
    return f"{value.name} {value.bounds[0]:g} to {value.bounds[1]:g}"
