"""The engine as it runs: inputs, disturbances, faults, and the exact answer of the continuous system."""

import numpy as np
import pytest
from scipy.linalg import expm

from fddbench.benchmarks.jet_engine.manoeuvres import DURATIONS_S
from fddbench.benchmarks.jet_engine.plant import DELTA_79, closed
from fddbench.blocks.block import program
from fddbench.errors import FddbenchError
from fddbench.interfaces.benchmark import default_choices
from fddbench.interfaces.site import limit_s


def test_nothing_happens_to_a_healthy_engine_at_rest(bench):
    found = bench.fly(bench.loop(), 5, 10.0)
    assert not found["y"].any()
    assert not found["u"].any()


def test_a_step_fault_gives_the_answer_of_the_continuous_system(bench):
    fault = bench.fault("jam", sites=("f2",), onset_s=1.0, amplitude=1.0)
    loop = bench.loop("equation_79", sample_s=0.01, faults=[fault])
    found = bench.fly(loop, 1, 6.0, faults=[fault])["y"][:, :, 0]
    A, B, C, D = (m[:, :, 0] for m in closed(DELTA_79[:, :, np.newaxis]))
    b, d = B[:, 1], D[:, 1]
    for t in (0.0, 0.5, 5.0):
        x = np.linalg.solve(A, (expm(A * t) - np.eye(3)) @ b)
        np.testing.assert_allclose(found[100 + round(t / 0.01)], C @ x + d, atol=2e-3)  # half a sample of a jump


@pytest.mark.parametrize("manoeuvre", DURATIONS_S)
def test_inputs_are_at_most_one_and_settle(bench, manoeuvre):
    found = bench.fly(bench.loop(), 2, 40.0, manoeuvre=manoeuvre)
    assert np.abs(found["u"]).max() <= 1.0
    assert np.abs(found["y"][-20:]).max() < 6.0
    assert found["u"].any() == (manoeuvre != "idle")


def test_inputs_are_scaled(bench):
    half, whole = (bench.fly(bench.loop(), 1, 30.0, manoeuvre=name)["u"] for name in ("half_steps", "steps"))
    np.testing.assert_array_equal(2.0 * half, whole)
    scaled = bench.fly(bench.loop(), 1, 30.0, manoeuvre="steps", input_scale_ratio=0.5)["u"]
    np.testing.assert_array_equal(scaled, half)


@pytest.mark.parametrize("sample_s", [0.1, 0.05, 0.02, 0.01])
@pytest.mark.slow
def test_disturbances_are_held_a_tenth_of_a_second_with_sigma_two(bench, sample_s):
    loop = bench.loop(sample_s=sample_s)
    d = np.stack([bench.fly(loop, 40, 30.0, disturbance_scale_ratio=1.0)[f"d_true_{i}"] for i in (1, 2, 3)])
    n = round(0.1 / sample_s)
    blocks = d[:, : 300 * n].reshape(3, 300, n, 40)
    assert (blocks == blocks[:, :, :1]).all()
    assert np.std(blocks[:, :, 0]) == pytest.approx(2.0, rel=0.02)
    neighbours = np.corrcoef(blocks[:, 1:, 0].ravel(), blocks[:, :-1, 0].ravel())[0, 1]
    assert abs(neighbours) < 0.02


def test_a_sample_that_does_not_divide_the_hold_is_refused(bench):
    with pytest.raises(FddbenchError, match="use 0.1, 0.05, 0.02 or 0.01"):
        bench.loop(sample_s=0.03)


def test_substeps_are_refused(bench):
    with pytest.raises(FddbenchError, match="stepped exactly for its discretisation: remove substeps = 2"):
        bench.loop(substeps=2)


def test_faults_of_size_zero_are_none_and_others_overlap(bench):
    size = bench.fault("jam", sites=("f1",), onset_s=2.0, amplitude=0.0)
    loop = bench.loop(faults=[size])
    healthy, zero = (bench.fly(loop, 3, 5.0, faults=f, disturbance_scale_ratio=1.0) for f in ((), [size]))
    np.testing.assert_array_equal(healthy["y"], zero["y"])
    assert bench.fly(bench.loop(), 3, 5.0, disturbance_scale_ratio=1.0)["y"].tobytes() == healthy["y"].tobytes()
    jam = bench.fault("jam", sites=("f1",), onset_s=2.0, amplitude=1.0)
    ramp = bench.fault("runaway", sites=("f3",), onset_s=3.0, rate_per_s=0.2)
    both = bench.fly(bench.loop(faults=[jam, ramp]), 1, 5.0, faults=[jam, ramp])
    assert both["f_true_1"][[39, 40, 100], 0].tolist() == [0.0, 1.0, 1.0]
    assert both["f_true_3"][[59, 60, 100], 0] == pytest.approx([0.0, 0.0, 0.4])
    assert not both["f_true_2"].any()


def test_the_step_can_be_traced(bench):
    noise = bench.fault("noise", sites=("f2",), onset_s=0.0, variance=1.0)
    loop = bench.loop(faults=[noise, bench.fault("jam", sites=("f1",), onset_s=2.0, amplitude=1.0)])
    traced = program(loop, shown=lambda seen: {**vars(seen.measured), **seen.truth, "gone": seen.departed})
    assert len(traced.outputs["state"]) == loop.states.size
    assert set(traced.outputs) == {"state", "y", "u", *loop.truth, "gone"}


def test_random_numbers_have_their_frozen_addresses(bench):
    """Disturbance i is number i of consumer 10, fault site i number i of 64 + slot, Δ the consumers 4 to 9."""
    noise = bench.fault("noise", sites=("f1", "f2", "f3"), onset_s=0.0, variance=1.0, correlation="independent")
    loop = bench.loop("equation_79", faults=[noise])
    assert loop.draws.streams == ((10, "flight"), (64, "scenario"))
    assert loop.before.streams == tuple((consumer, "flight") for consumer in range(4, 10))
    constants, state = bench.start(loop, 9, faults=[noise], disturbance_scale_ratio=1.0)
    drawn = np.full((8, 9), 0.5)
    drawn[np.arange(8), np.arange(8)] = -0.5  # case i has row i reversed; case 8 is the reference
    _, seen = loop.step(state, constants, loop.draws.unpack(drawn), 0.0)
    readers = {name: np.flatnonzero(value != value[8]).tolist() for name, value in seen.truth.items()}
    assert readers == {
        "d_true_1": [0],
        "d_true_2": [1],
        "d_true_3": [2],
        "f_true_1": [4],
        "f_true_2": [5],
        "f_true_3": [6],
    }


def test_sites_choices_and_limits(bench):
    sites = bench.benchmark.sites
    assert [(site.name, site.kind, site.signal, site.row) for site in sites] == [
        (f"f{row + 1}", "component", "f", row) for row in range(3)
    ]
    assert {(site.unit_name, site.admissible, site.stops) for site in sites} == {("", 1.0, (-np.inf, np.inf))}
    assert all(site.additive and not site.floats for site in sites)
    assert [limit_s(sites[:n]) for n in (1, 2, 3)] == [5.0, 5.0, 5.0]
    assert tuple(bench.benchmark.choices["plant"].options) == ("norm_bounded", "boundary", "structured", "equation_79")
    assert bench.benchmark.plant(default_choices(bench.benchmark)) is bench.benchmark
