"""An entry of a campaign's detectors that sweeps through gains of a design: one detector a value."""

from typing import Annotated, Self

from pydantic import AfterValidator, Discriminator, Field, Tag, model_validator

from fddbench.campaign.rules.keys import Name, Number, Strict

__all__ = ["DetectorEntry", "Sweep", "SweptDesign", "names_of"]

MOST_VALUES = 200
"""Values of a sweep: each is a whole detector."""


def _distinct(values: tuple[float, ...]) -> tuple[float, ...]:
    """Values, none of them twice."""
    twice = [value for n, value in enumerate(values) if value in values[:n]]
    if twice:
        raise ValueError(f"{twice[0]:g} is listed twice; every value is one detector, list it once")
    return values


Numbers = Annotated[tuple[Number, ...], Field(min_length=1, max_length=MOST_VALUES), AfterValidator(_distinct)]
Span = Annotated[tuple[Number, ...], Field(min_length=3, max_length=3)]


class Sweep(Strict):
    """Values of a gain; exactly one of the four.

    Attributes
    ----------
    grid : tuple of float
        The values; a list alone means the same.
    scale : tuple of float
        Factors on what the design says [-]; of a list or matrix on every number in it.
    linspace, log : (first, last, count)
        So many values, equally far apart or in equal ratios.
    """

    grid: Numbers | None = None
    scale: Numbers | None = None
    linspace: Span | None = None
    log: Span | None = None

    @model_validator(mode="after")
    def _sound(self) -> Self:
        given = [name for name in type(self).model_fields if getattr(self, name) is not None]
        if len(given) != 1:
            every = " | ".join(type(self).model_fields)
            raise ValueError(f"need a list of numbers or exactly one of {every}, got {' and '.join(given) or 'none'}")
        span = self.linspace or self.log
        if span:
            first, last, count = span
            if not (count.is_integer() and 2 <= count <= MOST_VALUES):
                raise ValueError(
                    f"{given[0]} needs [first, last, count] with a count of 2 to {MOST_VALUES}, got {count:g}"
                )
            if first == last or (self.log and min(first, last) <= 0.0):
                need = "two different positive numbers" if self.log else "two different numbers"
                raise ValueError(f"{given[0]} goes between {need}, got {first:g} and {last:g}")
        return self

    @property
    def values(self) -> tuple[float, ...]:
        """The values, or the factors, in order."""
        listed = self.grid or self.scale
        if listed:
            return listed
        first, last, count = self.linspace or self.log or (0.0, 0.0, 1.0)
        shares = [i / (count - 1.0) for i in range(int(count))]
        if self.log:
            return tuple(_short(first * (last / first) ** share) for share in shares)
        return tuple(_short(first + share * (last - first)) for share in shares)


def _short(value: float) -> float:
    """A computed value as people would write it, to twelve digits."""
    return float(f"{value:.12g}")


ValuesEntry = Annotated[
    Annotated[Numbers, Tag("values")] | Annotated[Sweep, Tag("sweep")],
    Discriminator(lambda given: "sweep" if isinstance(given, dict | Sweep) else "values"),
]


class SweptDesign(Strict):
    """A design with other values of some gains: one detector a value, named ``DESIGN.KEY.1``, ``.2``, ….

    Several keys are swept one at a time, the other gains as the design has them. The design itself is not flown unless it is
    listed too.

    Attributes
    ----------
    design : str
        Name of the design.
    sweep : mapping of key to values
        Key of a gain; one inside others by dots, an item of a list by its number from 0 (``thresholds.0``).
    """

    design: Name
    sweep: Annotated[dict[str, ValuesEntry], Field(min_length=1)]

    @property
    def sweeps(self) -> dict[str, Sweep]:
        """Values by the key of the gain."""
        return {key: values if isinstance(values, Sweep) else Sweep(grid=values) for key, values in self.sweep.items()}

    @property
    def names(self) -> tuple[str, ...]:
        """Names of its detectors."""
        return tuple(
            f"{self.design}.{key}.{n + 1}" for key, sweep in self.sweeps.items() for n in range(len(sweep.values))
        )


DetectorEntry = Annotated[
    Annotated[Name, Tag("name")] | Annotated[SweptDesign, Tag("swept")],
    Discriminator(lambda given: "swept" if isinstance(given, dict | SweptDesign) else "name"),
]


def names_of(entries: tuple[str | SweptDesign, ...]) -> tuple[str, ...]:
    """Names of all detectors of a campaign, in order.

    >>> names_of(("plain", SweptDesign(design="x", sweep={"k": [1.0, 2.0]})))
    ('plain', 'x.k.1', 'x.k.2')
    """
    return tuple(name for each in entries for name in ((each,) if isinstance(each, str) else each.names))
