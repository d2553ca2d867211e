"""Inertial units with errors of their own: each gives bank angle, roll rate and yaw rate, late, tilted, rounded and clipped."""

from dataclasses import dataclass
from math import ceil
from typing import Any

import numpy as np

from fddbench.blocks import consumers
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.functions import exp
from fddbench.blocks.layout import Layout, Row, Rows, record
from fddbench.units import RAD_PER_DEG

__all__ = ["Attitude", "InertialErrors", "InertialUnits", "UnitConstants", "UnitDraws", "UnitNormals"]

_CUT_SIGMA = 3.0


@dataclass(frozen=True, kw_only=True)
class InertialErrors:
    """Errors of inertial units that a flight draws once, one sigma each, cut at three; the latency is uniform.

    Attributes
    ----------
    rate_bias_deg_s, rate_scale_percent : float
        Of each yaw-rate and of each roll-rate gyro [deg/s, %].
    misalignment_deg : float
        Tilt of a unit about its lateral axis [deg]: ``p`` enters its yaw rate, ``-r`` its roll rate.
    bank_bias_deg : float
        Of each bank angle [deg].
    rate_quantum_deg_s, bank_quantum_deg : float
        What a reading is a multiple of [deg/s, deg].
    rate_most_deg_s, bank_most_deg : float
        Where a reading is clipped [deg/s, deg].
    latency_s : (float, float)
        Least and largest age of a reading [s], the same for all signals of a unit.
    """

    rate_bias_deg_s: float
    rate_scale_percent: float
    misalignment_deg: float
    bank_bias_deg: float
    rate_quantum_deg_s: float
    bank_quantum_deg: float
    rate_most_deg_s: float
    bank_most_deg: float
    latency_s: tuple[float, float]


@record
class UnitNormals:
    """Standard normals of every unit before the first sample: of the gyros and the tilt, and of bank angle and latency."""

    gyros: tuple[Rows, ...]
    others: tuple[Rows, ...]


@record
class UnitDraws:
    """One normal number a sample for the roll rate and for the bank angle of every unit; those of the yaw rate are others'."""

    p: tuple[Row, ...]
    phi: tuple[Row, ...]


@record
class UnitConstants:
    """Errors of a flight, (n_units, n_cases) each; `weights` of the true value of 0, 1, … samples ago make the latency."""

    r_factor: Rows
    r_bias_deg_s: Rows
    p_factor: Rows
    p_bias_deg_s: Rows
    tilt_rad: Rows
    phi_bias_deg: Rows
    weights: tuple[Rows, ...]


@record
class Attitude:
    """Bank angle [deg], roll and yaw rate [deg/s]: true ones of some samples, newest first, or what units read of them."""

    phi_deg: Any
    p_deg_s: Any
    r_deg_s: Any


