"""Detectors as their authors write them, for tests of what cannot be compiled."""

HEAD = """
import math
import random
import time

import numpy as np
from pydantic import BaseModel

from fddbench.blocks.layout import Layout, Rows, record
from fddbench.interfaces import Verdict


class Gains(BaseModel):
    pass


class Base:
    about, Gains = "test", Gains

    @classmethod
    def from_design(cls, gains, bus):
        return cls()

"""

PLAIN = """
class Mine(Base):
    recorded = ("worst_deg_s",)

    def start(self):
        return {"sums": [0.0] * 3, "declared": [0] * 3}

    def step(self, state, measured):
        for i, r in enumerate(measured.r_deg_s):
            state["sums"][i] = max(state["sums"][i] + abs(r - measured.r_voted_deg_s) - 0.1, 0.0)
            if state["sums"][i] > 2.0:
                state["declared"][i] = 1
        worst = max(state["sums"])
        return state, Verdict(state["declared"], worst / 2.0, signals={"worst_deg_s": worst})
"""
"""The example's cumulative sum with lists, an `if` and a state that is changed in place."""

SIDE_BY_SIDE = """
@record
class State:
    sums: Rows
    declared: Rows


class Mine(Base):
    states, batched, recorded = Layout(State(sums=3, declared=3)), True, ("worst_deg_s",)

    def start(self):
        return State(sums=0.0, declared=0.0)

    def step(self, x, measured):
        sums = np.maximum(x.sums + abs(measured.r_deg_s - np.median(measured.r_deg_s, axis=0)) - 0.1, 0.0)
        declared = x.declared.copy()
        declared[sums > 2.0] = 1.0
        worst = sums.max(axis=0)
        return State(sums=sums, declared=declared), Verdict(declared, worst / 2.0, signals={"worst_deg_s": worst})
"""
"""The same on rows of many flights, with what cannot be compiled."""

MONITOR = """
class Mine(Base):
    isolates = False

    def start(self):
        return np.zeros(2), np.eye(2), False

    def step(self, state, measured):
        x, p, alarm = state
        f, h = np.array([[1.0, 0.01], [0.0, 1.0]]), np.array([1.0, 0.0])
        x, p = f @ x, f @ p @ f.T + 1e-4 * np.eye(2)
        e, s = float(np.mean(measured.r_deg_s)) - h @ x, h @ p @ h + 1e-4 / 3.0
        k = p @ h / s
        alarm = alarm or bool(e * e / s > 400.0)
        return (x + k * e, p - np.outer(k, h @ p), alarm), Verdict(None, e * e / s / 400.0, alarm=alarm)
"""
"""A Kalman monitor that says that something is wrong, not which sensor; matrices by BLAS are all right in one flight."""

CROSSTALK = SIDE_BY_SIDE.replace(
    "declared[sums > 2.0] = 1.0", "if sums.max() > 2.0:\n            declared[sums.max(axis=1) > 2.0] = 1.0"
)
"""Declares a sensor in every flight of its company."""

FAILING = """
class Mine(Base):
    def start(self):
        return 0

    def step(self, state, measured):
        if state > 20 and CONDITION:
            WRONG
        return state + 1, Verdict([0, 0, 0], 0.0)
"""
"""Does something wrong after 20 samples, on some flights."""

TEXT = """\
name: opaque
benchmark: yaw_rate
seed: 5
duration_s: 3.0
detectors: [NAMES]
dispersions:
  monte_carlo: {runs: 5, mass_kg: {uniform: [180000, 220000]}}
scenarios:
  - {name: healthy, manoeuvre: cruise}
  - {name: jam, manoeuvre: cruise, faults: [{kind: jam, sites: [r1], onset_s: 0.5, amplitude_deg_s: 2.0}]}
  - {name: pair, manoeuvre: cruise, duration_s: 2.0, faults: [{kind: jam, sites: [r1, r2], onset_s: 1.0, amplitude_deg_s: 9.0}]}
"""


def write(folder, plugins, *, more=(), text=TEXT):
    """Campaign that flies plug-ins, given by name and text, and more designs."""
    (folder / "detectors").mkdir(parents=True, exist_ok=True)
    for name, body in plugins.items():
        (folder / "detectors" / f"{name}.py").write_text(HEAD + body)
        (folder / "detectors" / f"{name}.yaml").write_text(
            f"kind: {name}.py:Mine\nabout: a test\nsource: me\ntuned_on: null\ngains: {{}}\n"
        )
    path = folder / "opaque.yaml"
    path.write_text(text.replace("NAMES", ", ".join([*plugins, *more])))
    return path


def failing(wrong, condition="True"):
    """A detector that does this in flight."""
    return FAILING.replace("WRONG", wrong).replace("CONDITION", condition)
