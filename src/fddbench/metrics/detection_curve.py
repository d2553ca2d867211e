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
_MOST_SIZES = 500
"""Sizes that are told apart; of more those in a band of 0.2 % of their span are one."""
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
    """Flights of one logarithm of size together: hits of trials; of very many sizes those of a narrow band, at their mean."""

    def __init__(self, x: Floats, y: Floats) -> None:
        sizes, place = np.unique(x, return_inverse=True)
        self.span = float(sizes[-1] - sizes[0])
        if len(sizes) > _MOST_SIZES:
            place = np.minimum(((x - sizes[0]) / self.span * _MOST_SIZES).astype(np.int64), _MOST_SIZES - 1)
            place = np.unique(place, return_inverse=True)[1]
        self.n = np.bincount(place).astype(np.float64)
        self.k = np.bincount(place, weights=y)
        self.x = np.bincount(place, weights=x) / self.n

    def log_likelihood(self, share: Floats) -> float:
        p = np.clip(share, _TINY, 1.0 - _TINY)
        return float(np.sum(self.k * np.log(p) + (self.n - self.k) * np.log1p(-p)))

    def slopes(self, share: Floats, by: list[Floats]) -> Floats:
        """Gradient of the likelihood, of those of the share by each coordinate."""
        p = np.clip(share, _TINY, 1.0 - _TINY)
        steep = np.where(p == share, self.k / p - (self.n - self.k) / (1.0 - p), 0.0)
        return np.array([float(np.sum(steep * each)) for each in by])


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

    def cost(z: Floats) -> tuple[float, Floats]:
        (m, s), (floor, cap, rest) = _middle(z), _ends(z[2:], floored, capped, 0.9)
        wide = (1.0 - floor) * cap
        u, bell, share = _bell(flights.x, m, s, floor, floor + wide)
        by = [-wide * bell / s, -wide * bell * u / s * (s - _STEEPEST)]
        if floored:
            by.append((1.0 - cap * ndtr(u)) * rest[0])
        if capped:
            by.append((1.0 - floor) * ndtr(u) * rest[-1])
        return -flights.log_likelihood(share), -flights.slopes(share, by)

    ends = [
        [low] * floored + [high] * capped for low in ((-2.0, 0.0)[: 1 + floored]) for high in ((2.0, 0.0)[: 1 + capped])
    ]
    found = _least(flights, cost, extra=ends)
    (m, s), (floor, cap, _) = _middle(found.x), _ends(found.x[2:], floored, capped, 0.9)
    return _Fit(flights, floored, capped, m, s, floor, floor + (1.0 - floor) * cap, -float(found.fun))


Cost = Callable[[Floats], tuple[float, Floats]]
"""Of coordinates of a search: what is to be least, and its gradient."""


def _middle(z: Floats) -> tuple[float, float]:
    """Place m and width s of the first two coordinates."""
    return float(z[0]), float(_STEEPEST + np.exp(z[1]))


def _ends(z: Floats, floored: bool, capped: bool, highest: float) -> tuple[float, float, list[float]]:
    """Floor, below `highest`; how far the ceiling goes from there to its most; the slopes of those of both that are free."""
    rest, slopes = [_logistic(each) for each in z], []
    floor, cap = 0.0, 1.0
    if floored:
        floor = highest * rest[0]
        slopes.append(floor * (1.0 - rest[0]))
    if capped:
        cap = rest[-1]
        slopes.append(cap * (1.0 - cap))
    return floor, cap, slopes


def _bell(x: Floats, m: float, s: float, floor: float, ceiling: float) -> tuple[Floats, Floats, Floats]:
    """Places u = (x - m) / s, the density of the bell there, and the curve."""
    u = (x - m) / s
    return u, np.exp(-0.5 * u * u) / np.sqrt(2.0 * np.pi), floor + (ceiling - floor) * ndtr(u)


def _least(flights: _Flights, cost: Cost, *, extra: list[list[float]]) -> Any:
    """Best of several searches."""
    low, high = flights.x[0] - 3.0 * flights.span, flights.x[-1] + 3.0 * flights.span
    bounds = [(low, high), (np.log(1e-3), np.log(10.0 * flights.span)), *[(-9.0, 9.0)] * len(extra[0])]
    # at each of three places the best of some widths and ends
    begins = [
        min(
            (
                np.array([place, np.log(width * flights.span), *ends])
                for width in (0.02, 0.05, 0.15, 0.4)
                for ends in extra
            ),
            key=lambda begin: cost(begin)[0],
        )
        for place in np.quantile(flights.x, (0.2, 0.5, 0.8)).tolist()
    ]
    found = [minimize(cost, begin, jac=True, method="L-BFGS-B", bounds=bounds) for begin in begins]
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
    flights = fit.flights

    def cost(z: Floats) -> tuple[float, Floats]:
        s, (floor, cap, rest) = float(_STEEPEST + np.exp(z[0])), _ends(z[1:], fit.floored, fit.capped, 0.89)
        ceiling = _SHARE + (1.0 - _SHARE) * cap
        wide = ceiling - floor
        q = float(ndtri((_SHARE - floor) / wide))
        u, bell, share = _bell(flights.x, x90 - s * q, s, floor, ceiling)
        # q moves the middle, and the ends move q
        stretch = np.sqrt(2.0 * np.pi) * np.exp(0.5 * q * q) / wide**2
        by = [-wide * bell * (u - q) / s * (s - _STEEPEST)]
        if fit.floored:
            by.append((1.0 - ndtr(u) + wide * bell * stretch * (_SHARE - ceiling)) * rest[0])
        if fit.capped:
            by.append((ndtr(u) - wide * bell * stretch * (_SHARE - floor)) * (1.0 - _SHARE) * rest[-1])
        return -flights.log_likelihood(share), -flights.slopes(share, by)

    extra = [-2.0] * fit.floored + [1.0] * fit.capped
    bounds = [(np.log(1e-3), np.log(10.0 * flights.span)), *[(-9.0, 9.0)] * len(extra)]
    begins = [[np.log(width * flights.span), *extra] for width in (0.05, 0.3)] + [[np.log(max(fit.s, 2e-3)), *extra]]
    return max(-float(minimize(cost, each, jac=True, method="L-BFGS-B", bounds=bounds).fun) for each in begins)