class InertialUnits:
    """Units as a block that keeps what they have not shown yet.

    The reading of sample k is ``quantum floor(y / quantum + 1/2)``, clipped, of ``y = (1 + scale) w + bias + noise``. ``w`` is
    the tilted signal of d = latency / sample time samples ago, between two samples on a straight line: the true signals of
    samples k - j with the weights ``max(0, 1 - |d - j|)``. Before sample 0 they are zero, as in level trim.

    Parameters
    ----------
    errors : InertialErrors
        How large they are.
    rate_noise_deg_s, bank_noise_deg : tuple of float
        White noise of yaw and of roll rate, and of the bank angle, one sigma a sample [deg/s, deg].
    n_units : int
        How many units; each has random numbers of its own for good.
    sample_s : float
        Sample time [s].
    """

    def __init__(
        self,
        errors: InertialErrors,
        *,
        rate_noise_deg_s: tuple[float, float],
        bank_noise_deg: float,
        n_units: int,
        sample_s: float,
    ) -> None:
        self.errors, self.n_units, self.sample_s = errors, n_units, sample_s
        self.r_noise_deg_s, self.p_noise_deg_s = rate_noise_deg_s
        self.phi_noise_deg = bank_noise_deg
        # a hair less, so that 0.02 / 0.01 is 2
        self.oldest = max(1, ceil(errors.latency_s[1] / sample_s - 1e-9))
        kept = self.oldest
        self.states = Layout(Attitude(phi_deg=kept, p_deg_s=kept, r_deg_s=kept))
        self.constants = Layout(
            UnitConstants(
                r_factor=n_units, r_bias_deg_s=n_units, p_factor=n_units, p_bias_deg_s=n_units, tilt_rad=n_units,
                phi_bias_deg=n_units, weights=(n_units,) * (1 + self.oldest),
            )
        )  # fmt: skip
        units = range(n_units)
        self.draws: Draws[UnitDraws] = Draws(
            UnitDraws(
                p=tuple(Draw(*consumers.unit_noise_number(j, 0)) for j in units),
                phi=tuple(Draw(*consumers.unit_noise_number(j, 1)) for j in units),
            )
        )
        first = [consumers.UNIT_ERRORS_0 + 2 * j for j in units]
        self.before: Draws[UnitNormals] = Draws(
            UnitNormals(
                gyros=tuple(Draw(number, rows=4) for number in first),
                others=tuple(Draw(number + 1, rows=4) for number in first),
            )
        )

    def prepare(self, normals: UnitNormals) -> UnitConstants:
        """Errors of flights; a latency comes of two normals a and b, for ``exp(-(a a + b b) / 2)`` is uniform."""
        errors, (least_s, most_s) = self.errors, self.errors.latency_s
        gyros, others = np.stack(normals.gyros), np.stack(normals.others)
        of_gyros, of_others = cut(gyros), cut(others)
        uniform = exp(-0.5 * (others[:, 2] * others[:, 2] + others[:, 3] * others[:, 3]))
        ago = (least_s + (most_s - least_s) * uniform) / self.sample_s
        scale = 0.01 * errors.rate_scale_percent
        return UnitConstants(
            r_factor=1.0 + scale * of_gyros[:, 1],
            r_bias_deg_s=errors.rate_bias_deg_s * of_gyros[:, 0],
            p_factor=1.0 + scale * of_gyros[:, 3],
            p_bias_deg_s=errors.rate_bias_deg_s * of_gyros[:, 2],
            tilt_rad=RAD_PER_DEG * errors.misalignment_deg * of_others[:, 0],
            phi_bias_deg=errors.bank_bias_deg * of_others[:, 1],
            weights=tuple(np.maximum(1.0 - np.abs(ago - j), 0.0) for j in range(1 + self.oldest)),
        )

    def start(self, c: UnitConstants) -> Attitude:
        """Level flight before sample 0."""
        del c
        return Attitude(phi_deg=0.0, p_deg_s=0.0, r_deg_s=0.0)

    def step(
        self, x: Attitude, c: UnitConstants, n: UnitDraws, true: Attitude, r_normals: tuple[Row, ...]
    ) -> tuple[Attitude, Attitude]:
        """What is kept for the next sample, and readings, (n_units, n_cases) each; `true` are rows, (n_cases,)."""
        phi, after_phi = _late(true.phi_deg, x.phi_deg, c.weights)
        p, after_p = _late(true.p_deg_s, x.p_deg_s, c.weights)
        r, after_r = _late(true.r_deg_s, x.r_deg_s, c.weights)
        r_deg_s = c.r_factor * (r + c.tilt_rad * p) + c.r_bias_deg_s + self.r_noise_deg_s * np.stack(r_normals)
        p_deg_s = c.p_factor * (p - c.tilt_rad * r) + c.p_bias_deg_s + self.p_noise_deg_s * np.stack(n.p)
        phi_deg = phi + c.phi_bias_deg + self.phi_noise_deg * np.stack(n.phi)
        of_rate = (self.errors.rate_quantum_deg_s, self.errors.rate_most_deg_s)
        of_bank = (self.errors.bank_quantum_deg, self.errors.bank_most_deg)
        readings = Attitude(
            phi_deg=shown(phi_deg, *of_bank), p_deg_s=shown(p_deg_s, *of_rate), r_deg_s=shown(r_deg_s, *of_rate)
        )
        return Attitude(phi_deg=after_phi, p_deg_s=after_p, r_deg_s=after_r), readings


def cut(normals: Rows) -> Rows:
    """Standard normals cut at three sigma.

    >>> cut(np.array([-5.0, 0.5, 3.5]))
    array([-3. ,  0.5,  3. ])
    """
    return np.minimum(np.maximum(normals, -_CUT_SIGMA), _CUT_SIGMA)


def shown(value: Rows, quantum: float, most: float) -> Rows:
    """A value as the nearest multiple of the quantum (of two as near the higher), clipped; a quantum of 0 rounds nothing.

    >>> shown(np.array([-0.2, 0.2, 0.25, 0.75, 9.0]), 0.5, 4.0)
    array([0. , 0. , 0.5, 1. , 4. ])
    """
    # not rint, which makes -0 of a small negative number: adding a fault of size zero would show
    rounded = quantum * np.floor(value * (1.0 / quantum) + 0.5) if quantum else value
    return np.minimum(np.maximum(rounded, -most), most)


def _late(now: Row, past: Rows, weights: tuple[Rows, ...]) -> tuple[Rows, Rows]:
    """What every unit sees of a signal, (n_units, n_cases), and the past of the next sample."""
    taps = [now, *past]
    seen = weights[0] * taps[0]
    for weight, value in zip(weights[1:], taps[1:], strict=True):
        seen = seen + weight * value
    return seen, np.stack(taps[:-1])
