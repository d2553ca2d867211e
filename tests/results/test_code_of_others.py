"""Code that is not ours: packages that register kinds, files beside a campaign, and what they read and import."""

import importlib
import json
import shutil
import sys
from importlib.metadata import EntryPoint, version

import pytest
from tests.results.conftest import TEXT, fly

from fddbench import kinds, load, report, sources
from fddbench.campaign.load import read_campaign
from fddbench.errors import ResultsError
from fddbench.runner.fingerprint import fingerprint_of

DETECTOR = """\
import numpy as np
from pydantic import BaseModel
from fddbench.blocks.layout import Layout, record
from fddbench.interfaces import Verdict
{more}

class Gains(BaseModel):
    limit: float

@record
class Latched:
    declared: object

class Net:
    "A net of one weight."
    about, recorded, Gains = "net", (), Gains
    def __init__(self, gains):
        self.gains, self.states = gains, Layout(Latched(declared=3))
    @classmethod
    def from_design(cls, gains, bus):
        return cls(gains)
    def start(self):
        return Latched(declared=0.0)
    def step(self, x, measured):
        r = np.abs(measured.r_deg_s - measured.r_voted_deg_s) * WEIGHT / self.gains.limit
        declared = np.where(r > 1.0, 1.0, x.declared)
        return Latched(declared=declared), Verdict(declared, np.maximum(np.maximum(r[0], r[1]), r[2]))
"""
DESIGN = "kind: {kind}\nabout: a net\nsource: ours\ntuned_on: null\ngains: {{limit: 0.3}}\n"


@pytest.fixture
def beside(tmp_path):
    """Folder of a campaign with a detector in a file; how to read it."""
    (tmp_path / "detectors").mkdir()
    (tmp_path / "small.yaml").write_text(TEXT.replace("voting_monitor", "net"))

    def read(kind="net.py:Net", **files):
        (tmp_path / "detectors" / "net.yaml").write_text(DESIGN.format(kind=kind))
        for name, content in files.items():
            (tmp_path / "detectors" / name.replace("_py", ".py")).write_text(content)
        return read_campaign(tmp_path / "small.yaml")

    read.folder = tmp_path / "detectors"
    return read


def weights(path, value):
    import numpy as np

    np.save(path, np.full(2, value))


READS = DETECTOR.format(
    more="from pathlib import Path\nWEIGHT = float(np.load(Path(__file__).parent / 'weights.npy')[0])"
)


def test_weights_beside_a_plugin_travel_and_belong(beside, tmp_path):
    weights(beside.folder / "weights.npy", 1.0)
    out = tmp_path / "out"
    fly(beside(net_py=READS), out)
    assert (out / "detectors" / "weights.npy").read_bytes() == (beside.folder / "weights.npy").read_bytes()
    weights(beside.folder / "weights.npy", 2.0)
    with pytest.raises(ResultsError, match=r"(?s)another campaign:\n  the file detectors/weights.npy is not the same"):
        fly(beside(), out)
    shutil.rmtree(beside.folder)
    assert report(out).is_file()
    weights(out / "detectors" / "weights.npy", 3.0)
    with pytest.raises(ResultsError, match=r"weights.npy is not the file of these results"):
        report(out)


def test_a_module_beside_a_plugin_travels_and_belongs(beside, tmp_path):
    out, text = tmp_path / "out", DETECTOR.format(more="from helper import WEIGHT")
    fly(beside(net_py=text, helper_py="WEIGHT = 1.0"), out)
    assert (out / "detectors" / "helper.py").read_text() == "WEIGHT = 1.0"
    with pytest.raises(ResultsError, match=r"the file detectors/helper.py is not the same"):
        fly(beside(helper_py="WEIGHT = 2.0"), out)
    shutil.rmtree(beside.folder)
    assert report(out).is_file()


def test_a_module_beside_a_plugin_travels_from_a_notebook_too(beside, monkeypatch):
    """It has the folder that it works in on its path."""
    monkeypatch.syspath_prepend(beside.folder)
    campaign = beside(net_py=DETECTOR.format(more="from helper import WEIGHT"), helper_py="WEIGHT = 1.0")
    assert "detectors/helper.py" in campaign.files()


def test_a_file_with_any_name_travels(beside, tmp_path):
    text = READS.replace("Path(__file__).parent / 'weights.npy'", "Path(__file__).parent / 'our weights.v1..npy'")
    weights(beside.folder / "our weights.v1..npy", 1.0)
    campaign = beside(net_py=text)
    assert [fly(campaign, tmp_path / "out").flights for _ in range(2)] == [12, 0]
    assert fly(campaign, tmp_path / "out", fresh=True).flights == 12


def test_two_designs_on_equal_files_of_two_names(beside, tmp_path):
    text = DETECTOR.format(more="WEIGHT = 1.0")
    beside(net_py=text)
    (beside.folder / "other.py").write_text(text)
    (beside.folder / "other.yaml").write_text(DESIGN.format(kind="other.py:Net"))
    (tmp_path / "small.yaml").write_text(TEXT.replace("voting_monitor", "net, other"))
    campaign = read_campaign(tmp_path / "small.yaml")
    assert {"detectors/net.py", "detectors/other.py"} <= campaign.files().keys()


