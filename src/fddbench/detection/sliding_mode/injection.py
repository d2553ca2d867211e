"""Three ways to make the injection that holds the output error at zero.

An observer predicts the output error e* and adds T nu to it, T the sample time. Each solves for the error after it: a step
without this solution diverges, or chatters by K at every sample.
"""

from typing import Any, ClassVar, Literal, Protocol

import numpy as np

from fddbench.blocks.block import NOTHING
from fddbench.blocks.layout import Layout, Nothing, Rows, record
from fddbench.blocks.linear import column, total
from fddbench.detection.sliding_mode.gains import TwistingEntry

__all__ = ["Injection", "Numbers", "Sigmoid", "SuperTwisting", "UnitVector", "injection"]


class Numbers(Protocol):
    """What the gains of a kind say of its injection."""

    @property
    def injection(self) -> Literal["sigmoid", "unit_vector", "super_twisting"]:
        """Which one."""
        ...

    @property
    def delta(self) -> float:
        """Smoothing of eq (37)."""
        ...

    @property
    def newton_steps(self) -> int:
        """Iterations, a fixed number."""
        ...

    @property
    def twisting(self) -> TwistingEntry | None:
        """Gains of the super-twisting algorithm."""
        ...


@record
class Integral:
    """z of the super-twisting algorithm."""

    z: Rows


class Sigmoid:
    """``nu = -K P_o e / (|P_o e| + delta)``, eq (37): continuous, its DC gain a little below one.

    With K P_o / delta of 161 to 191 1/s an explicit step diverges above 10.3 ms.
    """

    states: ClassVar[Layout[Any]] = NOTHING

    def __init__(self, gains: Numbers, k: Rows, p_o: Rows, sample_s: float) -> None:
        self.k, self.p_o, self.sample_s = k, p_o, sample_s
        self.delta, self.steps = gains.delta, gains.newton_steps

    def start(self) -> Nothing:
        """Keeps nothing."""
        return Nothing()

    def step(self, x: Nothing, predicted: Rows) -> tuple[Nothing, Rows]:
        """What it keeps (nothing), and nu for the predicted output error, (4, n_cases).

        Newton's method on ``f(s) = |P_o e(s)| - s`` with ``e_i(s) = e*_i (s + delta) / (s + delta + T K_i P_o,i)``, which
        is concave; from the exact solution for equal gains three steps leave 1e-14 at 10 ms and 3e-10 at 40 ms.
        """
        delta, c = self.delta, self.sample_s * self.k * self.p_o
        weighted = self.p_o * predicted
        q = np.sqrt(total(weighted * weighted))
        mean = float(np.mean(c))
        b = q - delta - mean
        s = 0.5 * (b + np.sqrt(b * b + 4.0 * delta * q))
        for _ in range(self.steps):
            wide = s + delta
            share = wide / (wide + c)
            part = weighted * share
            squared = total(part * part)
            norm = np.sqrt(squared)
            slope = total(part * part * c / (wide * (wide + c))) / np.maximum(norm, 1e-300)
            s = np.maximum(s + (norm - s) / (1.0 - slope), 0.0)
        error = predicted * ((s + delta) / (s + delta + c))
        return x, -self.k * self.p_o * error / (s + delta)


class UnitVector:
    """``nu = -K P_o e / |P_o e|``, eq (13), with the set of all ``|K^-1 nu| <= 1`` at e = 0.

    Where that set holds an injection that brings the error to zero within the sample, it is taken, ``nu = -e* / T``: sliding
    is exact and nothing chatters; an explicit step would jump between ±K. The reconstruction has no lag and no DC error,
    and passes the noise that delta smooths.

    References
    ----------
    Acary, Brogliato (2010), Implicit Euler numerical scheme and chattering-free implementation of sliding mode systems,
    Systems & Control Letters 59(5), 284-293.
    """

    states: ClassVar[Layout[Any]] = NOTHING

    def __init__(self, gains: Numbers, k: Rows, p_o: Rows, sample_s: float) -> None:
        self.k, self.p_o, self.sample_s, self.steps = k, p_o, sample_s, gains.newton_steps

    def start(self) -> Nothing:
        """Keeps nothing."""
        return Nothing()

    def step(self, x: Nothing, predicted: Rows) -> tuple[Nothing, Rows]:
        """What it keeps (nothing), and nu for the predicted output error, (4, n_cases).

        With ``e_i = e*_i s / (s + c_i), c = T K P_o``, s = |P_o e| solves ``sum (P_o e*)_i^2 / (s + c_i)^2 = 1``; Newton's
        method on the inverse root of that sum, which is nearly linear in s, from the left of the solution.
        """
        c = self.sample_s * self.k * self.p_o
        weighted = self.p_o * predicted
        s = np.maximum(np.sqrt(total(weighted * weighted)) - float(np.max(c)), 0.0)
        for _ in range(self.steps):
            part = weighted / (s + c)
            squared = total(part * part)
            slope = np.maximum(total(part * part / (s + c)), 1e-300)
            s = np.maximum(s + squared * (np.sqrt(squared) - 1.0) / slope, 0.0)
        return x, -self.k * weighted / (s + c)


class SuperTwisting:
    """``nu = -k1 |e|^1/2 sgn(e) + z, z' = -k2 sgn(e)``, each output by itself: continuous, with e and e' at zero.

    The integral carries the fault, so that its DC gain is one; k2 bounds how fast a fault it can follow, its rate A_f f'.

    References
    ----------
    Levant (1993), Sliding order and sliding accuracy in sliding mode control, International Journal of Control 58(6),
    1247-1263. Brogliato, Polyakov, Efimov (2020), The implicit discretization of the supertwisting sliding-mode control
    algorithm, IEEE Transactions on Automatic Control 65(8), 3707-3713.
    """

    def __init__(self, gains: Numbers, k: Rows, p_o: Rows, sample_s: float) -> None:
        del k, p_o
        assert gains.twisting is not None
        self.k1, self.k2, self.sample_s = column(gains.twisting.k1), column(gains.twisting.k2), sample_s
        self.states: Layout[Any] = Layout(Integral(z=len(self.k1)))

    def start(self) -> Integral:
        """Integral at zero."""
        return Integral(z=0.0)

    def step(self, x: Integral, predicted: Rows) -> tuple[Integral, Rows]:
        """Integral after this sample, and nu, (4, n_cases).

        The error after it solves ``e + T k1 |e|^1/2 sgn(e) + T^2 k2 sgn(e) = e* + T z``, a square of its root.
        """
        T = self.sample_s
        asked = predicted + T * x.z
        beyond = np.abs(asked) - (T * T) * self.k2
        outside = beyond > 0.0
        lead = T * self.k1
        root = 0.5 * (np.sqrt(lead * lead + 4.0 * np.maximum(beyond, 0.0)) - lead)
        sign = np.where(asked < 0.0, -1.0, 1.0)
        error = np.where(outside, sign * root * root, 0.0)
        z = x.z - np.where(outside, T * self.k2 * sign, asked / T)
        return Integral(z=z), (error - predicted) / T


Injection = Sigmoid | UnitVector | SuperTwisting

_KINDS: dict[str, type[Any]] = {"sigmoid": Sigmoid, "unit_vector": UnitVector, "super_twisting": SuperTwisting}


def injection(gains: Numbers, *, k: Rows, p_o: Rows, sample_s: float) -> Injection:
    """The one that a design names, with K and P_o as (p, 1) columns."""
    made: Injection = _KINDS[gains.injection](gains, k, p_o, sample_s)
    return made
