"""What a campaign would do, before it burns an hour of two processors."""

from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from fddbench.api.campaigns import read
from fddbench.campaign.check import describe, duration, estimated_seconds
from fddbench.designs.adapted import Adapted
from fddbench.runner.assembling import assemble
from fddbench.runner.chunks import CHUNK, COMPILED_CHUNK, OPAQUE_CHUNK
from fddbench.runner.firsts import first_samples
from fddbench.runner.flight import Flyer
from fddbench.runner.load import seconds_in_python

__all__ = ["described"]

# measured: compiled code flies some 1e7 samples a second on one core, after a start of about 1 s
_COMPILED_S, _NUMPY_S, _NUMPY_CALL_S = 1e-7, 1e-6, 1e-3
_TIMED, _JOBS = 60, 2
"""Samples that an opaque detector is timed on, and workers of the estimate."""


def described(path: str | Path, overrides: Sequence[str] = ()) -> str:
    """Text of what would fly, which detectors fly in Python, and how long it takes here.

    Raises
    ------
    CampaignError
        Every mistake in the campaign and its designs.
    """
    assembly = assemble(read(path, overrides))
    plan, compiled = assembly.plan, Flyer(assembly).compiled
    each_s, together_s = (_COMPILED_S, 0.0) if compiled else (_NUMPY_S, _NUMPY_CALL_S)
    opaque = {name: own for name, own in assembly.detectors.items() if own.opaque}
    alone = any(own.one_by_one for own in opaque.values())
    chunk = min(
        OPAQUE_CHUNK if alone else COMPILED_CHUNK if compiled else CHUNK, max(s.n_cases for s in plan.scenarios)
    )
    large = getattr(assembly.loop, "in_python", "")
    notes = [f"All fly in Python: {large}"] if large else []
    for name, own in opaque.items():
        seconds = _timed(own, first_samples(assembly, _TIMED, 3 if own.one_by_one else chunk))
        if own.one_by_one:
            own_s = estimated_seconds(plan, seconds_per_flight_step=seconds, overhead_s=0.0, jobs=_JOBS)
            each_s += seconds
        else:
            own_s = estimated_seconds(plan, seconds_per_flight_step=0.0, overhead_s=seconds, chunk=chunk, jobs=_JOBS)
            together_s += seconds
        notes.append(_note(name, own, seconds, own_s, commands=name == assembly.commander))
    return describe(plan, seconds_per_flight_step=each_s, overhead_s=together_s, chunk=chunk, jobs=_JOBS, notes=notes)


def _timed(detector: Adapted, samples: Sequence[SimpleNamespace]) -> float:
    """Time of a step [s]; 0 where no flight can be flown, or all raise: then nothing is flown for long."""
    seconds = seconds_in_python(detector, samples) if samples else 0.0
    return seconds if np.isfinite(seconds) else 0.0


def _note(name: str, detector: Adapted, seconds: float, total_s: float, *, commands: bool) -> str:
    """What a detector in Python costs; one that `commands` takes the aircraft with it."""
    how = "one flight at a time" if detector.one_by_one else "many flights side by side"
    how += " with the aircraft that acts on it" if commands else ""
    per = "sample" if detector.one_by_one else "sample and chunk"
    return (
        f"{name} is opaque and flies in Python, {how}, {1e3 * seconds:.2g} ms a {per}: {duration(total_s)} with {_JOBS} jobs; "
        f"{detector.opaque}"
    )