def test_what_a_plugin_imports_is_named(beside):
    plain = fingerprint_of(beside(net_py=DETECTOR.format(more="WEIGHT = 1.0")))
    with_scipy = fingerprint_of(beside(net_py=DETECTOR.format(more="import scipy.signal\nWEIGHT = 1.0")))
    assert "scipy" not in plain.libraries
    assert with_scipy.libraries["scipy"] == version("scipy")
    assert all(name.startswith("fddbench/") for name in with_scipy.source)


@pytest.fixture
def package(tmp_path, monkeypatch):
    """Package `fddplug` of one's own that registers the detector `ep`; how to change it."""
    root = tmp_path / "installed"
    (root / "fddplug").mkdir(parents=True)
    (root / "fddplug" / "__init__.py").write_text("")
    monkeypatch.syspath_prepend(root)
    known = kinds.registered("detector")
    own = {"ep": EntryPoint("ep", "fddplug.det:Net", "fddbench.detectors")}
    monkeypatch.setattr(kinds, "registered", lambda family: known | own if family == "detector" else {})
    real = {family: dict(kinds_of) for family, kinds_of in ((f, _registered(f)) for f in kinds.FAMILIES)}
    monkeypatch.setattr(kinds, "registered", lambda f: real[f] | own if f == "detector" else real[f])

    def write(**files):
        for name, text in files.items():
            (root / "fddplug" / name.replace("_py", ".py")).write_text(text)
        for name in [name for name in sys.modules if name.split(".")[0] in ("fddplug", "fddhelp")]:
            del sys.modules[name]  # as in a process of its own
        importlib.invalidate_caches()

    write.root = root
    write(det_py=DETECTOR.format(more="WEIGHT = 1.0"))
    yield write
    write()


def _registered(family):
    from importlib.metadata import entry_points

    return {point.name: point for point in entry_points(group=f"fddbench.{family}s")}


def test_the_code_of_a_package_belongs(package, beside, tmp_path):
    out = tmp_path / "out"
    fly(beside(kind="ep"), out)
    assert "fddplug" in json.loads((out / "provenance.json").read_text())["source"]
    package(det_py=DETECTOR.format(more="WEIGHT = 2.0"))
    with pytest.raises(ResultsError, match=r"(?s)another program:\n  other source code of fddplug\n"):
        fly(beside(kind="ep"), out)
    fly(beside(kind="ep"), out, fresh=True)
    assert len(load(out)) == 12
    package(det_py=DETECTOR.format(more="WEIGHT = 1.0"))
    with pytest.raises(ResultsError, match="other source code of fddplug"):
        fly(beside(kind="ep"), out)


def test_so_do_its_data_and_what_it_imports_from_where_somebody_works(package, beside):
    package(det_py=DETECTOR.format(more="from fddhelp import WEIGHT"), table_txt="1")
    (package.root / "fddhelp.py").write_text("WEIGHT = 1.0")
    first = fingerprint_of(beside(kind="ep"))
    assert {"fddplug", "fddhelp"} <= first.source.keys()
    (package.root / "fddhelp.py").write_text("WEIGHT = 2.0")
    package()
    second = fingerprint_of(beside(kind="ep"))
    assert [name for name in second.source if second.source[name] != first.source.get(name)] == ["fddhelp"]
    package(table_txt="2")
    third = fingerprint_of(beside(kind="ep"))
    assert [name for name in third.source if third.source[name] != second.source[name]] == ["fddplug"]


def test_code_in_memory_is_not_taken_for_what_its_file_has_become(package, beside):
    campaign = beside(kind="ep")
    first = fingerprint_of(campaign)
    (package.root / "fddplug" / "det.py").write_text(DETECTOR.format(more="WEIGHT = 3.0"))
    assert fingerprint_of(beside(kind="ep")) == first


def test_a_package_that_is_not_used_is_no_part(package, beside):
    assert "fddplug" not in fingerprint_of(beside(net_py=DETECTOR.format(more="WEIGHT = 1.0"))).source


def test_the_program_is_what_decides_rows():
    rooms = {name.removeprefix("fddbench/") for name in sources.own()}
    assert {"benchmarks", "blocks", "campaign", "detection", "faults", "metrics", "runner", "kinds.py"} <= rooms
    assert not rooms & {"cli", "api", "reporting", "design", "testing", "gallery", "__pycache__"}


def test_a_line_ends_alike_on_every_system(tmp_path):
    files = []
    for name, text in (("a", b"x = 1\n"), ("b", b"x = 1\r\n"), ("c", b"x = 2\n")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "m.py").write_bytes(text)
        files.append(sources._digest(tmp_path / name, [tmp_path / name / "m.py"]))
    assert files[0] == files[1] != files[2]
