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

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq
from scipy.special import ndtr

from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats
from fddbench.metrics.bell_curve import SHARE, Fit, Flights, chosen, profile

__all__ = ["LEAST", "DetectionCurve", "detection_curve"]

LEAST = 20
"""Flights below which nothing is said."""
_ONE_SIDED_95 = 2.7055
"""Chi-square of one degree of freedom at 0.90."""


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
    fit = chosen(Flights(np.log(a), y))
    effect = _design_effect(y, fit.share(np.log(a)), label)
    return DetectionCurve(
        flights=len(a), found=int(y.sum()), runs=len(np.unique(label)), floor=fit.floor, ceiling=fit.ceiling,
        middle=float(np.exp(fit.m)), spread=fit.s, size_50=fit.size_at(0.5), size_90=fit.size_at(SHARE),
        size_90_95=_upper_end(fit, effect), design_effect=effect,
    )  # fmt: skip


def _design_effect(y: Floats, p: Floats, run: npt.NDArray[Any]) -> float:
    """Variance of the residuals summed by run over that of independent flights, at least 1."""
    _, place = np.unique(run, return_inverse=True)
    sums = np.bincount(place, weights=y - p)
    expected = float(np.sum(np.clip(p * (1.0 - p), 1e-9, None)))
    return max(1.0, float(np.sum(sums**2)) / expected)


def _upper_end(fit: Fit, effect: float) -> float | None:
    """Largest size at 90 % that the flights do not exclude; None where they do not exclude that there is none."""
    flights, least = fit.flights, fit.log_likelihood - 0.5 * _ONE_SIDED_95 * effect
    at = fit.size_at(SHARE)
    if at is None:
        return None

    def excess(x90: float) -> float:
        return profile(fit, x90) - least

    begin, far = float(np.log(at)), float(np.log(at))
    while excess(far) > 0.0:
        far += 0.5 * flights.span
        if far > flights.x[-1] + 3.0 * flights.span:
            return None
    return float(np.exp(brentq(excess, begin, far, xtol=1e-3))) if far > begin else at
