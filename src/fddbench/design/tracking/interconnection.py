"""The synthesis problem of Fig. 2: aircraft, actuators, response models and weights as one system.

The weights of the paper are not public; these are ours. Its controller is said to follow Ganguli, Marcos and Balas (2002),
Reconfigurable LPV control design for Boeing 747-100/200 longitudinal axis, American Control Conference, 3612-3617. Without a
disturbance at the plant's inputs and the integrals of the errors there is no integral action, and the flight path drifts.
"""

from dataclasses import dataclass

import numpy as np

from fddbench.design.tracking.aircraft import ACTUATORS, MEASURED, LinearAircraft
from fddbench.design.tracking.reference import corner_rad_s, models
from fddbench.design.tracking.wiring import Block, wire
from fddbench.interfaces import Floats
from fddbench.systems import StateSpace

__all__ = ["CONTROLS", "KNOWN", "Weights", "generalised_plant"]

KNOWN = ("flight_path_command", "speed_command", "flight_path_integral", "speed_integral", *MEASURED)
"""What the controller is told; the integrals are of command minus measurement."""
CONTROLS = ("elevator_order", "thrust_order")
"""What the controller orders, deg and kN."""


@dataclass(frozen=True, kw_only=True)
class Weights:
    """Sizes of everything: what comes from outside, and what is tolerated. The norm is 1 when all of it is kept.

    Attributes
    ----------
    settling_s : (2,)
        Of the responses to follow: flight path, speed [s].
    command : (2,)
        Steps of flight path [deg] and speed [m/s].
    disturbance : (2,)
        At the inputs: elevator [deg], thrust [kN].
    gust_m_s : (2,)
        Down, which turns and lifts the aircraft, and along, which only airspeed shows [m/s].
    noise : (7,)
        Of the integrals [deg s, m] and of `MEASURED`.
    error, integral : (2,)
        Tolerated deviations from the models [deg, m/s] and their integrals [deg s, m].
    effort : (2,)
        Tolerated fast motion of elevator [deg] and thrust [kN], fast meaning above
    corner_rad_s : (2,)
        these frequencies [rad/s].
    """

    settling_s: tuple[float, float]
    command: tuple[float, float]
    disturbance: tuple[float, float]
    gust_m_s: tuple[float, float]
    noise: tuple[float, ...]
    error: tuple[float, float]
    integral: tuple[float, float]
    effort: tuple[float, float]
    corner_rad_s: tuple[float, float]

    @property
    def sizes(self) -> tuple[Floats, Floats]:
        """Sizes of `KNOWN` and `CONTROLS`, (9,) and (2,): what a reduction of the controller weighs by."""
        path, speed = self.command
        known = [path, speed, *self.integral, path, self.noise[3] * 5.0, path, path, speed]
        return np.array(known), np.array(self.effort)


def generalised_plant(flying: LinearAircraft, weights: Weights) -> StateSpace:
    """From commands, disturbances, gust, noise and `CONTROLS` to errors, efforts and `KNOWN`; sizes as in `weights`."""
    w = weights
    noise = [f"noise_{name}" for name in KNOWN[2:]]
    sums = StateSpace.diagonal([0.0, 0.0], [1.0, 1.0], [1.0, 1.0], [0.0, 0.0])
    integrals = Block(sums, ["flight_path_error", "speed_error"], ["flight_path_sum", "speed_sum"])
    fast = StateSpace.diagonal(np.negative(w.corner_rad_s), w.corner_rad_s, [-1.0, -1.0], [1.0, 1.0])
    efforts = Block(fast, ["u_elevator", "u_thrust"], ["elevator_fast", "thrust_fast"])
    commands = {"flight_path_command": {"c_flight_path": w.command[0]}, "speed_command": {"c_speed": w.command[1]}}
    wires = {
        "elevator_order": {"u_elevator": 1.0, "d_elevator": w.disturbance[0]},
        "thrust_order": {"u_thrust": 1.0, "d_thrust": w.disturbance[1]},
        "stabiliser": {},
        "gust": {"d_down": w.gust_m_s[0]},
        "flight_path_error": {**commands["flight_path_command"], "flight_path_deg": -1.0},
        "speed_error": {**commands["speed_command"], "speed_m_s": -1.0, "d_along": -w.gust_m_s[1]},
    }
    seen = zip(KNOWN[2:], ("flight_path_sum", "speed_sum", *MEASURED), noise, w.noise, strict=True)
    known = {name: {signal: 1.0, n: size} for name, signal, n, size in seen}
    known["speed_m_s"]["d_along"] = w.gust_m_s[1]
    return wire(
        [flying.block(altitude=False), *ACTUATORS, models(*w.settling_s), integrals, efforts],
        wires | commands,
        inputs=[
            "c_flight_path",
            "c_speed",
            "d_elevator",
            "d_thrust",
            "d_down",
            "d_along",
            *noise,
            "u_elevator",
            "u_thrust",
        ],
        outputs=_tolerated(w) | commands | known,
    )


def _tolerated(w: Weights) -> dict[str, dict[str, float]]:
    """Errors against the models, their integrals, and efforts, each by what is tolerated.

    The integral of model minus response is that of command minus response, less ``(m' + 2 ω m) / ω²``, the integral of
    command minus model: no second integrator that nobody could see.
    """
    z: dict[str, dict[str, float]] = {}
    for j, (name, measured) in enumerate((("flight_path", "flight_path_deg"), ("speed", "speed_m_s"))):
        corner = corner_rad_s(w.settling_s[j])
        z[f"z_{name}"] = {f"{name}_model": 1.0 / w.error[j], measured: -1.0 / w.error[j]}
        z[f"z_{name}_sum"] = {
            f"{name}_sum": 1.0 / w.integral[j],
            f"{name}_model_rate": -1.0 / (corner**2 * w.integral[j]),
            f"{name}_model": -2.0 / (corner * w.integral[j]),
        }
    z["z_elevator"] = {"elevator_fast": 1.0 / w.effort[0]}
    z["z_thrust"] = {"thrust_fast": 1.0 / w.effort[1]}
    return z
