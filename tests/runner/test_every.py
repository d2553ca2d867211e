"""A design with `every: n` is the detector on a clock n times slower, its decision held between."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from fddbench import gallery
from fddbench.blocks.layout import Nothing
from fddbench.campaign.load import read_campaign
from fddbench.errors import CampaignError
from fddbench.interfaces import NEVER
from fddbench.runner.assembling import assemble
from fddbench.runner.flight import Flyer
from fddbench.runner.load import detector_load, in_words
from fddbench.runner.rows import rows_and_events

TEXT = """\
name: slow
benchmark: yaw_rate
seed: 5
duration_s: 2.5
detectors: [DETECTORS]
dispersions: {monte_carlo: {runs: 4, mass_kg: {uniform: [180000, 220000]}}}
scenarios:
  - {name: healthy, manoeuvre: roll_doublet}
  - {name: jam, manoeuvre: cruise, faults: [{kind: jam, sites: [r1, r2], onset_s: 1, amplitude_percent: {uniform: [0.2, 3]}}]}
"""
COUNTER = """\
from pydantic import BaseModel
from fddbench.interfaces import Verdict

class Counter:
    class Gains(BaseModel):
        limit_deg_s: float
    recorded = ("steps", "sample_s")
    BATCHED
    def __init__(self, gains, bus):
        self.gains, self.sample_s = gains, bus.sample_s
        self.watches = bus.redundant("r_deg_s")[:2]
    @classmethod
    def from_design(cls, gains, bus):
        return cls(gains, bus)
    def start(self):
        return {"steps": 0, "declared": [False, False]}
    def step(self, state, measured):
        state["steps"] += 1
        for i, rate in enumerate(measured.r_deg_s[:2]):
            state["declared"][i] |= bool(abs(rate - measured.r_deg_s[2]) > self.gains.limit_deg_s)
        shown = {"steps": state["steps"], "sample_s": self.sample_s}
        return state, Verdict(list(state["declared"]), abs(measured.r_deg_s[0]), signals=shown)
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Designs of several clocks."""
    folder = tmp_path_factory.mktemp("every")
    (folder / "detectors").mkdir()
    for name in ("sliding_mode_published", "cusum_example"):
        for every in (1, 2, 4, 0, 3):
            design = yaml.safe_load((gallery.folder("detectors") / f"{name}.yaml").read_text(encoding="utf-8"))
            text = yaml.safe_dump({**design, "every": every})
            (folder / "detectors" / f"{name[:5]}_{every}.yaml").write_text(text, encoding="utf-8")
    source = (gallery.folder("detectors") / "cusum_example.py").read_bytes()
    (folder / "detectors" / "cusum_example.py").write_bytes(source)
    (folder / "detectors" / "counter.py").write_text(COUNTER.replace("BATCHED", ""), encoding="utf-8")
    for every in (1, 4):
        text = f"kind: counter.py:Counter\nevery: {every}\nsource: me\ntuned_on: null\ngains: {{limit_deg_s: 0.3}}\n"
        (folder / "detectors" / f"counter_{every}.yaml").write_text(text, encoding="utf-8")
    return folder


def made(folder, *detectors):
    path = Path(folder) / "slow.yaml"
    path.write_text(TEXT.replace("DETECTORS", ", ".join(detectors)), encoding="utf-8")
    return assemble(read_campaign(path))


def rows(assembly):
    table = rows_and_events(Flyer(assembly), np.arange(assembly.plan.n_cases))[0].to_pandas()
    return {name: group.drop(columns="detector").reset_index(drop=True) for name, group in table.groupby("detector")}


def test_every_1_is_the_design_without_it(folder):
    found = rows(made(folder, "sliding_mode_published", "slidi_1"))
    assert found["slidi_1"].equals(found["sliding_mode_published"])


@pytest.mark.parametrize("name", ["slidi_2", "cusum_4", "counter_4"])
def test_is_the_detector_on_every_nth_sample(folder, name):
    """The same detector, stepped by hand on the recorded samples 0, n, 2n, …, decides the same there, and holds it."""
    assembly = made(folder, name)
    own = assembly.detectors[name]
    n, bus, batch = own.every, assembly.loop.bus, assembly.batch(np.arange(8))
    shown = [f"{name}:{signal}" for signal in ("n_declared", "alarm", "residual", *own.recorded)]
    flown = Flyer(assembly).fly(batch, [*shown, *(f"measured:{signal}" for signal in bus.signals)]).recorded
    assert getattr(own.detector, "sample_s", 0.01 * n) == 0.01 * n
    plain = own.at_every_sample
    states = (
        [own.detector.start() for _ in range(8)] if plain.one_by_one else plain.states.spread(plain.start(Nothing()), 8)
    )
    for sample in range(0, 251, n):
        held = {signal: flown[signal][sample : sample + n, 0] for signal in shown}
        assert all((values == values[0]).all() for values in held.values())
        if plain.one_by_one:
            assert (held[f"{name}:steps"][0] == sample // n + 1).all()
            continue
        now = {
            signal: flown[f"measured:{signal}"][sample] if count else flown[f"measured:{signal}"][sample, 0]
            for signal, count in bus.signals.items()
        }
        states, verdict = plain.step(states, Nothing(), None, SimpleNamespace(**now))
        expected = [verdict.declared.sum(axis=0), verdict.alarm, verdict.residual, *verdict.signals.values()]
        for values, expect in zip(held.values(), expected, strict=True):
            np.testing.assert_array_equal(values[0], expect)
    assert held[f"{name}:n_declared"].max() > 0.0


def test_the_same_bits_with_numpy_and_found_on_its_own_clock(folder):
    assembly = made(folder, "slidi_2", "cusum_4", "counter_4", "counter_1")
    batch = assembly.batch(np.arange(8))
    compiled, python = Flyer(assembly).fly(batch), Flyer(assembly, "numpy").fly(batch)
    for name, score in compiled.scores.items():
        np.testing.assert_array_equal(score, python.scores[name])
    for name, group in rows(assembly).items():
        n = assembly.detectors[name].every
        times = group["alarm_time_s"].dropna().to_numpy()
        assert len(times) > 2
        samples = np.round((times + 1.0) / 0.01)
        assert (samples < NEVER).all()
        assert (samples % n == 0).all()


def test_its_cost_is_spread_over_the_samples(folder):
    assembly = made(folder, "slidi_1", "slidi_2", "counter_4")
    one, two = (
        detector_load(assembly.detectors[name], assembly.loop.bus, timed=False) for name in ("slidi_1", "slidi_2")
    )
    assert two.flops_a_sample == two.cost.flops / 2 == one.cost.flops / 2
    assert "a step every 2 samples" in in_words(two)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        (
            "slidi_4",
            r"confirm_two_s = 0.1 falls between two samples of 0.04 s; the nearest are 0.08 and 0.12 .*every: 4",
        ),
        ("slidi_3", r"confirm_one_s = 1 .*; the nearest are 0.99 and 1.02 "),
        ("cusum_0", r"cusum_0.yaml:\d+:\d+: must be >= 1, got 0"),
    ],
)
def test_times_that_do_not_fit_its_clock_are_refused(folder, name, message):
    with pytest.raises(CampaignError, match=message):
        made(folder, name)
