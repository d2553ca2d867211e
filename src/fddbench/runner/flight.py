"""Flies a batch with NumPy, sample by sample, all cases side by side: the reference path."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fddbench.interfaces import Detector, Floats, Verdict
from fddbench.metrics.scoring import NEVER
from fddbench.runner.assembly import Assembly, Batch

__all__ = ["Outcome", "Recorder", "fly"]

_TILE = 50
"""Samples whose random numbers are drawn together; no part of any result."""

Recorder = Callable[[int, Any, Mapping[str, Floats], Mapping[str, Verdict]], None]
"""Called every sample with the sample number, the measured bus, the truth and the verdicts."""


@dataclass(kw_only=True, eq=False)
class Outcome:
    """What is known of a batch after the flight.

    Attributes
    ----------
    batch : Batch
        Cases.
    scores : dict of str to (n_score, n_cases) arrays
        Final score state by detector.
    departed : (n_cases,) array
        Sample at which the flight departed, `NEVER` if it did not.
    errors : dict of str to list of str
        By detector, what its step raised for each case ("": nothing).
    """

    batch: Batch
    scores: dict[str, Floats]
    departed: Floats
    errors: dict[str, list[str]] = field(default_factory=dict)


def fly(assembly: Assembly, batch: Batch, recorder: Recorder | None = None) -> Outcome:
    """Fly all cases of a batch to the end of the longest.

    A detector whose step raises is flown again case by case, so that a case's row does not depend on its company.
    """
    outcome, raised = _fly(assembly, batch, assembly.detectors, recorder)
    n_cases = len(batch.cases)
    for name, message in raised.items():
        if n_cases == 1:
            outcome.errors[name] = [message]
            continue
        alone = {name: assembly.detectors[name]}
        parts = [_fly(assembly, batch.take(np.array([i])), alone, None) for i in range(n_cases)]
        outcome.scores[name] = np.concatenate([part.scores[name] for part, _ in parts], axis=1)
        outcome.errors[name] = [texts.get(name, "") for _, texts in parts]
    return outcome


def _fly(
    assembly: Assembly, batch: Batch, detectors: Mapping[str, Detector], recorder: Recorder | None
) -> tuple[Outcome, dict[str, str]]:
    """Scores of the detectors, and what those raised that gave up."""
    n_cases = len(batch.cases)
    loop, scoring = assembly.loop, assembly.scoring
    state, departed = batch.state, np.full(n_cases, NEVER)
    states = {name: detector.start(n_cases) for name, detector in detectors.items()}
    scores = {name: scoring.start(n_cases) for name in detectors}
    raised: dict[str, str] = {}
    last = int(scoring.constants.unpack(batch.score_constants).last.max())
    with np.errstate(all="ignore"):
        for first in range(0, last + 1, _TILE):
            normals = assembly.normals(batch, first, min(_TILE, last + 1 - first))
            for j, drawn in enumerate(normals):
                sample = float(first + j)
                state, measured, truth, gone = loop.step(state, batch.constants, drawn, sample)
                departed = np.where(gone, np.minimum(departed, sample), departed)
                verdicts: dict[str, Verdict] = {}
                for name, detector in detectors.items():
                    if name in raised:
                        continue
                    try:
                        states[name], verdict = detector.step(states[name], measured)
                        scores[name] = scoring.step(
                            scores[name], verdict, batch.score_constants, sample, sample < departed
                        )
                        verdicts[name] = verdict
                    except Exception as error:  # a user's detector may raise anything; it becomes a row
                        raised[name] = f"{type(error).__name__}: {error}"
                if recorder is not None:
                    recorder(first + j, measured, truth, verdicts)
    return Outcome(batch=batch, scores=scores, departed=departed), raised
