"""The recipe of the laws of the aircraft with six degrees of freedom: a regulator at each point, a power law over all of them.

At every point of an envelope a linear-quadratic regulator is designed on the linearised aircraft, weights by Bryson's rule;
each gain then becomes one power law of the dynamic pressure. Delay and actuators are left out of the design and put into the
check: `damping` is that of the sampled loop with both.

References: Bryson, Ho (1975), Applied Optimal Control, section 5.2; Stevens, Lewis, Johnson (2016), Aircraft Control and
Simulation, 3rd edition, section 5.3.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm, solve_continuous_are

from fddbench.benchmarks.yaw_rate.transport.gains import Gains
from fddbench.benchmarks.yaw_rate.transport.law import DELAY_S
from fddbench.flight.atmosphere import FT_M, GRAVITY_M_S2, dynamic_pressure_pa, true_airspeed_m_s
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.body import body_of
from fddbench.flight.transport.linear import LATERAL, linearised
from fddbench.flight.transport.trim import trim
from fddbench.interfaces import Floats
from fddbench.units import RAD_PER_DEG

__all__ = ["Axis", "Point", "Weights", "axes", "damping", "points", "power_laws", "regulators", "scheduled"]

REFERENCE_PA = 12960.0


@dataclass(frozen=True, kw_only=True)
class Weights:
    """What is tolerated, by Bryson's rule.

    Attributes
    ----------
    bank_deg, sideslip_deg, roll_rate_deg_s, yaw_rate_deg_s, bank_integral_deg_s, roll_deg, rudder_deg : float
        Lateral; the yaw rate counts by what it is off a coordinated turn.
    load_factor_g, pitch_rate_deg_s, load_factor_integral_g_s, elevator_deg : float
        Longitudinal; the pitch rate counts by what it is off a steady pull.
    """

    bank_deg: float = 5.0
    sideslip_deg: float = 2.0
    roll_rate_deg_s: float = 15.0
    yaw_rate_deg_s: float = 1.5
    bank_integral_deg_s: float = 8.0
    roll_deg: float = 6.0
    rudder_deg: float = 2.0
    load_factor_g: float = 0.3
    pitch_rate_deg_s: float = 2.0
    load_factor_integral_g_s: float = 0.3
    elevator_deg: float = 2.0


class Axis(NamedTuple):
    """A plant for the regulator: ``xdot = A x + B u``; the law feeds back ``T x`` with its own gains."""

    A: Floats
    B: Floats
    T: Floats


class Point(NamedTuple):
    """Both axes at a point, and its dynamic pressure [Pa]."""

    lateral: Axis
    longitudinal: Axis
    pressure_pa: float


def points(aircraft: Aircraft, condition: Floats, deltas: Mapping[str, Floats] | None = None) -> list[Point]:
    """Linear plants of flight conditions.

    Parameters
    ----------
    condition : (4, n) array
        Mass [kg], centre of gravity [-], altitude [ft], calibrated airspeed [kt].
    deltas : mapping of str to (n,) arrays, optional
        Changes of the total coefficients [-], as `body_of` takes them.
    """
    mass, x_cg, altitude, v_cas = condition
    body = body_of(aircraft, mass, x_cg, deltas)
    at = trim(aircraft, body, true_airspeed_m_s(v_cas, altitude), altitude * FT_M)
    linear = linearised(aircraft, body, at)
    side = linear.part(LATERAL, ("rudder", "aileron_1", "aileron_3"))
    plane = linear.part(("w", "q"), ("elevator",))
    pressure = dynamic_pressure_pa(v_cas, altitude)
    found = []
    for i, (v, alpha) in enumerate(zip(at.v_tas_m_s.tolist(), at.alpha_rad.tolist(), strict=True)):
        lateral, longitudinal = axes(
            (side[0][..., i], side[1][..., i]), (plane[0][..., i], plane[1][..., i]), v, v * np.cos(alpha)
        )
        found.append(Point(lateral, longitudinal, float(pressure[i])))
    return found


def axes(
    side: tuple[Floats, Floats], plane: tuple[Floats, Floats], v_tas_m_s: float, u_m_s: float
) -> tuple[Axis, Axis]:
    """Lateral axis, x = (bank, sideslip, p, r, integral of the bank), and longitudinal one, x = (w, q, integral of n)."""
    turn = GRAVITY_M_S2 / v_tas_m_s
    scale = np.diag([1.0, 1.0 / v_tas_m_s, 1.0, 1.0])
    A, B = np.zeros((5, 5)), np.zeros((5, 2))
    A[:4, :4] = scale @ side[0] @ np.linalg.inv(scale)
    A[4, 0] = 1.0
    b = RAD_PER_DEG * scale @ side[1]
    B[:4] = np.column_stack([2.0 * (b[:, 1] + b[:, 2]), b[:, 0]])  # ailerons 1 and 3 move with 2 and 4 against them
    T = np.eye(5)
    T[3, 0] = -turn  # yaw rate off a coordinated turn
    lateral = Axis(A, B, T)
    C = -(plane[0][0] - np.array([0.0, u_m_s])) / GRAVITY_M_S2  # load factor of w and q
    b = RAD_PER_DEG * plane[1][:, 0]
    A, T = np.zeros((3, 3)), np.zeros((3, 3))
    A[:2, :2], A[2, :2] = plane[0], C
    T[0, :2], T[1], T[2, 2] = C, (-turn * C[0], 1.0 - turn * C[1], 0.0), 1.0
    return lateral, Axis(A, np.array([[b[0]], [b[1]], [-b[0] / GRAVITY_M_S2]]), T)


def _regulator(axis: Axis, tolerated: tuple[float, ...], orders: tuple[float, ...]) -> Floats:
    """Gains on T x of the regulator, (n_u, n_x)."""
    Q = axis.T.T @ np.diag([1.0 / each**2 for each in tolerated]) @ axis.T
    R = np.diag([1.0 / each**2 for each in orders])
    P = solve_continuous_are(axis.A, axis.B, Q, R)
    gains: Floats = np.linalg.solve(R, axis.B.T @ P) @ np.linalg.inv(axis.T)
    return gains


def regulators(point: Point, weights: Weights) -> dict[str, float]:
    """Gains of the law at a point, by the names of `Gains`."""
    w, d = weights, RAD_PER_DEG
    lateral = _regulator(
        point.lateral,
        (w.bank_deg * d, w.sideslip_deg * d, w.roll_rate_deg_s * d, w.yaw_rate_deg_s * d, w.bank_integral_deg_s * d),
        (w.roll_deg, w.rudder_deg),
    )
    longitudinal = -_regulator(
        point.longitudinal,
        (w.load_factor_g, w.pitch_rate_deg_s * d, w.load_factor_integral_g_s),
        (w.elevator_deg,),
    )
    return dict(zip(Gains._fields, [*lateral.ravel().tolist(), *longitudinal.ravel().tolist()], strict=True))


def power_laws(aircraft: Aircraft, condition: Floats, weights: Weights | None = None) -> dict[str, dict[str, float]]:
    """``{name: {value, exponent}}`` of every gain, the least-squares line of its logarithm over that of the pressure."""
    found = points(aircraft, condition)
    gains = [regulators(point, weights or Weights()) for point in found]
    x = np.log([point.pressure_pa / REFERENCE_PA for point in found])
    laws = {}
    for name in Gains._fields:
        values = np.array([each[name] for each in gains])
        middle = float(np.median(values))
        # a gain that changes its sign somewhere counts as next to nothing there
        slope, level = np.polyfit(x, np.log(np.maximum(np.abs(values), 1e-3 * abs(middle))), 1)
        laws[name] = {"value": float(np.sign(middle) * np.exp(level)), "exponent": float(slope)}
    return laws


def scheduled(laws: Mapping[str, Mapping[str, float]], pressure_pa: float) -> dict[str, float]:
    """Gains at a dynamic pressure."""
    share = pressure_pa / REFERENCE_PA
    return {name: law["value"] * share ** law["exponent"] for name, law in laws.items()}


def damping(axis: Axis, K: Floats, *, bandwidth_rad_s: float, sample_s: float = 0.01) -> tuple[float, float]:
    """Least damping [-] and least decay [1/s] of the sampled loop with actuators and delay; modes above 12 rad/s left out.

    Parameters
    ----------
    K : (n_u, n_x) array
        Gains on T x.
    """
    n, m = axis.B.shape
    late = round(DELAY_S / sample_s)
    whole = np.zeros((n + 2 * m, n + 2 * m))
    whole[:n, :n], whole[:n, n : n + m] = axis.A, axis.B
    whole[n : n + m, n:] = bandwidth_rad_s * np.hstack([-np.eye(m), np.eye(m)])
    held = expm(whole * sample_s)
    size = n + m * (1 + late)
    F = np.zeros((size, size))
    F[: n + m, : n + 2 * m] = held[: n + m]
    F[n + m : size - m, n + 2 * m :] = np.eye(m * (late - 1))
    F[size - m :, :n] = -K @ axis.T
    roots = np.linalg.eigvals(F)
    modes = np.log(roots[np.abs(roots) > 1e-6].astype(complex)) / sample_s
    slow = modes[np.abs(modes) < 12.0]
    return float((-slow.real / np.abs(slow)).min()), float(-slow.real.max())
