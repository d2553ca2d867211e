"""Parity relations of a linear plant: sums over a window of outputs and inputs that are zero but for faults."""

from types import SimpleNamespace
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.blocks.linear import column, product
from fddbench.detection.mean_test import MeanTest, MeanTestState, watched
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Verdict

__all__ = ["ParitySpace", "ParitySpaceGains"]

Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Matrix = Annotated[tuple[tuple[Number, ...], ...], Field(min_length=1)]


class ParitySpaceGains(BaseModel):
    """Relations on their clock, and their evaluation.

    Attributes
    ----------
    sample_s : float
        Clock that the relations are for [s].
    V : matrix
        One residual a row, for each fault site; columns y and u of the newest sample, of the one before, and so on.
    window_s, thresholds, confirm_s, estimates_faults : as of `HinfFilter`
        Moving mean of the residuals, and the decision on it.
    """

    THRESHOLDS: ClassVar = {"thresholds": "up"}
    model_config = ConfigDict(extra="forbid", frozen=True)

    sample_s: Positive
    V: Matrix
    window_s: Positive
    thresholds: Annotated[tuple[Positive, ...], Field(min_length=1)]
    confirm_s: NonNegative
    estimates_faults: bool = False


@record
class ParitySpaceState:
    """Outputs and inputs of the samples before, newest first; for how many there have been any; the decision."""

    seen: Rows
    test: MeanTestState


class ParitySpace:
    """Declares fault i when the moving mean of parity relation i stays beyond its threshold; a declaration is for good.

    Model assumed: the linear plant of the recipe, at rest before the first sample. A relation is blind to what the recipe
    decouples, here the other faults, and to the state before its window or, where that would cost too much, holds it for
    noise; of all these it is the one that tells a lasting fault from disturbances best, and it reads its size. Off by the
    uncertainty times states and inputs. Knobs: `recipe.order`, the window, trades delay and work for noise; the thresholds
    (``fddbench tune``). Cost: n_r (s + 1) (n_y + n_u) products, 816 operations a sample for the shipped design.

    References
    ----------
    Chow, Willsky (1984), Analytical redundancy and the design of robust failure detection systems, IEEE Transactions on
    Automatic Control 29(7), 603-614; Ding (2013), Model-based fault diagnosis techniques, chapter 7.

    Examples
    --------
    >>> import fddbench
    >>> figures = fddbench.read("jet_engine_figures", ["detectors=[parity_space_jet]"])
    >>> flight = fddbench.signals(figures, "figures_2_and_3")  # f1 and f2 from 14 s on, f3 from 20 s on
    >>> flight.detectors["parity_space_jet"]["n_declared"][[270, 300, 800], 0]
    array([0., 2., 3.])
    """

    about = "parity relations of a linear plant, moving mean and a threshold per residual"
    Gains = ParitySpaceGains
    constants: Layout[Any] = NOTHING
    draws: Draws[Any] = NO_DRAWS

    def __init__(self, gains: ParitySpaceGains, bus: Bus) -> None:
        self.V = column(gains.V)
        self.test = MeanTest(
            gains.thresholds,
            window_s=gains.window_s,
            confirm_s=gains.confirm_s,
            estimates=gains.estimates_faults,
            bus=bus,
        )
        self.watches, self.confirm_samples = watched(bus), self.test.confirm_samples
        self.estimates = "sites" if gains.estimates_faults else None
        self.evaluated, self.recorded = self.test.evaluated, self.test.recorded
        n_seen = self.V.shape[1] - bus.signals["y"] - bus.signals["u"]
        self.states = Layout(ParitySpaceState(seen=n_seen, test=self.test.states.shape))

    @classmethod
    def from_design(cls, gains: ParitySpaceGains, bus: Bus) -> "ParitySpace":
        """Relations for a bus with outputs y and inputs u, on their clock."""
        bus.require("y", "u")
        if abs(gains.sample_s - bus.sample_s) > 1e-9:
            raise DesignError(
                f"sample_s: these relations are for {gains.sample_s} s, this campaign has {bus.sample_s}; design them anew"
            )
        n, sites = bus.signals["y"] + bus.signals["u"], len(watched(bus))
        lengths = {len(row) for row in gains.V}
        if (
            len(gains.V) != sites
            or len(gains.thresholds) != sites
            or len(lengths) != 1
            or min(lengths) % n
            or min(lengths) <= n
        ):
            raise DesignError(
                f"V has {len(gains.V)} rows of {sorted(lengths)} numbers and there are {len(gains.thresholds)} thresholds: "
                f"needs {sites} of each, and twice or more the {n} numbers of a sample in every row"
            )
        return cls(gains, bus)

    def start(self, c: Nothing) -> ParitySpaceState:
        """At rest."""
        return ParitySpaceState(seen=0.0, test=self.test.start(c))

    def step(
        self, x: ParitySpaceState, c: Nothing, n: Nothing, measured: SimpleNamespace
    ) -> tuple[ParitySpaceState, Verdict]:
        """Verdict after one sample."""
        window = np.concatenate([measured.y, measured.u, x.seen])
        test, verdict = self.test.step(x.test, c, n, product(self.V, window))
        return ParitySpaceState(seen=window[: len(x.seen)], test=test), verdict
