"""Every shipped design scored as compiled C on a healthy and on a faulty flight: the bits of the engine."""

from dataclasses import replace
from itertools import groupby

import numpy as np
import pytest
from tests.exported.conftest import assembled, traceable

from fddbench.interfaces import NEVER
from fddbench.runner.flight import Flyer

pytestmark = pytest.mark.slow

_AFTER = 400
"""Samples that are flown after the onset of the fault; of a campaign without faults those from the start."""


def two_flights(assembly):
    """The first healthy and the first faulty flight of a campaign that can be flown, shortened."""
    found = {}
    for planned in assembly.plan.scenarios:
        batch = assembly.batch(np.array([planned.first_case]))
        if not batch.infeasible_reason[0]:
            found.setdefault(bool(planned.faults), planned.first_case)
    batch = assembly.batch(np.array(sorted(found.values())))
    onsets = batch.faults.first[np.isfinite(batch.faults.first) & (batch.faults.first < NEVER)]
    return assembly.shortened(batch, onsets.max(initial=0.0) + _AFTER)


def test_every_design_gives_equal_scores():
    designs = sorted(traceable().values())
    flown = 0
    for campaign, group in groupby(designs, key=lambda at: at[0]):
        whole = assembled(campaign)
        own = replace(whole, detectors={name: whole.detectors[name] for _, name in group})
        batch = two_flights(own)
        engine, c = Flyer(own).fly(batch), Flyer(own, "auto+c").fly(batch)
        for name in own.detectors:
            assert not any(c.errors[name]), (name, c.errors[name])
            assert c.scores[name].tobytes() == engine.scores[name].tobytes(), name
            flown += 1
    assert flown == len(designs) >= 69
