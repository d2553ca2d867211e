"""What a fault does to the aircraft: a number of a flight that a loop announces, a column of the rows."""

from dataclasses import dataclass
from typing import Literal

__all__ = ["Consequence"]


@dataclass(frozen=True, kw_only=True)
class Consequence:
    """A number of a flight, from its first faulty sample k0 to the last scored one; of a healthy flight from its start.

    Beside it stands its healthy twin: the flight of the same point, run and manoeuvre without faults and without detectors,
    up to the same sample.

    Attributes
    ----------
    name : str
        The column, with the unit at its end, e.g. ``"peak_bank_deg"``.
    signal : str
        The true signal that it is of, one of `Loop.truth`.
    how : {"peak", "error", "rise"}
        ``peak``: largest absolute value from k0 on, in the unit of the signal; the twin's is a column of its own,
        ``healthy_NAME``. ``error``: the signal minus the twin's at the last scored sample, in the unit of the signal.
        ``rise``: mean of the signal from k0 on over the twin's, minus one [%].
    about : str
        What the signal is, in a few words.
    """

    name: str
    signal: str
    how: Literal["peak", "error", "rise"]
    about: str
