"""The residual filter: faults reproduced, faults isolated, confirmation counted, nonsense refused."""

from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from fddbench import gallery
from fddbench.benchmarks.jet_engine import JetEngine
from fddbench.blocks.layout import Nothing
from fddbench.detection.hinf_filter import HinfFilter
from fddbench.errors import DesignError
from fddbench.faults.jam import Jam
from fddbench.interfaces import Bus, FlightFaults, Flights, Options, Site, Tunable

SHIPPED = ("hinf_identity", "hinf_start", "hinf_final", "hinf_optimum", "jet_exact_inverse")
BENCHMARK = JetEngine()
BUS = Bus(sample_s=0.05, sites=BENCHMARK.sites, signals={"y": 3, "u": 3})


def gains(name, **changes):
    text = (gallery.folder("detectors") / f"{name}.yaml").read_text()
    return HinfFilter.Gains(**{**yaml.safe_load(text)["gains"], **changes})


def begun(detector, n_cases=1):
    return detector.states.spread(detector.start(Nothing()), n_cases)


def stepped(detector, state, measured):
    return detector.step(state, Nothing(), Nothing(), measured)


def means(detector, *, faults=(0.0, 0.0, 0.0), onset=40, n=300, manoeuvre="idle", delta=0.0):
    """Moving means, (n_time, 3), and declarations on the nominal engine without disturbances."""
    kind = Jam.in_unit("")
    parts = [
        kind(kind="jam", sites=(f"f{i + 1}",), onset_s=onset * 0.05, amplitude=a) for i, a in enumerate(faults) if a
    ]
    chosen = {"plant": BENCHMARK.choices["plant"].options["boundary"]}
    loop = BENCHMARK.loop(Options(chosen=chosen, sample_s=BUS.sample_s, faults=[parts]))
    parameters = {"delta_scale_ratio": delta, "input_scale_ratio": 1.0, "disturbance_scale_ratio": 0.0}
    uniform = np.full((len(parts), 3, 1), 0.5)
    prepared = loop.prepare(
        Flights(
            parameters={name: np.array([value]) for name, value in parameters.items()},
            manoeuvres=[manoeuvre],
            faults=FlightFaults(lists=[parts], which=np.zeros(1, dtype=int), uniform=uniform),
            normals=loop.before.unpack(np.random.default_rng(2).standard_normal((24, 1))),
        )
    )
    state = loop.states.spread(loop.start(prepared.constants), 1)
    inner, found, declared = begun(detector), [], []
    for k in range(n):
        numbers = loop.draws.unpack(np.zeros((loop.draws.size, 1)))
        state, seen = loop.step(state, prepared.constants, numbers, float(k))
        inner, verdict = stepped(detector, inner, seen.measured)
        found.append([verdict.signals[f"mean_{i + 1}"][0] for i in range(3)])
        declared.append(verdict.declared[:, 0])
    return np.array(found), np.array(declared)


@pytest.mark.parametrize("i", [0, 1, 2])
def test_the_exact_inverse_returns_the_fault_itself(i):
    faults = tuple(float(j == i) for j in range(3))
    found, _ = means(HinfFilter.from_design(gains("jet_exact_inverse"), BUS), faults=faults)
    np.testing.assert_allclose(found[40 + 20 :, i], 1.0, atol=0.02)  # the window is full
    assert np.abs(np.delete(found, i, axis=1)).max() < 1e-2
    np.testing.assert_allclose(found[200:, i], 1.0, atol=1e-6)


@pytest.mark.parametrize("i", [0, 1, 2])
@pytest.mark.parametrize("name", ["hinf_identity", "hinf_optimum"])
def test_filters_for_the_identity_answer_a_unit_fault_within_gamma(name, i):
    faults = tuple(float(j == i) for j in range(3))
    found, declared = means(HinfFilter.from_design(gains(name), BUS), faults=faults)
    assert abs(found[-1, i] - 1.0) < 0.35
    assert np.abs(np.delete(found[-1], i)).max() < 0.35
    assert declared[-1].tolist() == list(faults)


@pytest.mark.parametrize("name", SHIPPED)
def test_inputs_alone_raise_nothing_on_the_nominal_engine(name):
    detector = HinfFilter.from_design(gains(name), BUS)
    _, declared = means(detector, manoeuvre="steps", n=800)
    assert not declared.any()
    assert isinstance(detector, Tunable)
    assert detector.evaluated == ("mean_1", "mean_2", "mean_3")


