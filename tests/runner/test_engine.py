"""Contract: compiled code, the interpreter and plain NumPy give the same bits, for every benchmark and every design."""

import numpy as np
import pytest
import yaml
from tests.runner.conftest import TEXT, write

from fddbench import gallery, kinds
from fddbench.blocks import kernel, llvm
from fddbench.blocks.layout import Nothing, mapped
from fddbench.campaign.load import read_campaign
from fddbench.designs.adapted import Adapted
from fddbench.designs.tracing import why_opaque
from fddbench.errors import FddbenchError
from fddbench.metrics.scoring import NEVER
from fddbench.runner.assembling import assemble
from fddbench.runner.eager import fly_eagerly
from fddbench.runner.flight import Flyer
from fddbench.runner.fused import Fused
from fddbench.runner.rows import rows_and_events

needs_llvm = pytest.mark.skipif(not llvm.available(), reason="llvmlite is not installed")
_FILES = {path: yaml.safe_load(path.read_text(encoding="utf-8")) for path in gallery.folder("campaigns").glob("*.yaml")}
# of each benchmark the first file by the alphabet that flies its default plant: other plants have such a test of their own
CAMPAIGNS = {
    _FILES[path]["benchmark"]: path for path in sorted(_FILES, key=lambda of: ("plant" in _FILES[of], of), reverse=True)
}
DESIGNS = sorted(path.stem for path in gallery.folder("detectors").glob("*.yaml"))


def test_every_benchmark_has_a_campaign():
    assert set(CAMPAIGNS) == set(kinds.known("benchmark"))


def _all_designs(benchmark):
    """Assembly of a few short flights of every scenario with all designs that this benchmark can feed."""
    path, fitting = CAMPAIGNS[benchmark], []
    for name in DESIGNS:
        try:
            assemble(read_campaign(path, [f"detectors=[{name}]", "reconfigure=null"]))
        except FddbenchError:
            continue
        fitting.append(name)
    return assemble(read_campaign(path, [f"detectors=[{', '.join(fitting)}]", "reconfigure=null"])), fitting


@pytest.fixture(scope="module", params=sorted(CAMPAIGNS))
def chunk(request):
    """Fused program, start and addresses of 11 cases from all scenarios."""
    assembly, fitting = _all_designs(request.param)
    cases = np.unique(np.linspace(0, assembly.plan.n_cases - 1, 11).astype(np.int64))
    batch = assembly.batch(cases)
    batch = batch.take(np.flatnonzero([reason == "" for reason in batch.infeasible_reason]))
    fused = Fused.of(assembly, tuple(fitting))
    addresses = kernel.Addresses(
        key=assembly.plan.campaign.seed, run=batch.run, flight=assembly.plan.stream, scenario=batch.scenario_stream
    )
    return assembly, batch, fused, addresses


def _flown(chunk, *, samples=250, **options):
    _, batch, fused, addresses = chunk
    state, constants = fused.packed(batch)
    built = kernel.build(fused.program(), streams=fused.draws.streams, **options)
    each = np.full(len(batch.cases), samples, dtype=np.int64)
    return built.fly(state, constants, each, addresses, first=0, end=samples).state


@pytest.fixture(scope="module")
def interpreted(chunk):
    return _flown(chunk, backend="numpy")


@needs_llvm
@pytest.mark.parametrize(
    ("target", "lanes"), [("x86-64", 1), ("nehalem", 4), ("haswell", 8), ("host", 16), ("host", None)]
)
def test_lanes_and_processors_change_no_bit(chunk, interpreted, target, lanes):
    if llvm.machine(target) is None:
        pytest.skip(f"this processor does not run code for {target}")
    np.testing.assert_array_equal(_flown(chunk, backend="llvm", target=target, lanes=lanes), interpreted)


@pytest.mark.slow
def test_the_interpreter_is_what_plain_numpy_gives(chunk, interpreted):
    assembly, batch, fused, _ = chunk
    short = assembly.scoring.constants.unpack(rows := batch.score_constants.copy())
    short.last[...] = np.minimum(short.last, 249.0)
    object.__setattr__(batch, "score_constants", rows)
    scores, departed, *_ = fly_eagerly(assembly, batch)
    x = fused.states.unpack(interpreted)
    np.testing.assert_array_equal(x.departed, departed)
    for i, name in enumerate(fused.detectors):
        packed = fused.scoring[i].states.pack(x.scores[i])
        np.testing.assert_array_equal(packed, scores[name], err_msg=name)


