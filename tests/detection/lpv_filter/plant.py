"""A plant of three states and one parameter, a bank for it, and flights in which faults come and the parameter swings."""

from types import SimpleNamespace

import numpy as np
from scipy.linalg import expm

from fddbench.blocks.layout import Nothing
from fddbench.design.geometric import residual_generator
from fddbench.detection.lpv_filter.detector import LpvFilter
from fddbench.detection.lpv_filter.gains import LpvFilterGains
from fddbench.interfaces import Bus, Site

SAMPLE_S = 0.04
A = np.array([
    [[-1.0, 1.0, 0.0], [-2.0, -1.0, 0.5], [0.3, 0.2, -0.7]],
    [[0.0, 0.3, 0.0], [0.5, 0.0, 0.2], [0.0, 0.0, 0.3]],
])  # fmt: skip
B = np.array([[[1.0, 0.0], [0.5, 1.0], [0.0, 0.3]], [[0.0, 0.0], [0.0, 0.3], [0.0, 0.0]]])
_STOPS = (-20.0, 20.0)
SITES = tuple(
    Site(
        name=name,
        signal=f"{name}_deg",
        unit_name="deg",
        admissible=20.0,
        kind="actuator",
        stops=_STOPS,
        limits_s=(5.0,),
    )
    for name in ("left", "right")
)


class Tilt:
    """The parameter is measured itself."""

    about = "a measured ratio"
    signals = ("tilt_ratio",)
    parameters = ("tilt_ratio",)
    box = ((-1.0, 1.0),)

    def rho(self, measured):
        return np.stack([measured.tilt_ratio])


def clean(numbers):
    """Without rounding, as recipes write them: what is constant to rounding is constant."""
    return np.where(np.abs(numbers) > 1e-12, numbers, 0.0).tolist()


def bus(C):
    signals = {"y": len(C), "left_deg": 0, "right_deg": 0, "tilt_ratio": 0}
    return Bus(sample_s=SAMPLE_S, sites=SITES, signals=signals)


def gains(C, *, one_state=True, decay=2.0, **more):
    """A bank for the plant with outputs C; inputs are in rad in the model."""
    faults = {"left": B[:, :, 0:1], "right": B[:, :, 1:2]}
    bank = residual_generator(A, B, C, faults, box=[[-1.0, 1.0]], decay=decay, one_state=one_state)
    filters = [
        {"site": name, "unit_per_fault": 180.0 / np.pi, "least_gain": 1e-3, "start": (f.P @ np.linalg.pinv(C)).tolist()}
        | {key: clean(getattr(f, key)) for key in ("N", "G", "F", "M", "H", "PL")}
        for name, f in bank.items()
    ]
    given = {
        "scheduling": "tilt",
        "outputs": [{"signal": "y", "row": i} for i in range(len(C))],
        "inputs": [{"signal": f"{name}_deg", "scale": np.pi / 180.0, "held": True} for name in ("left", "right")],
        "bend": (C @ A @ np.linalg.pinv(C)).tolist(),
        "filters": filters,
        "thresholds": [1.0, 1.0],
        "confirm_s": 0.2,
    }
    return LpvFilterGains.model_validate(given | more)


def detector(C, **more):
    return LpvFilter.from_design(gains(C, **more), bus(C), Tilt)


def fly(detector, C, *added_deg, time_s=8.0, x0=(0.0, 0.0, 0.0)):
    """Estimates [deg] and declarations, (n_time, 2, n_flights), with `added_deg(t)` on both inputs, a flight each.

    The parameter and the inputs are held over a sample.
    """
    n = len(added_deg)
    x = np.tile(np.array(x0)[:, np.newaxis], (1, n))
    state, estimates, declared = detector.states.spread(detector.start(Nothing()), n), [], []
    for t in SAMPLE_S * np.arange(round(time_s / SAMPLE_S)):
        rho = 0.6 * np.sin(0.9 * t) + 0.4 * np.cos(2.3 * t)
        u_deg = np.array([3.0 + 4.0 * np.sin(1.1 * t), 5.0 * np.cos(0.7 * t)])
        signals = {"left_deg": u_deg[0], "right_deg": u_deg[1], "tilt_ratio": rho}
        measured = SimpleNamespace(y=C @ x, **{name: np.full(n, value) for name, value in signals.items()})
        state, verdict = detector.step(state, Nothing(), Nothing(), measured)
        estimates.append(verdict.estimate)
        declared.append(verdict.declared)
        big = np.zeros((5, 5))
        big[:3, :3], big[:3, 3:] = A[0] + rho * A[1], B[0] + rho * B[1]
        moved = expm(big * SAMPLE_S)
        total_deg = np.stack([u_deg + fault(t) for fault in added_deg], axis=-1)
        x = moved[:3, :3] @ x + moved[:3, 3:] @ np.deg2rad(total_deg)
    return np.array(estimates), np.array(declared)
