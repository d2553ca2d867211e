"""Faults on a signal: closed forms sample by sample, and every bit of the healthy signal where there is no fault."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.faults.bias import Bias
from fddbench.faults.drift import Drift
from fddbench.faults.injection import SignalFaults
from fddbench.faults.jam import Jam
from fddbench.faults.noise import Noise
from fddbench.faults.nrz import Nrz
from fddbench.faults.oscillatory import Oscillatory
from fddbench.faults.runaway import Runaway
from fddbench.faults.timing import NEVER, first_samples
from fddbench.interfaces import FlightFaults, Site

NAMES = ("r1", "r2", "r3")
SITES = tuple(
    Site(name=name, signal="r_deg_s", row=row, unit_name="deg/s", admissible=40.0, stops=(-128.0, 128.0))
    for row, name in enumerate(NAMES)
)
N = 60
T = 0.01
KINDS = {
    "bias": (Bias, {"amplitude_deg_s": 1.0}),
    "jam": (Jam, {"amplitude_deg_s": 1.0}),
    "drift": (Drift, {"rate_deg_s2": 3.0, "amplitude_deg_s": 0.5}),
    "runaway": (Runaway, {"rate_deg_s2": 7.0}),
    "oscillatory": (Oscillatory, {"amplitude_deg_s": 1.5, "frequency_hz": 3.0, "phase_rad": 0.7}),
    "nrz": (Nrz, {"amplitude_deg_s": 128.0}),
    "noise": (Noise, {"variance_deg2_s2": 0.5}),
}


def fault(name, **more):
    cls, sizes = KINDS[name]
    return cls(**{"kind": name, "sites": ("r1", "r2"), "onset_s": 0.2, **sizes, **more})


def zero(name, **more):
    return fault(name, **{**dict.fromkeys(KINDS[name][1], 0.0), **more})


def healthy_signal(n_cases=1, seed=0, n=N):
    return np.random.default_rng(seed).normal(size=(n, 3, n_cases))


def normals_of(n_cases=1, seed=1, slots=1, n=N):
    return np.random.default_rng(seed).normal(size=(n, slots, 4, n_cases))


def rows_of(step, scenarios, which, uniform=None):
    """Constants of flights, and their state before sample 0."""
    which = np.asarray(which)
    slots = max((len(one) for one in scenarios), default=0)
    uniform = np.full((slots, len(SITES), len(which)), 0.25) if uniform is None else uniform
    constants = step.prepare(FlightFaults(lists=scenarios, which=which, uniform=uniform))
    return constants, step.states.spread(step.start(constants), len(which))


def run(step, constants, state, healthy, normals):
    """Faulty signal, (n_time, n_sites, n_cases); normals (n_time, slots, 4, n_cases) by the number of the slot."""
    found = []
    for k in range(len(healthy)):
        drawn = [normals[k, consumer - 64] for consumer, _ in step.draws.streams]
        numbers = step.draws.unpack(np.concatenate([*drawn, np.zeros((0, healthy.shape[2]))]))
        state, signal = step.step(state, constants, numbers, healthy[k], float(k))
        found.append(signal)
    return np.array(found)


def fly(faults, healthy=None, normals=None, *, others=(), sample_s=T, phases=None):
    """Faulty signal, (n_time, n_sites, n_cases), of one scenario in a campaign that has others besides."""
    healthy = healthy_signal() if healthy is None else healthy
    n, _, n_cases = healthy.shape
    scenarios = [faults, *others]
    normals = normals_of(n_cases, slots=max(map(len, scenarios)), n=n) if normals is None else normals
    step = SignalFaults(SITES, "r_deg_s", scenarios, sample_s)
    return run(step, *rows_of(step, scenarios, np.zeros(n_cases, dtype=int), phases), healthy, normals)


FROZEN = fault("jam", amplitude_deg_s=None, mode="replace", freeze=True)

every_kind = pytest.mark.parametrize("name", sorted(KINDS))


@every_kind
@settings(max_examples=5)
@given(seed=st.integers(0, 1000))
def test_a_fault_of_size_zero_is_the_healthy_flight_bit_for_bit(name, seed):
    healthy = healthy_signal(3, seed)
    found = fly([zero(name)], healthy)
    assert found.tobytes() == healthy.tobytes()


@every_kind
@pytest.mark.parametrize("more", [{}, {"end_s": 0.4}, {"delay_s": 0.1}, {"end_s": 0.45, "delay_s": 0.05}])
def test_bit_identical_before_the_onset_after_the_end_and_on_other_sites(name, more):
    healthy = healthy_signal(2)
    spec = fault(name, **more)
    found = fly([spec], healthy)
    assert found[:20].tobytes() == healthy[:20].tobytes()
    assert found[:, 2].tobytes() == healthy[:, 2].tobytes()
    last = 60 if spec.end_s is None else round(spec.end_s / T)
    assert found[last:].tobytes() == healthy[last:].tobytes()
    first_2 = 20 + round(spec.delay_s / T)
    assert found[:first_2, 1].tobytes() == healthy[:first_2, 1].tobytes()
    # and in between it is there, on the first sample (a ramp is still 0 then) and on the last
    begun = 1 if name in ("runaway", "drift") else 0
    assert (found[20 + begun, 0] != healthy[20 + begun, 0]).all()
    assert (found[first_2 + begun, 1] != healthy[first_2 + begun, 1]).all()
    assert (found[last - 1, :2] != healthy[last - 1, :2]).all()


def test_an_empty_slot_and_no_slot_at_all_change_nothing():
    healthy = healthy_signal()
    assert fly([], healthy, others=[[fault(name) for name in KINDS]]).tobytes() == healthy.tobytes()
    assert fly([], healthy, others=[[FROZEN, FROZEN, FROZEN]]).tobytes() == healthy.tobytes()
    assert fly([], healthy).tobytes() == healthy.tobytes()
    assert SignalFaults(SITES, "r_deg_s", [[]], T).states.size == 0


SINCE = np.maximum(np.arange(N) - 20, 0) * T
ACTIVE = np.arange(N) >= 20
CLOSED = {
    "bias": np.ones(N),
    "jam": np.ones(N),
    "drift": np.minimum(3.0 * SINCE, 0.5),
    "runaway": 7.0 * SINCE,
    "oscillatory": 1.5 * np.sin(2 * np.pi * 3.0 * SINCE + 0.7),
}


@pytest.mark.parametrize("name", sorted(CLOSED))
@pytest.mark.parametrize("more", [{}, {"correlation": "opposite"}])
def test_closed_form_at_every_sample(name, more):
    healthy = healthy_signal()
    found = fly([fault(name, **more)], healthy) - healthy
    expected = np.where(ACTIVE, CLOSED[name], 0.0)
    np.testing.assert_allclose(found[:, 0, 0], expected, atol=1e-14)
    np.testing.assert_allclose(found[:, 1, 0], -expected if more else expected, atol=1e-14)


@pytest.mark.parametrize("name", ["drift", "runaway", "bias", "jam"])
def test_a_negative_size_is_the_mirror_image(name):
    healthy = np.zeros((N, 3, 1))
    sizes = {key: -value for key, value in KINDS[name][1].items()}
    if name == "drift":
        sizes["amplitude_deg_s"] = 0.5  # where it stops has no sign
    assert np.array_equal(fly([fault(name, **sizes)], healthy), -fly([fault(name)], healthy))


@given(st.floats(-5000.0, 5000.0), st.integers(0, 100))
@settings(max_examples=20)
def test_a_runaway_never_leaves_the_range_of_the_sensor(rate, seed):
    healthy = healthy_signal(2, seed)
    found = fly([fault("runaway", rate_deg_s2=rate)], healthy)
    assert np.abs(found).max() <= 128.0
    expected = np.clip(healthy + rate * SINCE[:, None, None], -128.0, 128.0)
    np.testing.assert_allclose(found[:, :2], expected[:, :2], rtol=1e-13)


def test_a_runaway_stays_at_the_stop():
    found = fly([fault("runaway", rate_deg_s2=1e4)])
    assert (found[25:, :2] == 128.0).all()


@pytest.mark.parametrize(("bit_s", "length"), [(0.05, 5), (0.01, 1), (0.001, 1), (0.13, 13)])
def test_bits_last_exactly_bit_s_and_are_plus_or_minus_the_size(bit_s, length):
    normals = normals_of(50)
    found = fly([fault("nrz", bit_s=bit_s)], np.zeros((N, 3, 50)), normals)
    bits = found[20:, 0]
    assert set(np.unique(bits)) == {-128.0, 128.0}
    expected = np.where(normals[20:, 0, 0][np.arange(40) // length * length] >= 0.0, 128.0, -128.0)
    assert np.array_equal(bits, expected)


def test_bits_are_fair_and_independent_of_each_other():
    bits = fly([fault("nrz", amplitude_deg_s=1.0)], np.zeros((N, 3, 4000)))[20::5, 0]
    assert abs(bits.mean()) < 4.0 / np.sqrt(bits.size)
    assert abs((bits[1:] * bits[:-1]).mean()) < 4.0 / np.sqrt(bits.size)


def test_noise_has_the_given_variance_and_is_white():
    found = fly([fault("noise")], np.zeros((N, 3, 4000)))[20:, 0]
    assert found.var() == pytest.approx(0.5, rel=0.02)
    assert abs(found.mean()) < 4.0 * np.sqrt(0.5 / found.size)
    assert abs((found[1:] * found[:-1]).mean()) < 4.0 * 0.5 / np.sqrt(found.size)


@pytest.mark.parametrize("name", ["noise", "nrz"])
def test_correlation_of_what_is_random(name):
    shape = np.zeros((N, 3, 2000))
    same, own, against = (
        fly([fault(name, correlation=c)], shape)[20:] for c in ("identical", "independent", "opposite")
    )
    assert np.array_equal(same[:, 0], same[:, 1])
    assert np.array_equal(against[:, 0], -against[:, 1])
    correlation = np.corrcoef(own[:, 0].ravel(), own[:, 1].ravel())[0, 1]
    assert abs(correlation) < 0.02
    assert own[:, 1].std() == pytest.approx(own[:, 0].std(), rel=0.02)


def test_three_opposite_sites_alternate():
    found = fly([fault("bias", sites=("r3", "r1", "r2"), correlation="opposite")], np.zeros((N, 3, 1)))
    assert found[-1, :, 0].tolist() == [-1.0, 1.0, 1.0]


@pytest.mark.parametrize(
    "correlation",
    [
        "identical",
        "independent",
        "opposite",
    ],
)
def test_a_drawn_phase_is_uniform_number_times_a_turn(correlation):
    phases = np.random.default_rng(3).uniform(size=(1, 3, 5))
    more = {"phase_rad": None, "phase": "uniform", "correlation": correlation}
    found = fly([fault("oscillatory", **more)], np.zeros((N, 3, 5)), phases=phases)[20:]
    time = SINCE[20:, None]
    own = [1.5 * np.sin(2 * np.pi * 3.0 * time + 2 * np.pi * phases[0, site]) for site in (0, 1)]
    np.testing.assert_allclose(found[:, 0], own[0], atol=1e-13)
    second = {"identical": own[0], "independent": own[1], "opposite": -own[0]}[correlation]
    np.testing.assert_allclose(found[:, 1], second, atol=1e-13)


@given(st.integers(0, 30), st.integers(0, 20))
@settings(max_examples=20)
def test_delay_shifts_the_second_and_third_site(onset, delay):
    spec = fault("runaway", sites=NAMES, onset_s=onset * T, delay_s=delay * T)
    assert first_samples(spec, NAMES, T) == [onset, onset + delay, onset + 2 * delay]
    found = fly([spec], np.zeros((N, 3, 1)))[:, :, 0]
    for i in range(3):
        expected = 7.0 * np.maximum(np.arange(N) - onset - i * delay, 0) * T
        np.testing.assert_allclose(found[:, i], expected, atol=1e-13)


def test_delay_follows_the_order_in_which_the_sites_are_named():
    assert first_samples(fault("jam", sites=("r3", "r1"), delay_s=0.1), NAMES, T) == [30.0, NEVER, 20.0]


@pytest.mark.parametrize("name", sorted(KINDS))
def test_shifting_the_onset_shifts_the_fault(name):
    """Shifted signals and shifted random numbers give the shifted result."""
    healthy, normals = healthy_signal(2), normals_of(2)
    here = fly([fault(name)], healthy, normals)
    later = fly([fault(name, onset_s=0.27)], np.roll(healthy, 7, axis=0), np.roll(normals, 7, axis=0))
    assert here[20:53].tobytes() == later[27:].tobytes()


def test_freeze_holds_the_last_reading():
    healthy = healthy_signal(3)
    found = fly([fault("jam", amplitude_deg_s=None, mode="replace", freeze=True, delay_s=0.03)], healthy)
    assert np.array_equal(found[20:, 0], np.broadcast_to(healthy[19, 0], (40, 3)))
    assert np.array_equal(found[23:, 1], np.broadcast_to(healthy[22, 1], (37, 3)))
    assert np.array_equal(found[:23, 1], healthy[:23, 1])


@pytest.mark.parametrize("order", [1, -1])
def test_a_frozen_reading_has_every_fault_in_it_whatever_the_line_it_stands_in(order):
    healthy, early = healthy_signal(2), fault("drift", sites=("r1",), onset_s=0.1)
    found = fly([early, FROZEN][::order], healthy)
    assert (healthy[19, 0] + 0.27 == found[19, 0]).all()  # 3 deg/s^2 for 0.09 s
    held = found[20:, 0] if order == 1 else found[20:, 0] - np.minimum(3.0 * (SINCE[20:, None] + 0.1), 0.5)
    np.testing.assert_allclose(held, np.broadcast_to(found[19, 0], (40, 2)), rtol=1e-14, atol=1e-14)
    assert np.array_equal(found[20:, 1], np.broadcast_to(healthy[19, 1], (40, 2)))


def test_a_freeze_that_follows_another_holds_what_that_one_showed():
    healthy = healthy_signal(2)
    hold = fault("jam", amplitude_deg_s=None, mode="replace", hold_value_deg_s=2.5, onset_s=0.1, end_s=0.2)
    found = fly([hold, FROZEN], healthy)
    assert (found[10:, :2] == 2.5).all()


def test_what_freezes_at_the_first_sample_holds_that_sample():
    healthy = healthy_signal(3)
    found = fly([fault("jam", amplitude_deg_s=None, mode="replace", freeze=True, onset_s=0.0)], healthy)
    assert np.array_equal(found[:, 0], np.broadcast_to(healthy[0, 0], (N, 3)))
    assert np.array_equal(found[:, 2], healthy[:, 2])


def test_what_thaws_reads_again_and_may_freeze_again():
    healthy = healthy_signal(2)
    more = {"amplitude_deg_s": None, "mode": "replace", "freeze": True}
    found = fly([fault("jam", **more, end_s=0.3), fault("jam", **more, onset_s=0.4)], healthy)[:, 0]
    assert np.array_equal(found[20:30], np.broadcast_to(healthy[19, 0], (10, 2)))
    assert np.array_equal(found[30:40], healthy[30:40, 0])
    assert np.array_equal(found[40:], np.broadcast_to(healthy[39, 0], (20, 2)))


@pytest.mark.parametrize(("hold", "value"), [({"hold_value_deg_s": 2.5}, 2.5), ({"hold_value_percent": 10.0}, 4.0)])
def test_hold_stands_at_its_value(hold, value):
    found = fly([fault("jam", amplitude_deg_s=None, mode="replace", **hold)])
    assert (found[20:, :2] == value).all()


def test_solid_oscillation_replaces_the_signal_and_frozen_runaway_starts_from_it():
    healthy = healthy_signal()
    solid = fly([fault("oscillatory", mode="replace")], healthy)
    np.testing.assert_allclose(solid[20:, 0, 0], CLOSED["oscillatory"][20:], atol=1e-14)
    ramp = fly([fault("runaway", mode="replace", freeze=True)], healthy)
    np.testing.assert_allclose(ramp[20:, 0, 0], healthy[19, 0, 0] + CLOSED["runaway"][20:], atol=1e-13)


def test_several_faults_act_one_after_the_other():
    healthy, normals = healthy_signal(2), normals_of(2, slots=3)
    faults = [fault("bias"), fault("nrz", sites=("r2",), onset_s=0.1, end_s=0.3), fault("noise", sites=("r3", "r1"))]
    found = fly(faults, healthy, normals)
    parts = [fly([one], healthy, normals[:, [j]]) - healthy for j, one in enumerate(faults)]
    np.testing.assert_allclose(found, healthy + sum(parts), atol=1e-13)
    # a stuck sensor hides what acted before it and not what acts after it
    stuck = fault("jam", amplitude_deg_s=None, mode="replace", hold_value_deg_s=0.0)
    assert (fly([fault("bias"), stuck], healthy)[20:, :2] == 0.0).all()
    assert (fly([stuck, fault("bias")], healthy)[20:, :2] == 1.0).all()


def test_a_slot_more_changes_no_bit():
    healthy, normals = healthy_signal(2), normals_of(2, slots=3)
    others = [[fault("bias"), fault("noise"), FROZEN]]
    for name in KINDS:
        one = fly([fault(name)], healthy, normals[:, :1])
        assert one.tobytes() == fly([fault(name)], healthy, normals, others=others).tobytes(), name


EVERY = [*([fault(name)] for name in sorted(KINDS)), [FROZEN], []]


def test_a_case_alone_has_the_bits_it_has_in_a_mixed_chunk():
    """One chunk holds every kind in one slot, frozen and healthy flights; each flown alone gives the same bits."""
    n_cases = len(EVERY)
    healthy, normals = healthy_signal(n_cases), normals_of(n_cases)
    step = SignalFaults(SITES, "r_deg_s", EVERY, T)
    assert len(step.slots) == 1
    assert len(step.slots[0].kinds) == len(KINDS)

    def flown(which, step=step, scenarios=EVERY):
        part = rows_of(step, scenarios, which)
        return run(step, *part, healthy[:, :, cases], normals[:, :, :, cases])

    cases = np.arange(n_cases)
    together = flown(cases)
    for i in range(n_cases):
        cases = np.array([i])
        own = np.ascontiguousarray(together[:, :, [i]]).tobytes()
        assert flown(cases).tobytes() == own
        # and in a campaign that knows no other kind
        assert flown(np.array([0]), SignalFaults(SITES, "r_deg_s", [EVERY[i]], T), [EVERY[i]]).tobytes() == own


def test_a_kind_that_nobody_uses_costs_nothing():
    only = SignalFaults(SITES, "r_deg_s", [[fault("bias")]], T)
    assert [kind.__name__ for kind in only.slots[0].kinds] == ["Bias"]
    assert (only.draws.size, only.states.size) == (0, 0)
    both = SignalFaults(SITES, "r_deg_s", [[fault("bias")], [], [fault("nrz")]], T)
    assert [kind.__name__ for kind in both.slots[0].kinds] == ["Bias", "Nrz"]
    assert (both.draws.streams, both.states.size) == (((64, "scenario"),), 3)


@pytest.mark.parametrize("sample_s", [0.005, 0.01, 0.02, 0.04])
def test_onset_and_end_count_samples_at_every_sample_time(sample_s):
    healthy = np.zeros((N, 3, 1))
    found = fly([fault("bias", onset_s=0.2, end_s=0.28)], healthy, sample_s=sample_s)[:, 0, 0]
    expected = np.zeros(N)
    expected[round(0.2 / sample_s) : round(0.28 / sample_s)] = 1.0
    assert np.array_equal(found, expected)


def test_a_fault_may_start_at_the_first_sample():
    healthy = healthy_signal()
    assert np.array_equal(fly([fault("bias", onset_s=0.0)], healthy)[:, 0], healthy[:, 0] + 1.0)


def test_kinds_stand_in_the_same_order_whoever_names_them_first():
    """The order of the scenarios is no part of a result."""
    plain = [Jam.in_unit("")(kind="jam", sites=("r1",), onset_s=0.2, amplitude_percent=1.0)]
    again = [SignalFaults(SITES, "r_deg_s", [plain, *EVERY], T).slots[0].kinds for _ in range(3)]
    assert [kind.__name__ for kind in again[0]].count("Jam") == 2
    assert again[0] == again[1] == again[2]
    assert again[0].index(type(plain[0])) < again[0].index(Jam)
    first, second = (SignalFaults(SITES, "r_deg_s", order, T) for order in (EVERY, EVERY[::-1]))
    assert first.slots[0].kinds == second.slots[0].kinds
    assert (first.states.names, first.constants.names) == (second.states.names, second.constants.names)