@pytest.mark.parametrize("benchmark", sorted(CAMPAIGNS))
def test_every_shipped_design_is_compiled(benchmark):
    assembly, _ = _all_designs(benchmark)
    assert {name: why_opaque(d, assembly.loop.bus) for name, d in assembly.detectors.items()} == dict.fromkeys(
        assembly.detectors, ""
    )


class WithIf:
    """A detector with an `if` on data, which no compiler can follow; written for many flights side by side."""

    batched = True

    def __init__(self, inner):
        self.inner, self.states, self.recorded = inner, inner.states, inner.recorded
        self.estimates = getattr(type(self), "estimates", inner.estimates)

    @classmethod
    def around(cls, adapted):
        return Adapted(cls(adapted), adapted.bus)

    def start(self):
        return self.inner.start(Nothing())

    def step(self, x, measured):
        if (measured.r_voted_deg_s > 1e9).any():
            raise RuntimeError("never")
        return self.inner.step(x, Nothing(), Nothing(), measured)


class WithMemory(WithIf):
    """A detector that keeps something between two calls."""

    calls = 0

    def step(self, x, measured):
        self.calls += 1
        after, verdict = self.inner.step(x, Nothing(), Nothing(), measured)
        return mapped(lambda rows: rows * (1.0 + 0.0 * self.calls) + 1e-300 * self.calls, after), verdict


def test_a_detector_that_cannot_be_compiled_flies_to_the_same_rows(tmp_path):
    assembly = assemble(read_campaign(write(tmp_path, TEXT)))
    opaque = WithIf.around(assembly.detectors["sliding_mode_published"])
    reason = why_opaque(opaque, assembly.loop.bus)
    assert "np.where" in reason
    assert "test_engine.py" in reason
    assembly.detectors["sliding_mode_published"] = opaque
    flyer = Flyer(assembly)
    batch = assembly.batch(np.arange(0, 32, 2))
    found = flyer.fly(batch, ["sliding_mode_published:residual", "voting_monitor:residual"])
    scores, departed, _, tape, _ = fly_eagerly(
        assembly, batch, ["sliding_mode_published:residual", "voting_monitor:residual"]
    )
    if llvm.available():
        assert set(flyer.opaque) == {"sliding_mode_published"}
    np.testing.assert_array_equal(found.departed, departed)
    for name, score in scores.items():
        np.testing.assert_array_equal(found.scores[name], score, err_msg=name)
    for name, rows in tape.items():
        shown = ~np.isnan(rows)
        np.testing.assert_array_equal(found.recorded[name][shown], rows[shown], err_msg=name)


def test_a_detector_with_a_memory_of_its_own_is_opaque(assembly):
    assert "between two calls" in why_opaque(WithMemory.around(assembly.detectors["voting_monitor"]), assembly.loop.bus)


class RaisesOnNan(WithIf):
    """An opaque detector that does not bear what is not a number."""

    def step(self, x, measured):
        if not np.isfinite(measured.r_voted_deg_s).all():
            raise ValueError("saw a NaN")
        return self.inner.step(x, Nothing(), Nothing(), measured)


@pytest.mark.parametrize("count", [1, 4])
@pytest.mark.slow
def test_a_departed_flight_has_one_status_whoever_flies_it(tmp_path, count):
    text = TEXT.replace("wind: light", "wind: severe").replace("duration_s: 8.0", "duration_s: 60.0")
    text = text.replace("gust_scale_ratio: {uniform: [0.0, 0.3]}", "gust_scale_ratio: {uniform: [9.0, 10.0]}")
    assembly = assemble(read_campaign(write(tmp_path, text)))
    batch = assembly.batch(np.arange(8))
    batch = batch.take(np.flatnonzero([not reason for reason in batch.infeasible_reason]))
    departs = Flyer(assembly).fly(batch).departed < NEVER
    cases = batch.cases[np.argsort(~departs, kind="stable")][:count]
    assembly.detectors["voting_monitor"] = RaisesOnNan.around(assembly.detectors["voting_monitor"])
    rows = [rows_and_events(Flyer(assembly, backend), cases)[0].to_pylist() for backend in ("auto", "numpy")]
    assert rows[0] == rows[1]
    assert any(row["departed_s"] is not None for row in rows[0])
