"""The step that everybody flies: 4-state LPV plant with 13 inputs, RK4, actuators, gust, fault, observer, counters.

About 920 operations. Its numbers are drawn, not an aircraft: it has the shape of a benchmark's step and stays as it is, so
that ratios of one year and the next compare.
"""

import numpy as np

from fddbench.blocks import functions
from fddbench.blocks.layout import ROW, Layout, Row, Rows, record
from fddbench.blocks.linear import affine, column, product, total
from fddbench.blocks.program import Program, trace

DT = 0.01
NORMALS = 8


@record
class State:
    """Plant, actuators, gust, observer, filtered error, threshold, logic."""

    x: Rows
    act: Rows
    gust: Rows
    obs: Rows
    flt: Row
    thr: Row
    count: Rows
    latched: Rows
    alarm: Row
    peak: Row
    energy: Rows


@record
class Constants:
    """Travel, sensor biases, fault, command, noise."""

    limits: Rows
    bias: Rows
    amplitude: Row
    omega: Row
    onset: Row
    last: Row
    mask: Rows
    cmd: Row
    scale: Row
    knots: Rows
    values: Rows
    sigma: Row


STATES = Layout(
    State(
        x=4, act=13, gust=2, obs=5, flt=ROW, thr=ROW, count=3, latched=3, alarm=ROW, peak=ROW, energy=3
    )
)  # fmt: skip
CONSTANTS = Layout(
    Constants(
        limits=13, bias=3, amplitude=ROW, omega=ROW, onset=ROW, last=ROW, mask=3, cmd=ROW, scale=ROW, knots=6, values=6,
        sigma=ROW,
    )
)  # fmt: skip

_rng = np.random.default_rng(1)
A = np.stack([_rng.normal(size=(4, 4)) * s for s in (0.5, 0.1, 0.1)])
A[0] -= 1.5 * np.eye(4)
B = np.stack([_rng.normal(size=(4, 13)) * s for s in (0.2, 0.05, 0.05)])
B[:, _rng.random((4, 13)) < 0.25] = 0.0
LAW = _rng.normal(size=(13, 3)) * 0.1
RATE = np.linspace(15, 40, 13)
A_O, B_O, L_O = _rng.normal(size=(4, 4)) * 0.1 - np.eye(4), _rng.normal(size=(4, 3)) * 0.2, _rng.normal(size=4)


def step(state: Rows, constants: Rows, normals: Rows, sample: Rows) -> dict[str, Rows]:
    """One sample."""
    s, c = STATES.unpack(state), CONSTANTS.unpack(constants)
    t = sample * DT
    fault = np.where(sample >= c.onset, c.amplitude * functions.sin(c.omega * (t - c.onset * DT)), 0.0)
    sensors = np.stack([s.x[2] + normals[j] * 0.01 + c.bias[j] * 0.01 + c.mask[j] * fault for j in range(3)])
    a, b, d = sensors
    voted = np.minimum(np.minimum(np.maximum(a, b), np.maximum(b, d)), np.maximum(a, d))
    feedback = np.stack([voted, s.x[3] + normals[3] * 0.001, s.x[0]])
    command = functions.interpolate(t, c.knots, c.values) * c.cmd
    demand = product(column(LAW), feedback) + command * 0.1
    rate = np.minimum(np.maximum((demand - s.act) * column(RATE), -c.limits * 4.0), c.limits * 4.0)
    act = np.minimum(np.maximum(s.act + rate * DT, -c.limits), c.limits)
    gust = np.stack(
        [s.gust[0] * 0.98 + normals[4] * c.sigma, s.gust[1] * 0.97 + normals[5] * c.sigma + s.gust[0] * 0.02]
    )
    rho = np.stack([s.x[0] * 0.1 * c.scale, s.x[1] * 0.1])
    M, control = affine(column(A), rho), product(affine(column(B), rho), act)
    drive = control + np.stack([gust[0] * 0.1, gust[1] * 0.1, gust[0] * 0.05, gust[1] * 0.0])
    x = _rk4(M, drive, s.x)
    obs, error = _observe(s.obs, voted, feedback[1], normals[6])
    flt = s.flt * 0.95 + 0.05 * np.abs(error)
    thr = s.thr * 0.999 + 0.001 * (1.0 + np.sqrt(gust[0] * gust[0] + gust[1] * gust[1]))
    deviation = np.abs(sensors - voted)
    count = np.where(deviation > thr * 0.5, s.count + 1.0, np.maximum(s.count - 1.0, 0.0))
    latched = np.where((count > 30.0) & (sample < c.last), 1.0, s.latched)
    alarm = np.where((s.alarm == 0.0) & (total(latched) > 0.0), sample, s.alarm)
    peak = np.where(sample < c.last, np.maximum(s.peak, flt / thr), s.peak)
    energy = s.energy * 0.9 + deviation * deviation
    after = State(
        x=x, act=act, gust=gust, obs=obs, flt=flt, thr=thr, count=count, latched=latched, alarm=alarm, peak=peak,
        energy=energy,
    )  # fmt: skip
    return {"state": STATES.pack(after)}


def _rk4(M: Rows, drive: Rows, x: Rows) -> Rows:
    k1 = product(M, x) + drive
    k2 = product(M, x + 0.5 * DT * k1) + drive
    k3 = product(M, x + 0.5 * DT * k2) + drive
    k4 = product(M, x + DT * k3) + drive
    return x + (DT / 6.0) * (k1 + 2.0 * k2 + 2.0 * k3 + k4)


def _observe(state: Rows, voted: Rows, phi: Rows, normal: Rows) -> tuple[Rows, Rows]:
    """Sliding-mode observer with three Newton steps of an implicit injection: its state, and the output error."""
    z, g = state[:4], state[4]
    error = voted - z[2]
    for _ in range(3):
        h = np.abs(g) + 0.1
        g = g - (h * h * g - error) / (3.0 * h * h + 0.5)
    injection = error / (np.abs(error) + 0.01)
    linear = product(column(A_O), z) + product(column(B_O), np.stack([voted, phi, normal * 0.01]))
    z = z + DT * (linear + column(L_O) * error + injection * 0.2)
    return np.concatenate([z, g[np.newaxis]]), error


def quiet(state: Rows, constants: Rows, sample: Rows) -> dict[str, Rows]:
    """One sample without a generator: the first eight states stand in for the normals, so no operation is saved."""
    return step(state, constants, state[:NORMALS], sample)


def quiet_program() -> Program:
    """The step without a generator, traced."""
    return trace(quiet, state=STATES.size, constants=CONSTANTS.size, sample=0)


def noisy_program() -> Program:
    """The step with eight normals a sample, traced."""
    return trace(step, state=STATES.size, constants=CONSTANTS.size, normals=NORMALS, sample=0)


def data(n_runs: int) -> tuple[np.ndarray, np.ndarray]:
    """State before sample 0 and constants of some runs."""
    rng = np.random.default_rng(3)
    state = np.zeros((STATES.size, n_runs))
    state[:4] = rng.normal(size=(4, n_runs)) * 0.1
    constants = rng.normal(size=(CONSTANTS.size, n_runs)) * 0.1
    fixed = {
        "limits": 5.0 + rng.random((13, n_runs)), "onset": 20.0, "last": 6000.0, "mask": [[1.0], [0.0], [0.0]],
        "knots": [[0.0], [1.0], [2.0], [20.0], [21.0], [22.0]], "scale": 1.0, "omega": 6.0, "sigma": 0.1,
    }  # fmt: skip
    for name, value in fixed.items():
        constants[CONSTANTS.places[name]] = value
    return state, constants
