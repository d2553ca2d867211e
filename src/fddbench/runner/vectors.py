"""A thousand samples of a flight around its first fault: what the self-test of an exported detector is fed with."""

import numpy as np

from fddbench.errors import DesignError
from fddbench.interfaces import NEVER, Floats
from fddbench.runner.assembly import Assembly
from fddbench.runner.flight import Flyer

__all__ = ["flown_samples"]

SAMPLES = 1000
_BEFORE = 300


def flown_samples(assembly: Assembly, every: int = 1, samples: int = SAMPLES) -> dict[str, Floats]:
    """Measured signals of one flight, (n_samples, n_rows) each, every n-th sample, from some before its first fault on.

    Raises
    ------
    DesignError
        No flight of the campaign can be flown.
    """
    plan = assembly.plan
    faulty = [each for each in plan.scenarios if each.faults] or list(plan.scenarios)
    for planned in faulty:
        batch = assembly.batch(np.array([planned.first_case]))
        if not batch.infeasible_reason[0]:
            break
    else:
        raise DesignError(f"no flight of {plan.campaign.path} can be flown, so there is nothing to make vectors of")
    names = tuple(assembly.loop.bus.signals)
    parts: dict[str, list[Floats]] = {name: [] for name in names}
    for _, tape, _ in Flyer(assembly).stretches(batch, [f"measured:{name}" for name in names]):
        for name in names:
            parts[name].append(tape[f"measured:{name}"][:, :, 0])
    whole = {name: np.concatenate(rows) for name, rows in parts.items()}
    flown = np.flatnonzero(np.all([np.isfinite(rows).all(axis=1) for rows in whole.values()], axis=0))
    whole = {name: rows[flown][::every] for name, rows in whole.items()}
    onset = float(batch.faults.k0[0])
    n = len(next(iter(whole.values())))
    first = max(0, min(int(onset / every) - _BEFORE, n - samples)) if onset < NEVER else 0
    return {name: rows[first : first + samples] for name, rows in whole.items()}
