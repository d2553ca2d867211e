"""The observer (11)-(13) of an augmented affine model, and the fault that its injection tells, eq (21)."""

from typing import Any

import numpy as np

from fddbench.blocks.layout import Layout, Row, Rows, record
from fddbench.blocks.linear import affine, column, product
from fddbench.detection.sliding_mode.injection import injection
from fddbench.detection.sliding_mode_observer.gains import SlidingModeObserverGains

__all__ = ["Observer", "ObserverState"]


@record
class ObserverState:
    """State of the observer, its rate, the filtered outputs, and what the injection keeps."""

    x: Rows
    rate: Rows
    filtered: tuple[Rows, ...]
    injection: Any


class Observer:
    """Augmented observer, explicit but for the injection, which is solved for the error after it.

    Parameters
    ----------
    gains : SlidingModeObserverGains
    sample_s : float
        T [s].
    """

    def __init__(self, gains: SlidingModeObserverGains, sample_s: float) -> None:
        self.sample_s, self.n_trusted = sample_s, len(gains.C) - len(gains.filter_poles_1_s)
        self.A, self.B, self.G_l = (column(family) for family in (gains.A, gains.B, gains.G_l))
        self.C, self.G_n, self.W, self.begin = (column(M) for M in (gains.C, gains.G_n, gains.W, gains.start))
        self.strength = None if gains.strength is None else column(gains.strength)
        # in units of the outputs' sizes S: P_o S^-1 and S K, with eq (14) for a diagonal A22s, 2 a P = -1
        scale = column(gains.output_scale)
        p_o = column([-0.5 / pole for pole in gains.error_pole_1_s]) / scale
        self.injection: Any = injection(gains, k=column(gains.k) * scale, p_o=p_o, sample_s=sample_s)
        self.poles = tuple(column([pole]) for pole in gains.filter_poles_1_s)
        self.states = Layout(
            ObserverState(
                x=len(gains.A[0]), rate=len(gains.A[0]), filtered=tuple(1 for _ in self.poles),
                injection=self.injection.states.shape,
            )
        )  # fmt: skip

    def start(self) -> ObserverState:
        """Nothing seen; it begins with the first sample."""
        return ObserverState(x=0.0, rate=0.0, filtered=tuple(0.0 for _ in self.poles), injection=self.injection.start())

    def step(self, s: ObserverState, y: Rows, u: Rows, rho: Rows, first: Row) -> tuple[ObserverState, Rows]:
        """State, and estimates of the faults in the units of the model, (q, n_cases), at this sample.

        Parameters
        ----------
        y : (p, n_cases) rows
            Outputs, those that are filtered last.
        u : (m, n_cases) rows
        rho : (n_rho, n_cases) rows
        first : (n_cases,) row of booleans
            Whether this is the first sample: then the observer begins with it.
        """
        T = self.sample_s
        suspect = [y[self.n_trusted + i : self.n_trusted + i + 1] for i in range(len(self.poles))]
        z_f = [np.where(first, own, before) for own, before in zip(suspect, s.filtered, strict=True)]
        y_m = np.concatenate([y[: self.n_trusted], *z_f])
        predicted = np.where(first, product(self.begin, y_m), s.x + T * s.rate)
        kept, nu = self.injection.step(s.injection, product(self.C, predicted) - y_m)
        x = predicted + T * product(self.G_n, nu)
        linear = product(affine(self.A, rho), x) + product(affine(self.B, rho), u)
        rate = linear - product(affine(self.G_l, rho), product(self.C, x) - y_m)
        filtered = tuple(z + T * pole * (own - z) for z, own, pole in zip(z_f, suspect, self.poles, strict=True))
        fault = product(self.W, nu)
        if self.strength is not None:
            fault = fault / affine(self.strength, rho)[:, 0]
        return ObserverState(x=x, rate=rate, filtered=filtered, injection=kept), fault

    def constant(self) -> bool:
        """Whether no parameter is looked at."""
        return all(len(family) == 1 for family in (self.A, self.B, self.G_l))
