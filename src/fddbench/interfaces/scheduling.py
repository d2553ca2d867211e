"""What makes scheduling parameters of measured signals, and the affine models that it may come with."""

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Protocol

from fddbench.blocks.layout import Rows
from fddbench.interfaces.floats import Floats

__all__ = ["AffineModel", "Channel", "Scheduling"]


@dataclass(frozen=True, kw_only=True)
class Channel:
    """A number that a filter takes: ``scale (signal[row] - offset)``, perhaps times another signal, or a constant.

    Attributes
    ----------
    signal : str
        Measured signal of the bus; "" for a constant.
    scale, offset : float
        Offset in the unit of the signal; the number itself is in the unit that the model works in. A constant is `scale`.
    row : int or None
        Row of a signal that has several.
    held : bool
        Whether the plant holds it from sample to sample, as one does with what it gets from a computer.
    times : str
        Signal of one row that it is multiplied by, such as the airspeed that makes a velocity of an angle; "": by none.
    """

    signal: str = ""
    scale: float = 1.0
    offset: float = 0.0
    row: int | None = None
    held: bool = False
    times: str = ""


@dataclass(frozen=True, kw_only=True, eq=False)
class AffineModel:
    """``x' = A(rho) x + B(rho) u, y = C x`` with what its outputs and inputs are on the bus.

    Attributes
    ----------
    A, B : (n_parameters + 1, n, n), (n_parameters + 1, n, n_u) arrays
        Constant part first, then the factor of each parameter in its unit.
    C : (n_y, n) array
    outputs, inputs : tuples of Channel
    box : (n_parameters, 2) array
        Smallest and largest value of each parameter.
    """

    A: Floats
    B: Floats
    C: Floats
    outputs: tuple[Channel, ...]
    inputs: tuple[Channel, ...]
    box: Floats


class Scheduling(Protocol):
    """Scheduling parameters from measured signals; a class without arguments registered under ``fddbench.schedulings``.

    Attributes
    ----------
    about : str
        One line.
    signals : tuple of str
        Measured signals that it needs.
    parameters : tuple of str
        Names of the parameters, with units.

    A class may have a ``box`` as well, ``[low, high]`` of each parameter, and ``models``, name → function without
    arguments that gives an `AffineModel`: those that ``fddbench design`` can make filters for.
    """

    about: str
    signals: tuple[str, ...]
    parameters: tuple[str, ...]

    def rho(self, measured: SimpleNamespace) -> Rows:
        """Parameters, (n_parameters, n_cases), of the signals of one sample; a step, as those of detectors are."""
        ...
