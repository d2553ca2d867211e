"""Flights of the nonlinear aircraft with a law, for what a design file says of it: integrated in continuous time by SciPy.

No sensors and no sampling: the benchmark flies those. Independent of it, so that each checks the other.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp

from fddbench.benchmarks.b747_longitudinal.laws.law_file import TrackingLaw
from fddbench.design.tracking.aircraft import ELEVATOR_RAD_S, ENGINE_RAD_S, FlightPoint, linear_aircraft
from fddbench.flight.atmosphere import GRAVITY_M_S2
from fddbench.flight.b747.aerodynamics import air
from fddbench.flight.b747.airframe import DATA, Aircraft, aircraft
from fddbench.flight.b747.dynamics import derivative
from fddbench.interfaces import Floats
from fddbench.units import DEG_PER_RAD

__all__ = ["Response", "Story", "fly"]


def _zero(time_s: float) -> float:
    """Nothing commanded."""
    del time_s
    return 0.0


def _whole(time_s: float) -> tuple[float, float]:
    """Nothing lost."""
    del time_s
    return 1.0, 1.0


def _calm(time_s: float) -> tuple[float, float]:
    """No wind."""
    del time_s
    return 0.0, 0.0


@dataclass(frozen=True, kw_only=True)
class Story:
    """What happens in a flight; functions of time [s] that may jump at `jumps_s` only.

    Attributes
    ----------
    duration_s : float
    flight_path_deg, speed_m_s : function
        Commands minus trim.
    effectiveness : function
        Of elevator and thrust, factors of the whole actuator position [-].
    wind : function
        Along the body's axes x and z (down) [m/s].
    handover_s : float
        From when on the stabiliser has the pitch [s].
    jumps_s : sequence of float
        Where the functions jump [s].
    """

    duration_s: float
    flight_path_deg: Callable[[float], float] = _zero
    speed_m_s: Callable[[float], float] = _zero
    effectiveness: Callable[[float], tuple[float, float]] = _whole
    wind: Callable[[float], tuple[float, float]] = _calm
    handover_s: float = float("inf")
    jumps_s: Sequence[float] = field(default_factory=tuple)


@dataclass(frozen=True, kw_only=True)
class Response:
    """Time [s] and signals by name, (n_time,) each; speed as deviation from trim."""

    time_s: Floats
    signals: Mapping[str, Floats]

    def __getitem__(self, name: str) -> Floats:
        """Signal by its name, (n_time,)."""
        return self.signals[name]


def fly(
    law: TrackingLaw | None, at: FlightPoint, story: Story, *, flying: Aircraft | None = None, step_s: float = 0.05
) -> Response:
    """Response of the nonlinear aircraft to a story, with a law or (None) with all controls held at trim."""
    loop = _Loop(law, at, story, aircraft() if flying is None else flying)
    state, times, states = loop.start(), [], []
    jumps = sorted({t for t in (*story.jumps_s, story.handover_s) if 0.0 < t < story.duration_s})
    for begin, end in zip([0.0, *jumps], [*jumps, story.duration_s], strict=True):
        if begin >= story.handover_s and loop.frozen_deg is None:
            loop.hand_over(begin, state)
        grid = np.append(np.arange(begin, end - 1e-9, step_s), end)
        found = solve_ivp(
            _within(loop, begin, end), (begin, end), state,
            method="LSODA", t_eval=grid, rtol=1e-6, atol=1e-8, max_step=0.5,
        )  # fmt: skip
        state = found.y[:, -1]
        times.append(found.t[:-1])
        states.append(found.y[:, :-1])
    return loop.recorded(np.concatenate(times), np.concatenate(states, axis=1))


def _within(loop: "_Loop", begin: float, end: float) -> Callable[[float, Floats], Floats]:
    """Rate of a stretch between two jumps, which neither end sees."""

    def rate(time_s: float, state: Floats) -> Floats:
        return loop.rate(min(max(float(time_s), begin + 1e-9), end - 1e-9), np.asarray(state, dtype=float))

    return rate


class _Loop:
    """State: aircraft (5), elevator, thrust [N] and stabiliser, the two filters of a handover, and the law."""

    def __init__(self, law: TrackingLaw | None, at: FlightPoint, story: Story, flying: Aircraft) -> None:
        self.law, self.story, self.flying = law, story, flying
        self.trim = linear_aircraft(at, flying)
        self.ratio = linear_aircraft(at).stabiliser_ratio
        alpha = self.trim.alpha_deg / DEG_PER_RAD
        self.x0 = np.array([alpha, 0.0, at.v_tas_m_s, alpha, at.altitude_m])
        self.u0 = np.array([self.trim.elevator_deg, 1e3 * self.trim.thrust_kn, DATA["stabiliser_deg"]])
        self.frozen_deg: float | None = None

    def start(self) -> Floats:
        """Trim."""
        n = 0 if self.law is None else len(self.law.A)
        return np.concatenate([self.x0, self.u0, np.zeros(2 + n)])

    def hand_over(self, time_s: float, state: Floats) -> None:
        """Freeze the elevator's order and start the filter of the command where the command is."""
        _, order, _ = self._ordered(time_s - 1e-6, state)
        self.frozen_deg = float(order[0])
        state[8] = 0.0
        state[9] = self.story.flight_path_deg(time_s - 1e-6)

    def rate(self, time_s: float, state: Floats) -> Floats:
        """Time derivative of the state."""
        rate, order, law_rate = self._ordered(time_s, state)
        positions = state[5:8]
        filters = np.zeros(2)
        target = order.copy()
        if self.frozen_deg is not None and self.law is not None:
            way = self.law.handover
            over = order[0] - self.frozen_deg
            led = way.lead_s / way.lag_s * over + (1.0 - way.lead_s / way.lag_s) * state[8]
            target = np.array([self.frozen_deg, order[1], self.u0[2] + self.ratio * led])
            wanted = self.story.flight_path_deg(time_s)
            filters = np.array([(over - state[8]) / way.lag_s, (wanted - state[9]) / way.command_lag_s])
        corners = np.array([ELEVATOR_RAD_S, ENGINE_RAD_S, ENGINE_RAD_S])
        return np.concatenate([rate, corners * (target - positions), filters, law_rate])

    def _ordered(self, time_s: float, state: Floats) -> tuple[Floats, Floats, Floats]:
        """Derivatives of the aircraft, orders to elevator, thrust and stabiliser, and derivatives of the law."""
        x, positions, own = state[:5], state[5:8], state[10:]
        lost = self.story.effectiveness(time_s)
        u = np.array([lost[0] * positions[0], positions[2], lost[1] * positions[1]])
        wind = np.array([*self.story.wind(time_s), 0.0])
        rate = np.asarray(derivative(x[:, None], u[:, None], wind[:, None], self.flying, air(x[4:])))[:, 0]
        if self.law is None:
            return rate, self.u0, np.zeros(0)
        path = DEG_PER_RAD * (x[3] - x[0])
        command = self.story.flight_path_deg(time_s) if self.frozen_deg is None else state[9]
        speed = x[2] - self.x0[2]
        y = np.array([
            command - path, self.story.speed_m_s(time_s) - speed, path, rate[2] / GRAVITY_M_S2,
            DEG_PER_RAD * (x[3] - self.x0[3]), DEG_PER_RAD * x[1], speed,
        ])  # fmt: skip
        law = self.law
        pressure = 0.5 * float(air(x[4:]).density_kg_m3[0]) * x[2] ** 2
        C, D = (_at(gains, law.dynamic_pressure_pa, pressure) for gains in (law.C, law.D))
        order = self.u0 + np.append(C @ own + D @ y, 0.0)
        return rate, order, law.A @ own + law.B @ y

    def recorded(self, time_s: Floats, states: Floats) -> Response:
        """Signals of a flight."""
        x = states[:5]
        return Response(
            time_s=time_s,
            signals={
                "flight_path_deg": DEG_PER_RAD * (x[3] - x[0]),
                "speed_m_s": x[2] - self.x0[2],
                "alpha_deg": DEG_PER_RAD * x[0],
                "q_deg_s": DEG_PER_RAD * x[1],
                "theta_deg": DEG_PER_RAD * x[3],
                "altitude_m": x[4],
                "elevator_deg": states[5],
                "thrust_n": states[6],
                "stabiliser_deg": states[7],
            },
        )


def _at(gains: Floats, knots: Floats, pressure: float) -> Floats:
    """Gains at a dynamic pressure."""
    if not len(knots):
        return np.asarray(gains[0])
    place = np.interp(pressure, knots, np.arange(len(knots)))
    i = min(int(place), len(knots) - 2)
    return np.asarray(gains[i] + (place - i) * (gains[i + 1] - gains[i]))
