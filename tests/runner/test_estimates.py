"""What an estimate is scored against: what the faults really add, which reaches the scores and never a detector."""

from dataclasses import replace

import numpy as np
import pytest
from tests.runner.conftest import TEXT, write
from tests.runner.test_engine import WithIf

from fddbench.api import flights
from fddbench.blocks import llvm
from fddbench.campaign.load import read_campaign
from fddbench.designs.adapted import Adapted
from fddbench.errors import DesignError, FddbenchError
from fddbench.runner.assembling import assemble
from fddbench.runner.flight import Flyer

CALM = """\
name: calm
benchmark: yaw_rate
sensors: ideal
seed: 3
duration_s: 4.0
detectors: [sliding_mode_published]
scenarios:
  - name: several
    manoeuvre: roll_doublet
    faults:
      - {kind: bias, sites: [r1, r2], onset_s: 1.0, amplitude_deg_s: 2.0, end_s: 2.5}
      - {kind: jam, mode: replace, freeze: true, sites: [r1], onset_s: 2.0}
      - {kind: noise, sites: [r3], onset_s: 1.5, variance_deg2_s2: 1.0}
      - {kind: runaway, sites: [r2], onset_s: 2.0, rate_deg_s2: 900.0}
  - {name: healthy, manoeuvre: roll_doublet}
"""


@pytest.fixture
def calm(tmp_path):
    (tmp_path / "calm.yaml").write_text(CALM)
    return assemble(read_campaign(tmp_path / "calm.yaml"))


def test_what_is_added_is_the_reading_minus_the_healthy_one(calm):
    """Without noise a healthy sensor reads the true rate, whatever faults and stops stand one behind the other."""
    names = ["measured:r_deg_s", "truth:r_true_deg_s", "measured:r_voted_deg_s", "voted:r_voted_deg_s", "added"]
    found = Flyer(calm, "numpy").fly(calm.batch(np.array([0])), names).recorded
    rates, true, voted, error, added = (found[name][:, :, 0] for name in names)
    np.testing.assert_allclose(added, rates - true, atol=1e-12)
    np.testing.assert_allclose(error, voted - true, atol=1e-12)
    assert (added[:100] == 0.0).all()
    np.testing.assert_allclose(added[100:200, :2], 2.0, atol=1e-12)
    assert np.abs(added[150:, 2]).max() > 1.0
    assert rates[-1, 1] == 128.0
    healthy = Flyer(calm, "numpy").fly(calm.batch(np.array([1])), names).recorded
    assert not healthy["added"].any()


def test_detectors_see_nothing_of_it(calm):
    seen = set()

    class Curious(WithIf):
        estimates = "r_voted_deg_s"

        def step(self, x, measured):
            seen.update(vars(measured))
            return super().step(x, measured)

    calm.detectors["sliding_mode_published"] = Curious.around(calm.detectors["sliding_mode_published"])
    Flyer(calm).fly(calm.batch(np.array([0])))
    assert seen == set(calm.loop.bus.signals)


@pytest.mark.skipif(not llvm.available(), reason="no llvmlite")
def test_an_opaque_detector_is_scored_by_the_same_truth(tmp_path):
    """Traced, in Python beside compiled code, and in plain NumPy: the same bits of the sums."""
    found = {}
    for way in ("compiled", "numpy", "opaque"):
        assembly = assemble(read_campaign(write(tmp_path, TEXT)))
        name = "sliding_mode_published"
        if way == "opaque":
            assembly.detectors[name] = WithIf.around(assembly.detectors[name])
        flyer = Flyer(assembly, "numpy" if way == "numpy" else "llvm")
        found[way] = flyer.fly(assembly.batch(np.arange(8, 40, 3))).scores[name]
        assert bool(flyer.opaque) == (way == "opaque")
    assert found["compiled"].tobytes() == found["numpy"].tobytes() == found["opaque"].tobytes()


def test_an_estimate_that_nobody_announced_and_one_that_is_missing_are_refused(calm):
    adapted, batch = calm.detectors["sliding_mode_published"], calm.batch(np.array([0]))
    for estimates in (None, "sites"):

        class Other(WithIf):
            pass

        Other.estimates = estimates
        calm.detectors["sliding_mode_published"] = Adapted(Other(adapted), adapted.bus)
        reason = "estimate of shape (3, 1)" if estimates else "a detector that gives an estimate says of what"
        error = Flyer(calm, "numpy").fly(batch).errors["sliding_mode_published"][0]
        assert reason in error
    silent = Adapted(Silent(adapted.detector), adapted.bus)
    inputs = silent_inputs(calm, silent)
    with pytest.raises(DesignError, match="one that says so gives it"):
        silent.step(*inputs)


class Silent:
    """Announces an estimate and gives none."""

    estimates = "r_voted_deg_s"

    def __init__(self, inner):
        self.inner, self.states, self.recorded, self.watches = inner, inner.states, inner.recorded, inner.watches

    def start(self):
        return self.inner.start(None)

    def step(self, x, measured):
        after, verdict = self.inner.step(x, None, None, measured)
        return after, replace(verdict, estimate=None)


def silent_inputs(assembly, detector):
    batch = assembly.batch(np.array([0]))
    loop = assembly.loop
    x, c = loop.states.unpack(batch.state), loop.constants.unpack(batch.constants)
    drawn = loop.draws.unpack(assembly.normals(loop.draws, batch, 0, 1)[0])
    _, seen = loop.step(x, c, drawn, np.float64(0.0))
    return detector.states.spread(detector.start(None), 1), None, None, seen.measured


def test_declarations_and_estimates_of_ones_own_are_scored_like_a_detectors(tmp_path):
    """An oracle that copies the truth is right at once and without error; its bias is what is put on top."""
    (tmp_path / "calm.yaml").write_text(CALM)
    campaign = read_campaign(
        tmp_path / "calm.yaml", ["scenarios.0.faults=[{kind: bias, sites: [r1], onset_s: 1.0, amplitude_deg_s: 2.0}]"]
    )
    n = 401
    declared, size = np.zeros((n, 3, 1)), np.zeros((n, 3, 1))
    declared[100:, 0], size[100:, 0] = 1.0, 2.25
    (row,) = flights.score(campaign, ["several/0/0/0"], declared, estimate=size, name="oracle").to_dict("records")
    assert (row["outcome"], row["detection_time_s"], row["detector"]) == ("right", 0.0, "oracle")
    assert (row["estimate_bias"], row["estimate_rms"]) == (pytest.approx(0.25, abs=1e-9), pytest.approx(0.25, abs=1e-9))
    voted = np.zeros((n, 1))
    (row,) = flights.score(campaign, ["several/0/0/0"], declared, estimate=voted, estimates="r_voted_deg_s").to_dict(
        "records"
    )
    assert row["estimate_rms"] < 1.0
    (row,) = flights.score(campaign, ["several/0/0/0"], None, alarm=declared[:, 0], watches=["r2"]).to_dict("records")
    assert (row["outcome"], row["isolated"], row["watched"]) == ("right", None, False)
    with pytest.raises(FddbenchError, match="does not say what is true of it"):
        flights.score(campaign, ["several/0/0/0"], declared, estimate=voted, estimates="r_vote_deg_s")
    with pytest.raises(FddbenchError, match="give declared, alarm, or both"):
        flights.score(campaign, ["several/0/0/0"], None)
