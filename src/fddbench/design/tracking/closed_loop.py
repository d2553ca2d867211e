"""What is known of a law on an aircraft: stability as it flies, and margins."""

import numpy as np
from scipy.linalg import expm

from fddbench.benchmarks.b747_longitudinal.laws.law_file import INPUTS, OUTPUTS, Handover, TrackingLaw
from fddbench.design.tracking.aircraft import ACTUATORS, ENGINE_RAD_S, MEASURED, LinearAircraft
from fddbench.design.tracking.interconnection import CONTROLS
from fddbench.design.tracking.wiring import Block, wire
from fddbench.systems import StateSpace

__all__ = ["actuated", "disk_margin", "gains_at", "sampled_decay_1_s"]

_KN = 1e-3


def gains_at(law: TrackingLaw, dynamic_pressure_pa: float) -> StateSpace:
    """The law at a dynamic pressure [Pa], orders in deg and kN."""
    knots = law.dynamic_pressure_pa
    share = [np.interp(dynamic_pressure_pa, knots, row) for row in np.eye(len(knots))] if len(knots) else [1.0]
    C, D = (np.tensordot(share, gains, axes=1) * [[1.0], [_KN]] for gains in (law.C, law.D))
    return StateSpace(law.A, law.B, C, D)


def actuated(flying: LinearAircraft, handover: Handover | None = None) -> StateSpace:
    """From the orders of a law, deg and kN, to its inputs at commands of zero; after a handover by the stabiliser."""
    wires: dict[str, dict[str, float]] = {"stabiliser": {}, "gust": {}}
    blocks = [flying.block(), ACTUATORS[1]]
    if handover is None:
        blocks.append(ACTUATORS[0])
    else:
        ahead = flying.stabiliser_ratio * handover.lead_s / handover.lag_s
        behind = flying.stabiliser_ratio - ahead
        lead = StateSpace.diagonal([-1.0 / handover.lag_s], [1.0 / handover.lag_s], [behind], [ahead])
        motor = StateSpace.diagonal([-ENGINE_RAD_S], [ENGINE_RAD_S], [1.0], [0.0])
        blocks += [Block(lead, ["elevator_order"], ["led"]), Block(motor, ["led"], ["stabiliser_position"])]
        wires |= {"stabiliser": {"stabiliser_position": 1.0}, "elevator": {}}
    seen = {name: {name: 1.0} for name in MEASURED}
    errors = {INPUTS[0]: {"flight_path_deg": -1.0}, INPUTS[1]: {"speed_m_s": -1.0}}
    return wire(blocks, wires, inputs=CONTROLS, outputs=errors | seen)


def sampled_decay_1_s(plant: StateSpace, law: StateSpace, *, sample_s: float) -> float:
    """Decay of the slowest mode of the loop as it flies [1/s]; negative where it grows.

    Orders are held over a sample and arrive one sample after the measurement; the law is discretised by Tustin's rule. The
    altitude is left out: nothing holds it, so it is a mode that neither decays nor grows.
    """
    n, m, k = plant.order, plant.n_inputs, law.order
    held = expm(np.block([[plant.A, plant.B], [np.zeros((m, n + m))]]) * sample_s)
    half = np.linalg.inv(np.eye(k) - 0.5 * sample_s * law.A)
    A, B, C = half @ (np.eye(k) + 0.5 * sample_s * law.A), sample_s * half @ law.B, law.C @ half
    D = law.D + 0.5 * C @ (sample_s * law.B)
    loop = np.zeros((n + k + m, n + k + m))
    loop[:n, :n], loop[:n, n + k :] = held[:n, :n], held[:n, n:]
    loop[n : n + k, :n], loop[n : n + k, n : n + k] = B @ plant.C, A
    loop[n + k :, :n], loop[n + k :, n : n + k] = D @ plant.C, C
    poles = np.linalg.eigvals(loop)
    others = np.delete(poles, np.argmin(np.abs(poles - 1.0)))
    return -float(np.log(np.abs(others).max())) / sample_s


def disk_margin(plant: StateSpace, law: StateSpace, channel: str, *, delay_s: float) -> float:
    """Balanced disk margin of one order, the other loop closed: gain factors from (2 - a) / (2 + a) to its inverse are safe.

    References
    ----------
    Seiler, Packard, Gahinet (2020), An introduction to disk margins, IEEE Control Systems Magazine 40(5), 78-95.
    """
    j = OUTPUTS.index(channel)
    largest = 0.0
    for w in np.geomspace(1e-3, 1e3, 3000):
        around = np.exp(-1j * w * delay_s) * law.at(w) @ plant.at(w)
        other = 1 - j
        L = -(around[j, j] + around[j, other] / (1.0 - around[other, other]) * around[other, j])
        largest = max(largest, abs((1.0 - L) / (1.0 + L)))
    return 2.0 / largest