def constant(detector, levels, n):
    """Declarations for residuals that stand at a level: D_y of a static filter passes y."""
    state, found = begun(detector), []
    for k in range(n):
        y = np.array([[levels(k)], [0.0], [0.0]])
        state, verdict = stepped(detector, state, SimpleNamespace(y=y, u=np.zeros((3, 1))))
        found.append(verdict.declared[0, 0])
    return np.array(found)


def static(**changes):
    """Gains of a filter whose residuals are the outputs, but for a state that nothing excites."""
    zero, unit = ((0.0, 0.0, 0.0),), tuple(tuple(row) for row in np.eye(3).tolist())
    none = ((0.0,), (0.0,), (0.0,))
    own = {"A": ((-1.0,),), "B_y": zero, "B_u": zero, "C": none, "D_y": unit, "D_u": (zero * 3)}
    return HinfFilter.Gains(**{**own, "window_s": 0.05, "thresholds": (0.5,) * 3, "confirm_s": 0.2, **changes})


@pytest.mark.parametrize(("last", "declares"), [(104, False), (105, True)])
def test_a_mean_must_stay_beyond_its_threshold_for_the_whole_time(last, declares):
    found = constant(HinfFilter.from_design(static(), BUS), lambda k: 1.0 if 100 <= k < last else 0.0, 200)
    assert found.any() == declares
    assert not declares or np.flatnonzero(found)[0] == 104
    assert not declares or found[104:].all()


def test_a_window_of_ten_samples_is_their_mean():
    detector = HinfFilter.from_design(static(window_s=0.5, confirm_s=0.0), BUS)
    found = constant(detector, lambda k: 1.0 if k >= 100 else 0.0, 200)
    assert np.flatnonzero(found)[0] == 105  # six of ten are more than a half


def test_bits_do_not_depend_on_the_company():
    detector, random = HinfFilter.from_design(gains("hinf_optimum"), BUS), np.random.default_rng(0)
    signals = random.standard_normal((60, 6, 40))

    def residuals(which):
        state, found = begun(detector, len(which)), []
        for sample in signals[:, :, which]:
            state, verdict = stepped(detector, state, SimpleNamespace(y=sample[:3], u=sample[3:]))
            found.append(verdict.residual)
        return np.array(found)

    whole = residuals(range(40))
    np.testing.assert_array_equal(residuals([7]), whole[:, [7]])
    np.testing.assert_array_equal(residuals([3, 39, 12]), whole[:, [3, 39, 12]])


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"A": ((1.0,),)}, "this filter diverges"),
        ({"D_y": ((1.0, 0.0, 0.0),)}, "D_y is 1 x 3, needs 3 x 3"),
        ({"B_u": ((1.0, 0.0), (1.0,))}, "B_u is 2 x -1, needs 1 x 3"),
        ({"thresholds": (1.0,)}, "1 thresholds for 3 fault sites"),
    ],
)
def test_matrices_that_make_no_filter_are_refused(changes, message):
    with pytest.raises(DesignError, match=message):
        HinfFilter.from_design(static(**changes), BUS)


def test_a_benchmark_without_outputs_and_inputs_is_refused():
    with pytest.raises(DesignError, match="needs the signals"):
        HinfFilter.from_design(static(), Bus(sample_s=0.01, sites=BENCHMARK.sites[:1], signals={"r_deg_s": 3}))


def test_the_largest_mean_over_its_threshold_is_the_residual():
    detector = HinfFilter.from_design(static(thresholds=(0.5, 4.0, 1.0)), BUS)
    y = np.array([[1.0], [-2.0], [3.0]])
    _, verdict = stepped(detector, begun(detector), SimpleNamespace(y=y, u=np.zeros((3, 1))))
    assert verdict.residual[0] == pytest.approx(3.0)
    assert set(verdict.signals) == set(detector.recorded)
    assert [verdict.signals[f"threshold_{i}"][0] for i in (1, 2, 3)] == [0.5, 4.0, 1.0]


def test_it_watches_the_sites_of_the_kind_of_the_first():
    """A plant whose sensors may fail too has as many residuals as component faults."""
    sensor = Site(name="y2", signal="y", row=1, unit_name="", admissible=1.0)
    bus = Bus(sample_s=0.05, sites=(*BENCHMARK.sites, sensor), signals=BUS.signals)
    assert HinfFilter.from_design(static(), bus).watches == ("f1", "f2", "f3")
