"""The same step as its user would write it for one run at a time: NumPy with matrices, `if` where it helps."""

from math import sin, sqrt

import numpy as np

from tests.bench.step import A_O, B_O, CONSTANTS, DT, L_O, LAW, RATE, STATES, A, B

_S, _C = STATES.places, CONSTANTS.places


class Run:
    """One run with its constants; `step` flies a sample, `measure` and `finish` are its two halves around the plant."""

    def __init__(self, constants: np.ndarray) -> None:
        c = {name: constants[where] for name, where in _C.items()}
        self.limits, self.bias, self.mask, self.knots, self.values = (
            c[n] for n in ("limits", "bias", "mask", "knots", "values")
        )
        self.amplitude, self.omega, self.onset, self.last, self.cmd, self.scale, self.sigma = (
            float(c[n]) for n in ("amplitude", "omega", "onset", "last", "cmd", "scale", "sigma")
        )

    def step(self, state: np.ndarray, k: int) -> np.ndarray:
        """State at the next sample."""
        x, f = state[_S["x"]], self.plant(state, k)
        k1 = f(x)
        k2 = f(x + 0.5 * DT * k1)
        k3 = f(x + 0.5 * DT * k2)
        k4 = f(x + DT * k3)
        after = self.after
        after[_S["x"]] = x + DT / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        return after

    def plant(self, state: np.ndarray, k: int):
        """Everything but the integration, into `after`; the derivative of the plant over this sample."""
        x, normals = state[_S["x"]], state[:8]
        fault = self.amplitude * sin(self.omega * (k * DT - self.onset * DT)) if k >= self.onset else 0.0
        sensors = x[2] + normals[:3] * 0.01 + self.bias * 0.01 + self.mask * fault
        voted = float(np.median(sensors))
        feedback = np.array([voted, x[3] + normals[3] * 0.001, x[0]])
        command = np.interp(k * DT, self.knots, self.values) * self.cmd
        demand = LAW @ feedback + command * 0.1
        rate = np.clip((demand - state[_S["act"]]) * RATE, -4.0 * self.limits, 4.0 * self.limits)
        act = np.clip(state[_S["act"]] + rate * DT, -self.limits, self.limits)
        g0, g1 = state[_S["gust"]]
        gust = np.array([g0 * 0.98 + normals[4] * self.sigma, g1 * 0.97 + normals[5] * self.sigma + g0 * 0.02])
        rho = (x[0] * 0.1 * self.scale, x[1] * 0.1)
        M = A[0] + A[1] * rho[0] + A[2] * rho[1]
        drive = (B[0] + B[1] * rho[0] + B[2] * rho[1]) @ act
        drive = drive + np.array([gust[0] * 0.1, gust[1] * 0.1, gust[0] * 0.05, 0.0])
        self.after = after = np.empty_like(state)
        after[_S["act"]], after[_S["gust"]] = act, gust
        error = self._observe(state[_S["obs"]], after[_S["obs"]], voted, feedback[1], normals[6])
        self._count(state, after, sensors, voted, error, gust, k)
        return lambda y: M @ y + drive

    def _observe(self, obs, after, voted, phi, normal) -> float:
        z, g = obs[:4], float(obs[4])
        error = float(voted - z[2])
        for _ in range(3):
            h = abs(g) + 0.1
            g = g - (h * h * g - error) / (3.0 * h * h + 0.5)
        injection = error / (abs(error) + 0.01)
        linear = A_O @ z + B_O @ np.array([voted, phi, normal * 0.01])
        after[:4] = z + DT * (linear + L_O * error + injection * 0.2)
        after[4] = g
        return error

    def _count(self, state, after, sensors, voted, error, gust, k) -> None:
        flt = state[_S["flt"]] * 0.95 + 0.05 * abs(error)
        thr = state[_S["thr"]] * 0.999 + 0.001 * (1.0 + sqrt(gust[0] * gust[0] + gust[1] * gust[1]))
        deviation = np.abs(sensors - voted)
        counted = state[_S["count"]]
        count = np.where(deviation > thr * 0.5, counted + 1.0, np.maximum(counted - 1.0, 0.0))
        latched = np.where((count > 30.0) & (k < self.last), 1.0, state[_S["latched"]])
        after[_S["flt"]], after[_S["thr"]], after[_S["count"]], after[_S["latched"]] = flt, thr, count, latched
        alarm, peak = state[_S["alarm"]], state[_S["peak"]]
        after[_S["alarm"]] = k if alarm == 0.0 and latched.sum() > 0.0 else alarm
        after[_S["peak"]] = max(peak, flt / thr) if k < self.last else peak
        after[_S["energy"]] = state[_S["energy"]] * 0.9 + deviation * deviation
