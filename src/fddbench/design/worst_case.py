"""The worst H∞ norm that sampling and climbing find over a set of closed loops; it comes close to γ from below."""

from dataclasses import dataclass

import numpy as np

from fddbench.design.norms import hinf_norm
from fddbench.design.problem import ClosedLoop
from fddbench.design.search import Fraction, climb
from fddbench.design.uncertainty import Block, sample_delta
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["WorstCase", "hull_members", "worst_delta", "worst_vertex_mix"]


@dataclass(frozen=True, kw_only=True)
class WorstCase:
    """The worst member found.

    Attributes
    ----------
    norm : float
        Its H∞ norm [-], exact for that member.
    frequency : float
        Where it is reached [rad/s].
    member : array
        Δ, (n_w, n_z), or the coordinates in the hull, (n_vertices,).
    sampled_norm : float
        Largest norm among the samples alone [-].
    n_sampled : int
        Number of samples.
    """

    norm: float
    frequency: float
    member: Floats
    sampled_norm: float
    n_sampled: int


def worst_delta(
    loop: ClosedLoop, blocks: tuple[Block, ...], *, n_samples: int = 1000, n_climbs: int = 8, seed: int = 0
) -> WorstCase:
    """Worst ‖T‖∞ over Δ: exact norms of the samples, then climbs from the worst of them and from 0 and ∞ rad/s.

    Parameters
    ----------
    loop : ClosedLoop
    blocks : tuple of Block
        Structure of Δ.
    n_samples, n_climbs : int
        Draws of Δ, and how many of the worst start a climb.
    seed : int
        Of the draws.
    """
    deltas = sample_delta(blocks, n_samples, seed)
    gains = [hinf_norm(loop.at(delta), tolerance=1e-4) for delta in deltas]
    order = np.argsort([-gain.value for gain in gains])
    sharp = hinf_norm(loop.at(deltas[order[0]]))
    worst = WorstCase(
        norm=sharp.value,
        frequency=sharp.frequency,
        member=deltas[order[0]],
        sampled_norm=sharp.value,
        n_sampled=n_samples,
    )
    starts = [(deltas[i], gains[i].frequency) for i in order[:n_climbs]]
    starts += [(deltas[i], frequency) for i in order[:2] for frequency in (0.0, np.inf)]
    for delta, frequency in starts:
        found = _ascend(loop, blocks, delta, frequency)
        if found[1] > worst.norm:
            worst = WorstCase(
                norm=found[1], frequency=found[2], member=found[0], sampled_norm=worst.sampled_norm, n_sampled=n_samples
            )
    return worst


def _ascend(
    loop: ClosedLoop, blocks: tuple[Block, ...], delta: Floats, frequency: float
) -> tuple[Floats, float, float]:
    """Climb in Δ at the peak, move to the new peak, and again; Δ, norm, frequency."""
    norm = 0.0
    for _ in range(20):
        delta, _gain = climb(_fraction(loop, frequency), blocks, delta)
        peak = hinf_norm(loop.at(delta))
        if peak.value <= norm * (1.0 + 1e-9):
            break
        norm, frequency = peak.value, peak.frequency
    return delta, norm, frequency


def _fraction(loop: ClosedLoop, frequency: float) -> Fraction:
    """Response of the closed loop at one frequency as a function of Δ."""
    n_r, n_v = loop.D.shape
    whole = loop.system().at(frequency)
    return Fraction(whole[:n_r, :n_v], whole[:n_r, n_v:], whole[n_r:, :n_v], whole[n_r:, n_v:])


def hull_members(loops: tuple[ClosedLoop, ...], mixes: Floats) -> list[StateSpace]:
    """Return closed loops at convex combinations of the vertices, (n, n_vertices); they are affine in the plant."""
    stacked = [np.array([getattr(loop, name) for loop in loops]) for name in "ABCD"]
    return [StateSpace(*(np.tensordot(mix, matrices, 1) for matrices in stacked)) for mix in mixes]


def worst_vertex_mix(loops: tuple[ClosedLoop, ...], *, n_samples: int = 1000, seed: int = 0) -> WorstCase:
    """Worst ‖T‖∞ over a hull: all vertices, mixes of a few of them, then steps from the worst towards every vertex."""
    n, random = len(loops), np.random.default_rng(seed)
    mixes = np.vstack([np.eye(n), random.dirichlet(np.full(n, 0.3), max(n_samples - n, 0))])
    gains = [hinf_norm(member, tolerance=1e-4) for member in hull_members(loops, mixes)]
    best = int(np.argmax([gain.value for gain in gains]))
    mix, sampled = mixes[best], gains[best].value
    norm, fit = sampled, 0.5
    while fit > 1e-2:
        trials = (1.0 - fit) * mix + fit * np.eye(n)
        values = [hinf_norm(member, tolerance=1e-6).value for member in hull_members(loops, trials)]
        if max(values) > norm:
            mix, norm = trials[int(np.argmax(values))], max(values)
        else:
            fit *= 0.5
    peak = hinf_norm(hull_members(loops, mix[None])[0])
    return WorstCase(norm=peak.value, frequency=peak.frequency, member=mix, sampled_norm=sampled, n_sampled=len(mixes))
