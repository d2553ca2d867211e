"""Detectability of faults to the test that knows the model, the fault and its time, by a Kalman filter's whitening.

Two hypotheses differ in the mean of what is measured by a known Δ, and in nothing else: the covariance S is that of the noise
and of the state that nobody knows. Then ``d^2 = Δᵀ S^-1 Δ``, and no test does better than the one that compares the measured
numbers, whitened, with Δ. The innovations of the Kalman filter are that whitening: fed with Δ alone it gives the mean of the
innovations ν, and ``d^2`` is the sum of ``νᵀ V^-1 ν`` over the samples with their covariances V.

**What a fault must be told from.** From health, and, where some sensors measure the same quantity, from the mirrored fault: if
sensor i is faulty by f_i and the others agree with the hypothesis, "sensor i is right and all others are off by -f_i" explains
the differences of the sensors as well. Between these two Δ is f_i on every one of them: only the model of the aircraft tells
one from the other. The nearest of these hypotheses counts.

References
----------
Kay (1998), Fundamentals of Statistical Signal Processing: Detection Theory, section 4.4: the generalised matched filter.
Basseville and Nikiforov (1993), Detection of Abrupt Changes, section 7.2: additive changes in state-space models.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fddbench.interfaces import Floats, IdealModel

__all__ = ["MOST_D", "Faults", "detectability"]

MOST_D = 100.0
"""Where every flight has come so far the sum is ended: P_D is one to many digits [-]."""
_CONVERGED = 1e-10


@dataclass(frozen=True, kw_only=True, eq=False)
class Faults:
    """What the faults of some flights add, from their first faulty samples on.

    Attributes
    ----------
    added : mapping of str to (n_time, n_cases) arrays
        By faulty site, in its unit; 0 after the end of a flight's window.
    before : (n_cases,) array
        Samples before the first faulty one.
    """

    added: Mapping[str, Floats]
    before: Floats


def detectability(model: IdealModel, faults: Faults) -> tuple[Floats, Floats]:
    """Distances d [-] from health, and from the nearest hypothesis, (n_cases,) each; at most `MOST_D`.

    Only the sites on which the model says where a fault enters are seen; a fault on others has d = 0.
    """
    deltas = _differences(model, faults.added)
    squares = _squares(model, deltas, faults)
    d: Floats = np.minimum(np.sqrt(squares), MOST_D)
    return d[:, 0], d.min(axis=1)


def _differences(model: IdealModel, added: Mapping[str, Floats]) -> list[dict[str, Floats]]:
    """What is added on each site, hypothesis by hypothesis: against health first, then against the mirrored faults."""
    found = [dict(added)]
    for group in model.together:
        found += [dict.fromkeys(group, added[site]) for site in group if site in added]
    return found


def _squares(model: IdealModel, deltas: list[dict[str, Floats]], faults: Faults) -> Floats:
    """d^2 by flight and hypothesis, (n_cases, n_hypotheses)."""
    P = _before(model, faults.before)
    n_time, n_cases = next(iter(faults.added.values())).shape
    e = np.zeros(
        (n_cases, model.A.shape[1], len(deltas))
    )  # what the filter has taken up of Δ, less what has entered the state
    found = np.zeros((n_cases, len(deltas)))
    kept: tuple[Floats, Floats] | None = None
    for k in range(n_time):
        seen, entering = _at(model, deltas, k)
        if kept is None:
            V, K, after = _update(model, P)
            weight = np.asarray(np.linalg.inv(V), dtype=np.float64)
            if _settled(P, after):
                kept = K, weight
            P = after
        nu = seen - model.C @ e
        found += np.einsum("cyh,cyz,czh->ch", nu, weight, nu)
        e = model.A @ (e + K @ nu) - entering
        if (found.min(axis=1) >= MOST_D**2).all():
            break
    return found


def _at(model: IdealModel, deltas: list[dict[str, Floats]], k: int) -> tuple[Floats, Floats]:
    """What Δ adds to the outputs and to the next state at sample k, (n_cases, rows, n_hypotheses)."""
    n_cases, n_y, n = model.C.shape
    seen, entering = np.zeros((n_cases, n_y, len(deltas))), np.zeros((n_cases, n, len(deltas)))
    for h, delta in enumerate(deltas):
        for site, values in delta.items():
            if site in model.outputs:
                seen[:, model.outputs[site], h] += values[k]
            if site in model.states:
                entering[:, :, h] += model.states[site] * values[k][:, np.newaxis]
    return seen, entering


def _before(model: IdealModel, before: Floats) -> Floats:
    """Covariance of the predicted state at the first faulty sample of each flight, (n_cases, n, n)."""
    P, found = model.start, model.start.copy()
    for k in range(1, int(before.max(initial=0.0)) + 1):
        after = _update(model, P)[2]
        found = np.where((before >= k)[:, np.newaxis, np.newaxis], after, found)
        if _settled(P, after):
            break
        P = after
    return found


def _settled(P: Floats, after: Floats) -> bool:
    """Whether a covariance stands still, each entry beside the sizes of its own two states: units differ by far."""
    size = np.sqrt(np.diagonal(after, axis1=1, axis2=2))
    return bool((np.abs(after - P) <= _CONVERGED * size[:, :, np.newaxis] * size[:, np.newaxis]).all())


def _update(model: IdealModel, P: Floats) -> tuple[Floats, Floats, Floats]:
    """Covariance of the innovation, gain, and covariance of the state predicted for the next sample."""
    CP = model.C @ P
    V = CP @ model.C.transpose(0, 2, 1) + model.R
    K: Floats = np.asarray(np.linalg.solve(V, CP), dtype=np.float64).transpose(0, 2, 1)
    rest = P - K @ CP
    after = model.A @ rest @ model.A.transpose(0, 2, 1) + model.Q
    return V, K, 0.5 * (after + after.transpose(0, 2, 1))
