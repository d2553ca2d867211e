"""Everything that can be traced, in one step: loop, detectors and their scores, ready for a kernel."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from fddbench.blocks.layout import Layout, Rows
from fddbench.blocks.linear import total
from fddbench.blocks.program import Program, trace
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Detector, Floats, Verdict
from fddbench.metrics.scoring import NEVER
from fddbench.runner.assembly import Assembly, Batch

__all__ = ["Fused", "checked", "detector_program", "why_opaque"]


def checked(verdict: Verdict, detector: Detector, n_sites: int, n_cases: int) -> Verdict:
    """The verdict itself, once its shapes and signals are right; nothing a detector returns is repaired.

    Raises
    ------
    DesignError
        The detector does not declare one row per site, its ratio is not one row, or it shows other signals than it
        announced.
    """
    shapes = tuple(np.shape(verdict.declared)), tuple(np.shape(verdict.ratio))
    if shapes != ((n_sites, n_cases), (n_cases,)):
        raise DesignError(
            f"a verdict needs declared of shape {(n_sites, n_cases)} and ratio of shape {(n_cases,)}, "
            f"got {shapes[0]} and {shapes[1]}"
        )
    if set(verdict.signals) != set(detector.recorded):
        raise DesignError(
            f"recorded announces {sorted(detector.recorded)}, the verdict shows {sorted(verdict.signals)}; make them equal"
        )
    return verdict


def detector_program(detector: Detector, bus: Bus) -> Program:
    """One step of a detector alone as a program with the inputs ``state`` and the signals of the bus.

    Raises
    ------
    Exception
        Whatever its step raises on traced values.
    """
    from types import SimpleNamespace

    def step(state: Rows, **signals: Rows) -> Mapping[str, Rows]:
        after, verdict = detector.step(state, SimpleNamespace(**signals))
        checked(verdict, detector, len(bus.sites), 1)
        return {"state": after, "declared": verdict.declared, "ratio": verdict.ratio, **verdict.signals}

    program = trace(step, state=detector.states.size, **bus.signals)
    if len(program.outputs["state"]) != detector.states.size:
        raise DesignError(
            f"the step gives {len(program.outputs['state'])} state rows, states has {detector.states.size}"
        )
    return program


def why_opaque(detector: Detector, bus: Bus) -> str:
    """Why a detector cannot be traced, in one line; "" when it can.

    A step that keeps something between two calls gives two different programs, and is opaque for that.
    """
    try:
        if detector_program(detector, bus).hash != detector_program(detector, bus).hash:
            return "its step keeps something between two calls"
    except Exception as error:  # a user's step may raise anything on values that are not arrays
        return " ".join(str(error).split()) or type(error).__name__
    return ""


class Fused:
    """Loop, traced detectors and scores as one step with one state.

    Parameters
    ----------
    assembly : Assembly
        What flies.
    detectors : sequence of str
        Names of those to fuse.
    """

    def __init__(self, assembly: Assembly, detectors: tuple[str, ...]) -> None:
        self.assembly, self.detectors = assembly, detectors
        loop, scoring = assembly.loop, assembly.scoring
        parts: dict[str, int] = {"loop": loop.states.size, "departed": 0}
        for i, name in enumerate(detectors):
            parts |= {f"detector_{i}": assembly.detectors[name].states.size, f"score_{i}": scoring.states.size}
        self.states = Layout(**{name: rows for name, rows in parts.items() if rows or name == "departed"})
        self.constants = Layout(loop=loop.constants.size, score=scoring.constants.size)
        self.n_normals = 4 * (len(loop.consumers) + len(loop.fault_consumers))

    def start(self, batch: Batch) -> tuple[Floats, Floats]:
        """State before sample 0 and constants of a batch."""
        n_cases = len(batch.cases)
        values: dict[str, Floats] = {"loop": batch.state, "departed": np.full(n_cases, NEVER)}
        for i, name in enumerate(self.detectors):
            values[f"detector_{i}"] = self.assembly.detectors[name].start(n_cases)
            values[f"score_{i}"] = self.assembly.scoring.start(n_cases)
        kept = {name: values[name] for name in self.states.fields}
        return self.states.pack(**kept), self.constants.pack(loop=batch.constants, score=batch.score_constants)

    def program(self) -> Program:
        """Traced step, with all there is to record as outputs."""
        return trace(self.step, state=self.states.size, constants=self.constants.size, normals=self.n_normals, sample=0)

    def step(self, state: Rows, constants: Rows, normals: Rows, sample: Any) -> Mapping[str, Rows]:
        """One sample of everything; outputs ``state``, ``finished``, ``departed`` and by their names all signals."""
        x, c = self.states.unpack(state), self.constants.unpack(constants)
        after, measured, truth, gone = self.assembly.loop.step(x.loop, c.loop, normals, sample)
        departed = np.where(gone, np.minimum(x.departed, sample), x.departed)
        values: dict[str, Rows] = {"loop": after, "departed": departed}
        outputs: dict[str, Rows] = {
            f"measured:{name}": getattr(measured, name) for name in self.assembly.loop.bus.signals
        }
        outputs |= {f"truth:{name}": value for name, value in truth.items()}
        for i, name in enumerate(self.detectors):
            detector_state = getattr(x, f"detector_{i}", state[:0])
            stepped, verdict = self.assembly.detectors[name].step(detector_state, measured)
            values[f"detector_{i}"] = stepped
            values[f"score_{i}"] = self.assembly.scoring.step(
                getattr(x, f"score_{i}"), verdict, c.score, sample, sample < departed
            )
            outputs |= {f"{name}:n_declared": total(verdict.declared * 1.0), f"{name}:ratio": verdict.ratio}
            outputs |= {f"{name}:{signal}": value for signal, value in verdict.signals.items()}
        kept = {name: values[name] for name in self.states.fields}
        finished = departed < NEVER
        return {"state": self.states.pack(**kept), "finished": finished, "departed": departed, **outputs}
