"""The numbers of a bank of LPV detection filters, as a design file writes them."""

from typing import Annotated, ClassVar, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

__all__ = ["ChannelEntry", "FilterEntry", "LpvFilterGains", "NonZero", "SensorsEntry", "TrimEntry"]


def _not_zero(value: float) -> float:
    if value == 0.0:
        raise ValueError("must not be 0: nothing would be left of it")
    return value


Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
NonZero = Annotated[Number, AfterValidator(_not_zero)]
Matrix = Annotated[tuple[tuple[Number, ...], ...], Field(min_length=1)]
Family = Annotated[tuple[Matrix, ...], Field(min_length=1)]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class ChannelEntry(_Strict):
    """A number that the filters take, ``scale (signal - offset)``, perhaps times another signal, or a constant.

    Attributes
    ----------
    signal : str
        Measured signal of the bus.
    constant : float
        Instead of a signal, such as the fictitious input.
    scale, offset : float
        Unit of the filter per unit of the signal; offset in the unit of the signal, such as its value in trim.
    row : int
        Which row of a signal that has several, from 0.
    held : bool
        Whether the plant holds this input from sample to sample; others go along a straight line.
    times : str
        Signal of one row that it is multiplied by.
    """

    signal: str | None = None
    constant: Number | None = None
    scale: NonZero = 1.0
    offset: Number = 0.0
    row: Annotated[int, Field(ge=0)] | None = None
    held: bool = False
    times: str | None = None

    @model_validator(mode="after")
    def _one_of_both(self) -> Self:
        if (self.signal is None) == (self.constant is None):
            raise ValueError("signal or constant: a channel has one of them")
        return self


class FilterEntry(_Strict):
    """Residual generator of one fault, ``w' = N w - G y + F u, r = M w - H y``.

    Families have the constant matrix first, then one for each scheduling parameter; a single matrix is constant.

    Attributes
    ----------
    site : str
        Fault site that it speaks for.
    N, G, F : families of (k, k), (k, n_y), (k, n_u) matrices
    M, H : (n_r, k), (n_r, n_y) matrices
    PL : family of (k, 1) matrices
        How the fault enters: r is ``M N^-1 PL`` times a steady fault.
    start : (k, n_y) matrix
        State at the first sample, of its outputs.
    unit_per_fault : float
        Unit of the site per unit of the fault in the model.
    least_gain : float
        Smallest length of ``M N^-1 PL`` that an estimate is divided by: half of the smallest over the box, so that no
        estimate is blown up outside.
    smooth_s : float
        Time constant of a lag on the estimate [s]; 0: none. Noise of an output goes straight into it otherwise.
    output : int or None
        Output, from 0, on which the fault sits: a sensor. Its estimate is that of a fresh fault, ``-h' r / h' h`` with the
        column h of H, and decays as the filter follows the faulty reading.
    """

    site: str
    N: Family
    G: Family
    F: Family
    M: Matrix
    H: Matrix
    PL: Family
    start: Matrix
    unit_per_fault: Number = 1.0
    least_gain: Positive
    smooth_s: NonNegative = 0.0
    output: Annotated[int, Field(ge=0)] | None = None


class SensorsEntry(_Strict):
    """Decision among sensors that measure one quantity, each with a filter of its own.

    Attributes
    ----------
    differ : float
        Root mean square difference of two sensors that is none, in the unit of the sites.
    mean_s : float
        Time constant of the mean squares of differences and estimates [s].
    """

    differ: Positive
    mean_s: Positive


class TrimEntry(_Strict):
    """What takes a slow offset out of each estimate.

    Attributes
    ----------
    time_constant_s : float
        With which the offset follows the estimate [s].
    freeze_above : numbers, one per site
        Distance between estimate and offset above which the offset stands still, in the unit of the site.
    learn_s : float
        First seconds, whose mean is the first offset; nothing is declared meanwhile [s].
    """

    time_constant_s: Positive
    freeze_above: Annotated[tuple[Positive, ...], Field(min_length=1)]
    learn_s: NonNegative = 0.0


class LpvFilterGains(_Strict):
    """A bank of filters and the decision on their estimates.

    Attributes
    ----------
    scheduling : str or None
        What makes the scheduling parameters: registered, or ``mine.py:Mine`` beside the design; None: the filters are constant.
    outputs, inputs : channels
        y and u of the filters, in order.
    bend : family of (n_y, n_y) matrices
        ``C A C^+``, by which outputs bend between two samples.
    filters : list of FilterEntry
    thresholds : numbers, one per filter
        Largest estimate that is no fault, in the unit of its site.
    confirm_s : float
        How long an estimate must stay beyond its threshold [s].
    trim : TrimEntry or None
        Takes slow offsets out; None: estimates as they are.
    sensors : SensorsEntry or None
        The sites are redundant sensors: one is suspected only while it differs from one with a smaller estimate. None: each
        fault by itself.
    """

    MEMBERS: ClassVar = {"scheduling": "scheduling"}
    THRESHOLDS: ClassVar = {"thresholds": "up"}

    scheduling: str | None = None
    outputs: Annotated[tuple[ChannelEntry, ...], Field(min_length=1)]
    inputs: Annotated[tuple[ChannelEntry, ...], Field(min_length=1)]
    bend: Family
    filters: Annotated[tuple[FilterEntry, ...], Field(min_length=1)]
    thresholds: Annotated[tuple[Positive, ...], Field(min_length=1)]
    confirm_s: NonNegative
    trim: TrimEntry | None = None
    sensors: SensorsEntry | None = None
