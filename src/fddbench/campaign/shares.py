"""Where in its distribution each run of each parameter lies, 0 to 1: at random, spread evenly, or correlated.

``sobol`` and ``halton`` are low-discrepancy points by the number of the run, each parameter turned by a number of the seed
(Cranley and Patterson): more runs add to the same points. ``lhs`` puts one run into each of as many equal parts of every
distribution as there are runs, in an order of its own: other runs are another sample.

References
----------
Sobol' (1967); Joe and Kuo (2008), direction numbers as of SciPy. Halton (1960).
Cranley and Patterson (1976), Randomization of number theoretic methods for multiple integration, SIAM J. Numer. Anal. 13.
McKay, Beckman, Conover (1979), A comparison of three methods for selecting values of input variables, Technometrics 21(2).
Nelsen (2006), An introduction to copulas, 2nd ed., section 2.3: the Gaussian copula.
"""

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt
from scipy.special import ndtr, ndtri

from fddbench.blocks.consumers import DISPERSION
from fddbench.blocks.philox import normals, uniforms
from fddbench.campaign.rules.dispersions import Distribution, MonteCarlo
from fddbench.campaign.streams import name_word
from fddbench.interfaces import Floats

__all__ = ["correlation_matrix", "drawn_together", "inverse"]

Runs = npt.NDArray[np.int64]

_LEAST = 2.0**-54
"""Nearest to the ends of a distribution that a share comes: a bell curve has no value there."""


def drawn_together(drawn: MonteCarlo, *, key: int, stream: int, runs: Runs) -> dict[str, Floats]:
    """Values of the parameters that are not drawn one by one at random, each (n,): all of an even sample, or the correlated.

    Parameters
    ----------
    key, stream : int
        Seed of the campaign, and stream of its purpose.
    runs : (n,) integers
        Numbers of the runs, from 0.
    """
    even = drawn.sampling != "random"
    names = sorted(drawn.parameters) if even else sorted({name for *pair, _ in drawn.correlation for name in pair})
    if not names or not len(runs):
        return {}
    bells = {
        name: ndtri(share)
        for name, share in (_even(drawn, names, key=key, stream=stream, runs=runs) if even else {}).items()
    } or {name: normals((name_word(name), DISPERSION, runs, stream), key)[0] for name in names}
    mixed = _correlated(bells, drawn.correlation)
    return {name: inverse(drawn.parameters[name], ndtr(mixed[name])) for name in names}


def _even(drawn: MonteCarlo, names: Sequence[str], *, key: int, stream: int, runs: Runs) -> dict[str, Floats]:
    """Shares of an even sample, between 0 and 1."""
    if drawn.sampling == "lhs":
        all_runs = np.arange(drawn.runs)
        counters = {name: (name_word(name), DISPERSION, all_runs, stream) for name in names}
        pairs = {name: uniforms(counter, key)[:2] for name, counter in counters.items()}
        ranks = {name: np.argsort(np.argsort(order, kind="stable")) for name, (order, _) in pairs.items()}
        return {name: _inside(((ranks[name] + pairs[name][1]) / drawn.runs)[runs]) for name in names}
    points = _points(drawn.sampling, len(names), int(runs.max()) + 1)[runs]
    turns = [float(uniforms((name_word(name), DISPERSION, np.array([0]), stream), key)[0][0]) for name in names]
    return {name: _inside((points[:, i] + turns[i]) % 1.0) for i, name in enumerate(names)}


def _points(sampling: str, dimensions: int, least: int) -> Floats:
    """First points of a low-discrepancy sequence, at least so many, (n, dimensions)."""
    from scipy.stats import qmc  # takes as long as a small campaign flies, and few ask for it

    if sampling == "sobol":
        even: Floats = qmc.Sobol(dimensions, scramble=False).random_base2(max(least - 1, 1).bit_length())
        return even
    found: Floats = qmc.Halton(dimensions, scramble=False).random(least)
    return found


def _inside(share: Floats) -> Floats:
    return np.clip(share, _LEAST, 1.0 - _LEAST)


def correlation_matrix(names: Sequence[str], correlation: Sequence[tuple[str, str, float]]) -> Floats:
    """Correlations of bell curves by name, (n, n); what no line names is independent."""
    found = np.eye(len(names))
    for one, other, value in correlation:
        i, j = names.index(one), names.index(other)
        found[i, j] = found[j, i] = value
    return found


def _correlated(bells: Mapping[str, Floats], correlation: Sequence[tuple[str, str, float]]) -> dict[str, Floats]:
    """Independent standard bell curves as correlated ones: each is made of those before it in the alphabet."""
    names = sorted({name for *pair, _ in correlation for name in pair})
    if not names:
        return dict(bells)
    root = np.linalg.cholesky(correlation_matrix(names, correlation))
    mixed = dict(bells)
    for i, name in enumerate(names):
        value = np.zeros_like(bells[name])
        for j in range(i + 1):
            value = value + root[i, j] * bells[names[j]]
        mixed[name] = value
    return mixed


def inverse(distribution: Distribution, share: Floats) -> Floats:
    """Values below which these shares of a distribution lie, in the unit of the parameter.

    >>> inverse(Distribution(uniform=(10.0, 20.0)), np.array([0.25])).tolist()
    [12.5]
    """
    if distribution.uniform is not None:
        low, high = distribution.uniform
        return low + share * (high - low)
    window = distribution.truncated_normal
    bell = window or distribution.normal
    assert bell is not None
    below, above = 0.0, 1.0
    if window is not None:
        below, above = (float(ndtr((edge - bell.mean) / bell.std)) for edge in (window.low, window.high))
    found: Floats = bell.mean + bell.std * ndtri(_inside(below + share * (above - below)))
    return found if window is None else np.clip(found, window.low, window.high)
