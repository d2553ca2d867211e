"""Numbers of a sliding-mode observer for any affine model, as a design file writes them."""

from typing import Annotated, ClassVar, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from fddbench.detection.lpv_filter.gains import ChannelEntry, NonZero, TrimEntry
from fddbench.detection.sliding_mode.gains import TwistingEntry

__all__ = ["SlidingModeObserverGains"]

Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Negative = Annotated[float, Field(lt=0.0, allow_inf_nan=False)]
Matrix = Annotated[tuple[Annotated[tuple[Number, ...], Field(min_length=1)], ...], Field(min_length=1)]
Family = Annotated[tuple[Matrix, ...], Field(min_length=1)]


class SlidingModeObserverGains(BaseModel):
    """Observer of the augmented model, eqs (8) to (13), in the model's own coordinates, and the decision on its estimates.

    Families have the constant matrix first, then one for each scheduling parameter in its unit; a single one is constant.

    Attributes
    ----------
    scheduling : str or None
        What makes the scheduling parameters: registered, or ``mine.py:Mine`` beside the design; None: A and B are constant.
    outputs, inputs : channels
        y and u; the last outputs are those that are filtered.
    filter_poles_1_s : numbers
        A_f of each filtered output [1/s]; none for faults of actuators.
    A, B, G_l : families of (n, n), (n, m), (n, p) matrices
        Of the augmented model, state [x, z_f].
    C, G_n : (p, n), (n, p) matrices
    start : (n, p) matrix
        State at the first sample, of its outputs.
    output_scale : p numbers
        Size of each output, in which e_y is measured where outputs are mixed: ``|P_o S^-1 e_y|``.
    error_pole_1_s : p numbers
        Diagonal of A22s [1/s].
    injection, k, delta, newton_steps, twisting
        As of `sliding_mode`, for scaled outputs; of the twisting, in the units of the outputs.
    W : (q, p) matrix
        Eq (21).
    strength : family of (q, 1) matrices
        How strong each fault is at rho, beside the strength that W is for; 1 for faults of sensors.
    sites : q names
        What the faults are of.
    isolates : bool
        Whether these are sites of the benchmark, and are declared; else there is an alarm alone.
    unit_per_fault : q numbers
        Unit of the site per unit of the fault in the model.
    smooth_s : q numbers
        Lag on each estimate [s]; 0: none.
    thresholds : q numbers
        Largest estimate that is no fault, in the unit of its site.
    confirm_s : float
        How long an estimate must stay beyond its threshold [s].
    trim : TrimEntry or None
        Takes slow offsets out; None: estimates as they are.
    """

    MEMBERS: ClassVar = {"scheduling": "scheduling"}
    THRESHOLDS: ClassVar = {"thresholds": "up"}
    model_config = ConfigDict(extra="forbid", frozen=True)

    scheduling: str | None = None
    outputs: Annotated[tuple[ChannelEntry, ...], Field(min_length=1)]
    inputs: tuple[ChannelEntry, ...]
    filter_poles_1_s: tuple[Positive, ...] = ()
    A: Family
    B: Family
    G_l: Family
    C: Matrix
    G_n: Matrix
    start: Matrix
    output_scale: Annotated[tuple[Positive, ...], Field(min_length=1)]
    error_pole_1_s: Annotated[tuple[Negative, ...], Field(min_length=1)]
    injection: Literal["sigmoid", "unit_vector", "super_twisting"] = "sigmoid"
    k: Annotated[tuple[Positive, ...], Field(min_length=1)]
    delta: Positive
    newton_steps: Annotated[int, Field(ge=1, le=20)] = 3
    twisting: TwistingEntry | None = None
    W: Matrix
    strength: Family | None = None
    sites: Annotated[tuple[str, ...], Field(min_length=1)]
    isolates: bool = True
    unit_per_fault: Annotated[tuple[NonZero, ...], Field(min_length=1)]
    smooth_s: Annotated[tuple[NonNegative, ...], Field(min_length=1)]
    thresholds: Annotated[tuple[Positive, ...], Field(min_length=1)]
    confirm_s: NonNegative
    trim: TrimEntry | None = None

    @model_validator(mode="after")
    def _sizes_fit(self) -> Self:
        """Every array has the size that its neighbours ask for."""
        n, p, q, m = len(self.A[0]), len(self.C), len(self.sites), len(self.inputs)
        shapes = {
            "A": (self.A, (n, n)), "B": (self.B, (n, m)), "G_l": (self.G_l, (n, p)), "C": ((self.C,), (p, n)),
            "G_n": ((self.G_n,), (n, p)), "start": ((self.start,), (n, p)), "W": ((self.W,), (q, p)),
            "strength": (self.strength or (), (q, 1)),
        }  # fmt: skip
        for name, (family, need) in shapes.items():
            if any((len(M), len(row)) != need for M in family for row in M):
                raise ValueError(f"{name}: needs matrices of {need[0]} rows of {need[1]} numbers")
        lengths = {"outputs": p, "output_scale": p, "error_pole_1_s": p, "k": p}
        lengths |= dict.fromkeys(("unit_per_fault", "smooth_s", "thresholds"), q)
        wrong = [f"{name}: needs {need}" for name, need in lengths.items() if len(getattr(self, name)) != need]
        if wrong or len(self.filter_poles_1_s) >= p:
            raise ValueError(
                "; ".join(wrong) or "filter_poles_1_s: at least one output is trusted and passes no filter"
            )
        if (self.injection == "super_twisting") != (self.twisting is not None):
            raise ValueError("injection: super_twisting needs `twisting: {k1, k2}`, and nothing else looks at it")
        if self.twisting is not None and {len(self.twisting.k1), len(self.twisting.k2)} != {p}:
            raise ValueError(f"twisting: k1 and k2 need {p} numbers, one per output")
        return self
