"""A scheduling in a file beside a design: it flies compiled, travels with the results, and is part of what they belong to."""

import pytest
import yaml

import fddbench
from fddbench import gallery
from fddbench.campaign.load import read_campaign
from fddbench.errors import FddbenchError
from fddbench.results.fingerprint import Fingerprint
from fddbench.results.folder import provenance_of
from fddbench.runner.assembling import assemble
from fddbench.runner.run import run_campaign

MINE = """\
from fddbench.scheduling.b747 import B747


class Mine:
    about, signals, parameters = "the shipped one, brought along", B747.signals, B747.parameters

    def rho(self, measured):
        return B747().rho(measured)
"""
CAMPAIGN = {
    "name": "own", "benchmark": "b747_longitudinal", "seed": 4, "duration_s": 7.0, "detectors": ["own", "lpv_filter_fold"],
    "scenarios": [{"name": "healthy", "manoeuvre": "elevator_pulse"}],
}  # fmt: skip


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "detectors").mkdir()
    (tmp_path / "detectors" / "mine.py").write_text(MINE)
    design = yaml.safe_load((gallery.folder("detectors") / "lpv_filter_fold.yaml").read_text())
    design["gains"]["scheduling"] = "mine.py:Mine"
    (tmp_path / "detectors" / "own.yaml").write_text(yaml.safe_dump(design))
    (tmp_path / "c.yaml").write_text(yaml.safe_dump(CAMPAIGN))
    return tmp_path


def test_it_flies_as_the_shipped_one_and_travels(folder):
    campaign = read_campaign(folder / "c.yaml")
    assert assemble(campaign).detectors["own"].opaque == ""
    run_campaign(campaign, folder / "results", jobs=1)
    rows = fddbench.load(folder / "results").set_index("detector")
    assert rows.loc["own", "margin_healthy"] == rows.loc["lpv_filter_fold", "margin_healthy"] > 0.0
    assert (folder / "results" / "detectors" / "mine.py").read_text() == MINE
    assert "detectors/mine.py" in Fingerprint.of(provenance_of(folder / "results")).files
    (folder / "detectors" / "mine.py").unlink()  # replay reads what has travelled
    assert fddbench.signals(folder / "results", "healthy").detectors["own"]["estimate_elevator_deg"].shape == (701, 1)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("def rho", "def row", "is no scheduling: it has no rho"),
        ("B747.signals", "('mach',)", "needs the signals .'mach'."),
        ("B747.parameters", "('q_pa',)", r"bend has 10 matrices for 1 scheduling parameters; it needs 1 or 2"),
    ],
)
def test_one_that_does_not_fit_is_refused(folder, old, new, message):
    (folder / "detectors" / "mine.py").write_text(MINE.replace(old, new))
    with pytest.raises(FddbenchError, match=message):
        assemble(read_campaign(folder / "c.yaml"))
