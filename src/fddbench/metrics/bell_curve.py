"""The search for the bell curve of greatest likelihood over the logarithm of a size, between a floor and a ceiling.

Gradients are those of the formula. A search begins at the best of some widths and ends at three places, and at the best step
between two sizes: where few flights lie on its slope, a steep curve is a hollow of its own.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import minimize
from scipy.special import ndtr, ndtri

from fddbench.interfaces import Floats

__all__ = ["SHARE", "Fit", "Flights", "chosen", "profile"]

SHARE = 0.9
"""Share found at which a size is told [-]."""
_BOUNDARY_5 = 2.7055
"""Chi-square of one degree of freedom at 0.90: the 5 % of half a chi-square."""
_TINY = 1e-12
_MOST_SIZES = 500
"""Sizes that are told apart; of more those in a band of 0.2 % of their span are one."""
_STEEPEST = 1e-3
"""s stays above it [-]: a step between two sizes flown is as good as any steeper one."""


class Flights:
    """Flights of one logarithm of size together: hits of trials; of very many sizes those of a narrow band, at their mean."""

    def __init__(self, x: Floats, y: Floats) -> None:
        sizes, place = np.unique(x, return_inverse=True)
        self.span = float(sizes[-1] - sizes[0])
        if len(sizes) > _MOST_SIZES:
            place = np.minimum(((x - sizes[0]) / self.span * _MOST_SIZES).astype(np.int64), _MOST_SIZES - 1)
            place = np.unique(place, return_inverse=True)[1]
        self.n = np.bincount(place).astype(np.float64)
        self.k = np.bincount(place, weights=y).astype(np.float64)
        self.x = np.bincount(place, weights=x) / self.n

    def log_likelihood(self, share: Floats) -> float:
        """Of shares found at each size, (n_sizes,)."""
        return float(np.sum(_binomial(self.k, self.n, share)))

    def slopes(self, share: Floats, by: list[Floats]) -> Floats:
        """Gradient of the likelihood, of those of the share by each coordinate."""
        p = np.clip(share, _TINY, 1.0 - _TINY)
        steep = np.where(p == share, self.k / p - (self.n - self.k) / (1.0 - p), 0.0)
        return np.array([float(np.sum(steep * each)) for each in by])


@dataclass(frozen=True)
class Fit:
    """Curve of greatest likelihood of one kind, and that likelihood."""

    flights: Flights
    floored: bool
    capped: bool
    m: float
    s: float
    floor: float
    ceiling: float
    log_likelihood: float

    def share(self, x: Floats) -> Floats:
        """Share found at logarithms of sizes [-]."""
        return _bell(x, self.m, self.s, self.floor, self.ceiling)[2]

    def size_at(self, share: float) -> float | None:
        """Size at which the curve is there, None where it never is."""
        if not self.floor < share < self.ceiling:
            return None
        return float(np.exp(self.m + self.s * ndtri((share - self.floor) / (self.ceiling - self.floor))))


def chosen(flights: Flights) -> Fit:
    """The plainest curve that the flights do not contradict."""
    best = _fitted(flights, floored=False, capped=False)
    for floored, capped in ((False, True), (True, False), (True, True)):
        own = _fitted(flights, floored=floored, capped=capped)
        more = int(floored) + int(capped) - int(best.floored) - int(best.capped)
        gained = 2.0 * (own.log_likelihood - best.log_likelihood)
        if gained > _BOUNDARY_5 * more:
            best = own
    return best


def _fitted(flights: Flights, *, floored: bool, capped: bool) -> Fit:
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
    found = _least(flights, cost, ends, _step(flights, floored=floored, capped=capped))
    (m, s), (floor, cap, _) = _middle(found.x), _ends(found.x[2:], floored, capped, 0.9)
    return Fit(flights, floored, capped, m, s, floor, floor + (1.0 - floor) * cap, -float(found.fun))


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


def _step(flights: Flights, *, floored: bool, capped: bool) -> list[float]:
    """Where the best step between two neighbouring sizes is, as the middle of a curve, and its free ends as coordinates."""
    below, n_below = np.cumsum(flights.k)[:-1], np.cumsum(flights.n)[:-1]
    above, n_above = np.sum(flights.k) - below, np.sum(flights.n) - n_below
    low = below / n_below if floored else np.zeros(len(below))
    high = above / n_above if capped else np.ones(len(below))
    likelihood = _binomial(below, n_below, low) + _binomial(above, n_above, high)
    at = int(np.argmax(np.where(high > low, likelihood, -np.inf)))
    ends = [_logit(low[at] / 0.9)] * floored + [_logit((high[at] - low[at]) / max(1.0 - low[at], _TINY))] * capped
    return [float(flights.x[at] + flights.x[at + 1]) / 2.0, *ends]


def _least(flights: Flights, cost: Cost, extra: list[list[float]], step: list[float]) -> Any:
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
    begins.append(np.array([step[0], np.log(0.02 * flights.span), *step[1:]]))
    found = [minimize(cost, begin, jac=True, method="L-BFGS-B", bounds=bounds) for begin in begins]
    return min(found, key=lambda one: float(one.fun))


def _binomial(k: Floats, n: Floats, share: Floats) -> Floats:
    """Logarithm of the likelihood of k hits of n, but for what does not depend on the share."""
    p = np.clip(share, _TINY, 1.0 - _TINY)
    found: Floats = k * np.log(p) + (n - k) * np.log1p(-p)
    return found


def _logistic(z: float) -> float:
    return float(1.0 / (1.0 + np.exp(-z)))


def _logit(share: float) -> float:
    """Coordinate of a share, within the bounds of a search."""
    p = min(max(share, 1e-3), 1.0 - 1e-3)
    return float(np.log(p / (1.0 - p)))


def profile(fit: Fit, x90: float) -> float:
    """Greatest likelihood of a curve of the same kind that is at 90 % there."""
    flights = fit.flights

    def cost(z: Floats) -> tuple[float, Floats]:
        s, (floor, cap, rest) = float(_STEEPEST + np.exp(z[0])), _ends(z[1:], fit.floored, fit.capped, 0.89)
        ceiling = SHARE + (1.0 - SHARE) * cap
        wide = ceiling - floor
        q = float(ndtri((SHARE - floor) / wide))
        u, bell, share = _bell(flights.x, x90 - s * q, s, floor, ceiling)
        # q moves the middle, and the ends move q
        stretch = np.sqrt(2.0 * np.pi) * np.exp(0.5 * q * q) / wide**2
        by = [-wide * bell * (u - q) / s * (s - _STEEPEST)]
        if fit.floored:
            by.append((1.0 - ndtr(u) + wide * bell * stretch * (SHARE - ceiling)) * rest[0])
        if fit.capped:
            by.append((ndtr(u) - wide * bell * stretch * (SHARE - floor)) * (1.0 - SHARE) * rest[-1])
        return -flights.log_likelihood(share), -flights.slopes(share, by)

    extra = [-2.0] * fit.floored + [1.0] * fit.capped
    bounds = [(np.log(1e-3), np.log(10.0 * flights.span)), *[(-9.0, 9.0)] * len(extra)]
    begins = [[np.log(width * flights.span), *extra] for width in (0.05, 0.3)] + [[np.log(max(fit.s, 2e-3)), *extra]]
    if fit.capped:  # a ceiling just above 90 % is a hollow of its own
        own = [*([_logit(fit.floor / 0.89)] * fit.floored), -6.0]
        begins += [[np.log(width * flights.span), *own] for width in (0.05, 0.15)]
    return max(-float(minimize(cost, each, jac=True, method="L-BFGS-B", bounds=bounds).fun) for each in begins)
