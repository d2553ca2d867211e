"""Probability of detection against the size of a fault, and the size found in 90 % of flights at 95 % confidence.

A bell curve over the logarithm of the size a, between a floor and a ceiling::

    p(a) = floor + (ceiling - floor) Phi((ln a - m) / s)

Floor and ceiling are 0 and 1 unless the flights want them otherwise (likelihood ratio, 5 % each; on the edge of the parameters
its distribution is half a chi-square). A curve whose ceiling lies below 0.9 has no size that is found in 90 % of flights, and
says so. The upper end of that size is that of the profile likelihood; flights of one run are no independent witnesses, so the
likelihood counts less by the design effect of the residuals by run, at least 1.

References
----------
MIL-HDBK-1823A (2009), Nondestructive evaluation system reliability assessment: hit/miss data, a90/95.
Cheng and Iles (1988), One-sided confidence bands for cumulative distribution functions, Technometrics 30(2): by likelihood.
Self and Liang (1987), Asymptotic properties of maximum likelihood estimators under nonstandard conditions, JASA 82.
Wetherill and Levitt (1965), guess and lapse rates of psychometric functions, Br. J. Math. Stat. Psychol. 18: floor and ceiling.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq, minimize
from scipy.special import ndtr, ndtri

from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats

__all__ = ["LEAST", "DetectionCurve", "detection_curve"]

LEAST = 20
"""Flights below which nothing is said."""
_SHARE = 0.9
_ONE_SIDED_95, _BOUNDARY_5 = 2.7055, 2.7055
"""Chi-square of one degree of freedom at 0.90: a one-sided 95 %, and the 5 % of half a chi-square."""
_TINY = 1e-12
_STEEPEST = 1e-3
"""s stays above it [-]: a step between two sizes flown is as good as any steeper one."""


@dataclass(frozen=True, kw_only=True)
class DetectionCurve:
    """A fitted curve.

    Attributes
    ----------
    flights, found, runs : int
        What it stands on.
    floor, ceiling : float
        Shares of the smallest and the largest faults [-]; 0 and 1 where the flights do not want them otherwise.
    middle, spread : float
        exp(m), in the unit of the size, and s [-].
    size_50, size_90 : float or None
        Sizes found in 50 and 90 % of flights; None where the curve never is there.
    size_90_95 : float or None
        Upper end of `size_90` at 95 % confidence; None: the flights do not exclude that 90 % are never found.
    design_effect : float
        By how much flights of one run tell less [-].
    """

    flights: int
    found: int
    runs: int
    floor: float
    ceiling: float
    middle: float
    spread: float
    size_50: float | None
    size_90: float | None
    size_90_95: float | None
    design_effect: float

    def share(self, size: npt.ArrayLike) -> Floats:
        """Probability of detection of these sizes [-]."""
        x = (np.log(np.asarray(size, dtype=np.float64)) - np.log(self.middle)) / self.spread
        found: Floats = self.floor + (self.ceiling - self.floor) * ndtr(x)
        return found


def detection_curve(size: npt.ArrayLike, found: npt.ArrayLike, run: Any) -> DetectionCurve:
    """Curve fitted to flights.

    Parameters
    ----------
    size : (n,) array
        Size of the fault in each flight, above 0, in any unit.
    found : (n,) array of bool
        Whether it was found.
    run : (n,) array
        Run of each flight, any labels.

    Raises
    ------
    FddbenchError
        Fewer than `LEAST` flights, fewer than three sizes, or a size that is not above 0.
    """
    a, y, label = np.asarray(size, dtype=np.float64), np.asarray(found, dtype=np.float64), np.asarray(run)
    sizes = np.unique(a)
    if len(a) < LEAST or len(sizes) < 3 or sizes[0] <= 0.0:
        raise FddbenchError(
            f"a detection curve needs {LEAST} or more flights of three or more sizes above 0, got {len(a)} flights, "
            f"{len(sizes)} sizes from {sizes[0] if len(sizes) else 0:g}"
        )
    fit = _chosen(_Flights(np.log(a), y))
    effect = _design_effect(y, fit.share(np.log(a)), label)
    return DetectionCurve(
        flights=len(a), found=int(y.sum()), runs=len(np.unique(label)), floor=fit.floor, ceiling=fit.ceiling,
        middle=float(np.exp(fit.m)), spread=fit.s, size_50=fit.size_at(0.5), size_90=fit.size_at(_SHARE),
        size_90_95=_upper_end(fit, effect), design_effect=effect,
    )  # fmt: skip


class _Flights:
    """Flights of one logarithm of size together: hits of trials."""

    def __init__(self, x: Floats, y: Floats) -> None:
        self.x, place = np.unique(x, return_inverse=True)
        self.n = np.bincount(place).astype(np.float64)
        self.k = np.bincount(place, weights=y)
        self.span = float(self.x[-1] - self.x[0])

    def log_likelihood(self, share: Floats) -> float:
        p = np.clip(share, _TINY, 1.0 - _TINY)
        return float(np.sum(self.k * np.log(p) + (self.n - self.k) * np.log1p(-p)))


@dataclass(frozen=True)
class _Fit:
    """Curve of greatest likelihood of one kind, and that likelihood."""

    flights: _Flights
    floored: bool
    capped: bool
    m: float
    s: float
    floor: float
    ceiling: float
    log_likelihood: float

    def share(self, x: Floats) -> Floats:
        found: Floats = _share(x, self.m, self.s, self.floor, self.ceiling)
        return found

    def size_at(self, share: float) -> float | None:
        """Size at which the curve is there, None where it never is."""
        if not self.floor < share < self.ceiling:
            return None
        return float(np.exp(self.m + self.s * ndtri((share - self.floor) / (self.ceiling - self.floor))))


def _share(x: Floats, m: float, s: float, floor: float, ceiling: float) -> Floats:
    found: Floats = floor + (ceiling - floor) * ndtr((x - m) / s)
    return found


def _chosen(flights: _Flights) -> _Fit:
    """The plainest curve that the flights do not contradict."""
    best = _fitted(flights, floored=False, capped=False)
    for floored, capped in ((False, True), (True, False), (True, True)):
        own = _fitted(flights, floored=floored, capped=capped)
        more = int(floored) + int(capped) - int(best.floored) - int(best.capped)
        gained = 2.0 * (own.log_likelihood - best.log_likelihood)
        if gained > _BOUNDARY_5 * more:
            best = own
    return best


def _fitted(flights: _Flights, *, floored: bool, capped: bool) -> _Fit:
    """Curve of greatest likelihood, from several beginnings."""

    def unpack(z: Floats) -> tuple[float, float, float, float]:
        rest = list(z[2:])
        floor = float(0.9 * _logistic(rest.pop(0))) if floored else 0.0
        ceiling = float(floor + (1.0 - floor) * _logistic(rest.pop(0))) if capped else 1.0
        return float(z[0]), float(_STEEPEST + np.exp(z[1])), floor, ceiling

    found = _least(flights, unpack, extra=[-2.0] * floored + [2.0] * capped)
    m, s, floor, ceiling = unpack(found.x)
    return _Fit(flights, floored, capped, m, s, floor, ceiling, -float(found.fun))


def _least(flights: _Flights, unpack: Callable[[Floats], tuple[float, ...]], *, extra: list[float]) -> Any:
    """Best of several searches."""

    def cost(z: Floats) -> float:
        return -flights.log_likelihood(_share(flights.x, *unpack(z)))

    low, high = flights.x[0] - 3.0 * flights.span, flights.x[-1] + 3.0 * flights.span
    bounds = [(low, high), (np.log(1e-3), np.log(10.0 * flights.span)), *[(-9.0, 9.0)] * len(extra)]
    begins = [
        [float(np.quantile(flights.x, q)), np.log(width * flights.span), *extra]
        for q in (0.2, 0.5, 0.8)
        for width in (0.05, 0.3)
    ]
    found = [minimize(cost, begin, method="L-BFGS-B", bounds=bounds) for begin in begins]
    return min(found, key=lambda one: float(one.fun))


def _logistic(z: float) -> float:
    return float(1.0 / (1.0 + np.exp(-z)))


def _design_effect(y: Floats, p: Floats, run: npt.NDArray[Any]) -> float:
    """Variance of the residuals summed by run over that of independent flights, at least 1."""
    _, place = np.unique(run, return_inverse=True)
    sums = np.bincount(place, weights=y - p)
    expected = float(np.sum(np.clip(p * (1.0 - p), 1e-9, None)))
    return max(1.0, float(np.sum(sums**2)) / expected)


def _upper_end(fit: _Fit, effect: float) -> float | None:
    """Largest size at 90 % that the flights do not exclude; None where they do not exclude that there is none."""
    flights, least = fit.flights, fit.log_likelihood - 0.5 * _ONE_SIDED_95 * effect
    at = fit.size_at(_SHARE)
    if at is None:
        return None

    def excess(x90: float) -> float:
        return _profile(fit, x90) - least

    begin, far = float(np.log(at)), float(np.log(at))
    while excess(far) > 0.0:
        far += 0.5 * flights.span
        if far > flights.x[-1] + 3.0 * flights.span:
            return None
    return float(np.exp(brentq(excess, begin, far, xtol=1e-3))) if far > begin else at


def _profile(fit: _Fit, x90: float) -> float:
    """Greatest likelihood of a curve of the same kind that is at 90 % there."""

    def unpack(z: Floats) -> tuple[float, float, float, float]:
        rest = list(z[1:])
        floor = float(0.89 * _logistic(rest.pop(0))) if fit.floored else 0.0
        ceiling = float(_SHARE + (1.0 - _SHARE) * _logistic(rest.pop(0))) if fit.capped else 1.0
        s = float(_STEEPEST + np.exp(z[0]))
        return x90 - s * float(ndtri((_SHARE - floor) / (ceiling - floor))), s, floor, ceiling

    def cost(z: Floats) -> float:
        return -fit.flights.log_likelihood(_share(fit.flights.x, *unpack(z)))

    extra = [-2.0] * fit.floored + [1.0] * fit.capped
    bounds = [(np.log(1e-3), np.log(10.0 * fit.flights.span)), *[(-9.0, 9.0)] * len(extra)]
    begins = [[np.log(width * fit.flights.span), *extra] for width in (0.05, 0.3)] + [
        [np.log(max(fit.s, 2e-3)), *extra]
    ]
    return max(-float(minimize(cost, begin, method="L-BFGS-B", bounds=bounds).fun) for begin in begins)
