"""What differs between the flights of a scenario: the numbers of its faults that are drawn or swept through."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from fddbench.blocks import functions
from fddbench.blocks.consumers import FAULT_NUMBERS_0
from fddbench.blocks.philox import normals, uniforms
from fddbench.campaign.sampling import Runs, digits
from fddbench.campaign.streams import name_word
from fddbench.clock import sample_numbers
from fddbench.faults.specification import FaultSpecification
from fddbench.faults.varied import Varied
from fddbench.interfaces import Floats

__all__ = ["Variation", "at_levels", "flown", "level_radices", "variations"]

Faults = tuple[FaultSpecification, ...]


@dataclass(frozen=True, kw_only=True)
class Variation:
    """A number of a fault that is drawn or swept.

    Attributes
    ----------
    line : int
        Which fault of the scenario, from 0.
    field, key : str
        Name of the field, and the key that a campaign writes (with the unit).
    value : Varied
        How it differs.
    time : bool
        A time, rounded to the clock.
    """

    line: int
    field: str
    key: str
    value: Varied
    time: bool

    @property
    def column(self) -> str:
        """Column of the rows that holds what was flown, ``f1_amplitude_percent``."""
        return f"f{self.line + 1}_{self.key}"


def variations(faults: Sequence[FaultSpecification]) -> tuple[Variation, ...]:
    """Everything that differs, line by line and in each by the alphabet of the keys."""
    return tuple(
        Variation(line=line, field=field, key=fault.key(field), value=value, time=field in fault.times)
        for line, fault in enumerate(faults)
        for field, value in fault.varied.items()
    )


def _sweeps(faults: Sequence[FaultSpecification]) -> tuple[Variation, ...]:
    return tuple(each for each in variations(faults) if each.value.grid is not None)


def level_radices(faults: Sequence[FaultSpecification]) -> tuple[int, ...]:
    """Numbers of values of the sweeps, in the order of `variations`; the last is the fastest digit of a level."""
    return tuple(len(each.value.written) for each in _sweeps(faults))


def at_levels(faults: Faults) -> Iterator[Faults]:
    """Faults at every level, level after level: swept numbers as written, drawn ones left open."""
    sweeps = _sweeps(faults)
    for values in product(*(each.value.written for each in sweeps)):
        yield _with(faults, dict(zip(sweeps, values, strict=True)))


def flown(
    faults: Faults, *, level: Runs, run: Runs, key: int, stream: int, sample_s: float
) -> tuple[Faults, dict[str, Floats]]:
    """Faults with an (n_cases,) array for every number that differs, and those arrays by their columns.

    A draw has the counter (hash of the key's name, consumer of the line, run, stream of the scenario): another line, key,
    level, point or run changes none.

    Parameters
    ----------
    level, run : (n_cases,) arrays
        Addresses of the flights.
    key, stream : int
        Seed of the campaign, and stream of the scenario.
    sample_s : float
        Drawn times are rounded to it [s].
    """
    swept = dict(zip(_sweeps(faults), digits(level, level_radices(faults)), strict=True))
    found: dict[Variation, Floats] = {}
    for each in variations(faults):
        if each in swept:
            found[each] = np.array(each.value.written)[swept[each]]
        else:
            drawn = _drawn(each.value, (name_word(each.key), FAULT_NUMBERS_0 + each.line, run, stream), key)
            found[each] = np.round(sample_numbers(drawn, sample_s) * sample_s, 9) if each.time else drawn
    return _with(faults, found), {each.column: values for each, values in found.items()}


def _with(faults: Faults, values: Mapping[Variation, float | Floats]) -> Faults:
    """Faults with numbers or arrays in place of what differs."""
    return tuple(
        fault.flown({each.field: value for each, value in values.items() if each.line == line})
        for line, fault in enumerate(faults)
    )


def _drawn(value: Varied, counter: tuple[int, int, Runs, int], key: int) -> Floats:
    if value.normal is not None:
        bell: Floats = value.normal.mean + value.normal.std * normals(counter, key)[0]
        return bell
    low, high = value.bounds
    share = uniforms(counter, key)[0]
    if value.uniform is not None:
        straight: Floats = low + share * (high - low)
        return straight
    bent: Floats = low * functions.exp(share * functions.log(np.float64(high / low)))
    return bent
