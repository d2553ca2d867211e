"""Failure is data: what a detector or a flight does wrong is a row with a status, and no other row knows."""

from dataclasses import replace

import numpy as np
import pytest
from tests.runner.conftest import TEXT, write

from fddbench.blocks.layout import Nothing
from fddbench.campaign.load import read_campaign
from fddbench.designs.adapted import Adapted
from fddbench.runner.assembling import assemble
from fddbench.runner.flight import Flyer
from fddbench.runner.rows import rows_and_events


class Faulty:
    """Wraps a detector and does something wrong with it."""

    batched = True

    def __init__(self, inner, wrong):
        self.inner, self.wrong, self.states, self.recorded = inner, wrong, inner.states, inner.recorded

    def start(self):
        return self.inner.start(Nothing())

    def step(self, x, measured):
        after, verdict = self.inner.step(x, Nothing(), Nothing(), measured)
        return after, self.wrong(verdict, measured)


def _raise_for_heavy(verdict, measured):
    if (measured.mass_kg > 200e3).any():
        raise ValueError("too heavy for me")
    return verdict


def _nan(verdict, measured):
    return replace(verdict, residual=np.where(measured.mass_kg > 200e3, np.nan, verdict.residual))


def _flown_by(flyer):
    rows, events = rows_and_events(flyer, np.arange(flyer.assembly.plan.n_cases))
    return rows.to_pylist(), events.to_pylist()


def _flown(assembly, wrong, backend):
    monitor = assembly.detectors["voting_monitor"]
    detectors = {**assembly.detectors, "wrong": Adapted(Faulty(monitor, wrong), monitor.bus)}
    broken = replace(assembly, detectors=detectors)
    return _flown_by(Flyer(broken, backend))


@pytest.fixture(scope="module")
def sound(assembly):
    return _flown_by(Flyer(assembly))[0]


@pytest.mark.parametrize("backend", ["auto", "numpy"])
@pytest.mark.parametrize(
    ("wrong", "status", "reason"), [(_raise_for_heavy, "error", "ValueError: too heavy"), (_nan, "nonfinite", "finite")]
)
def test_a_wrong_detector_is_a_status_of_its_own_rows_only(assembly, sound, wrong, status, reason, backend):
    rows, events = _flown(assembly, wrong, backend)
    mine = [row for row in rows if row["detector"] == "wrong"]
    heavy = [row["p_mass_kg"] * (1 + row["p_mass_error_percent"] / 100) > 200e3 for row in mine]
    for row, is_heavy in zip(mine, heavy, strict=True):
        if row["status"] == "infeasible":
            continue
        assert row["status"] == (status if is_heavy else "ok")
        if is_heavy:
            assert reason in row["reason"]
            assert row["n_declared"] is None
            assert row["detection_time_s"] is None
    assert any(heavy)
    assert not all(heavy)
    assert [row for row in rows if row["detector"] != "wrong"] == sound
    assert all(event["outcome"] is None for event in events if event["status"] != "ok")


@pytest.mark.parametrize("backend", ["auto", "numpy"])
def test_a_flight_that_departs_is_scored_up_to_there(tmp_path, backend):
    # gusts of 60 m/s, one sigma: no law can hold that
    text = TEXT.replace("wind: light", "wind: severe").replace("duration_s: 3.0", "duration_s: 20.0")
    text = text.replace("gust_scale_ratio: {uniform: [0.0, 0.3]}", "gust_scale_ratio: {uniform: [9.0, 10.0]}")
    assembly = assemble(read_campaign(write(tmp_path, text)))
    rows, _ = _flown_by(Flyer(assembly, backend))
    departed = [row for row in rows if row["departed_s"] is not None]
    assert departed
    assert {row["status"] for row in rows} <= {"ok", "infeasible"}
    for row in departed:
        assert row["flight_s"] == pytest.approx(row["departed_s"] - 0.01)
        assert row["outcome"] is not None
