"""The closed loop as a whole: bits, sub-steps, sensors, faults, gusts and departures."""

import numpy as np
import pytest

from fddbench.errors import UnknownNameError
from fddbench.faults.bias import Bias
from fddbench.faults.jam import Jam
from fddbench.faults.nrz import Nrz
from fddbench.faults.runaway import Runaway

PAIR = {"sites": ("r1", "r2"), "onset_s": 0.5}
FAULTS = [
    [Jam(kind="jam", **PAIR, amplitude_deg_s=2.0)],
    [Runaway(kind="runaway", **PAIR, rate_deg_s2=20.0)],
    [Nrz(kind="nrz", **PAIR, amplitude_deg_s=128.0)],
    [Jam(kind="jam", sites=("r3",), onset_s=0.5, amplitude_deg_s=0.5)],
    [],
]
MIXED = {
    "manoeuvres": ["cruise", "roll_doublet", "cruise", "turn_coordination_1", "yaw_angle_mode"],
    "faults": FAULTS,
    "mass_kg": [180e3, 200e3, 220e3, 190e3, 210e3],
    "delta_c_n_percent": [0.0, 5.0, -5.0, 0.0, 3.0],
    "v_cas_error_percent": [0.0, 0.0, 5.0, -5.0, 0.0],
}


def drawn(loop, n_cases, n, seed=0):
    rows = 4 * (len(loop.consumers) + len(loop.fault_consumers))
    return np.random.default_rng(seed).normal(size=(n, rows, n_cases))


@pytest.mark.parametrize("wind", ["none", "light"])
def test_a_case_alone_has_the_bits_it_has_in_company(bench, wind):
    loop = bench.loop(sensors="white", wind=wind)
    draws = drawn(loop, 5, 201)
    normals = np.random.default_rng(9).normal(size=(4, 5))
    detector = bench.sliding_mode(loop)
    together = bench.fly(loop, 5, 2.0, draws=draws, normals=normals, detector=detector, **MIXED)
    for i in (0, 2, 3):
        own = {name: values[i : i + 1] for name, values in MIXED.items()}
        alone = bench.fly(loop, 1, 2.0, draws=draws[:, :, [i]], normals=normals[:, [i]], detector=detector, **own)
        for name, values in alone.items():
            assert values.tobytes() == np.ascontiguousarray(together[name][..., [i]]).tobytes(), name


def test_halving_the_integration_step_changes_no_declaration(bench):
    found = []
    for substeps in (1, 2):
        loop = bench.loop(sensors="white", substeps=substeps)
        found.append(bench.fly(loop, 5, 8.0, draws=drawn(loop, 5, 801), detector=bench.sliding_mode(loop), **MIXED))
    one, two = found
    assert one["declared"].any(axis=(0, 1)).tolist() == [True, True, True, True, False]
    assert np.array_equal(one["declared"], two["declared"])
    scale = np.abs(one["state"][:, :6]).max(axis=(0, 2))
    assert (np.abs(one["state"][:, :6] - two["state"][:, :6]).max(axis=(0, 2)) < 1e-6 * scale).all()


def test_measured_signals_are_the_true_ones_with_noise_of_the_preset(bench):
    loop = bench.loop(sensors="white")
    now = bench.fly(loop, 20, 10.0, draws=drawn(loop, 20, 1001), manoeuvres="roll_doublet")
    pairs = {"phi_deg": ("phi_true_deg", 0.02), "beta_deg": ("beta_true_deg", 0.02), "p_deg_s": ("p_true_deg_s", 0.02)}
    errors = {name: (now[name] - now[true], sigma) for name, (true, sigma) in pairs.items()}
    errors |= {f"r{i}": (now["r_deg_s"][:, i] - now["r_true_deg_s"], 0.01) for i in range(3)}
    for name, (error, sigma) in errors.items():
        assert error.std() == pytest.approx(sigma, rel=0.03), name
        assert abs(error.mean()) < 5.0 * sigma / np.sqrt(error.size), name
    noises = np.array([error.ravel() for error, _ in errors.values()])
    correlation = np.corrcoef(noises) - np.eye(6)
    assert np.abs(correlation).max() < 0.03  # every channel has a number of its own


def test_ideal_sensors_are_the_truth(bench):
    now = bench.fly(bench.loop(), 1, 8.0, manoeuvres="roll_doublet")
    assert now["phi_true_deg"].any()
    assert np.array_equal(now["phi_deg"], now["phi_true_deg"])
    assert np.array_equal(now["beta_deg"], now["beta_true_deg"])
    assert np.array_equal(now["p_deg_s"], now["p_true_deg_s"])
    assert all(np.array_equal(now["r_deg_s"][:, i], now["r_true_deg_s"]) for i in range(3))


def test_a_fault_of_size_zero_is_the_healthy_flight_bit_for_bit(bench):
    loop = bench.loop(sensors="white")
    draws = drawn(loop, 4, 301)
    zeros = [
        [Jam(kind="jam", **PAIR, amplitude_deg_s=0.0)],
        [Runaway(kind="runaway", **PAIR, rate_deg_s2=0.0)],
        [Nrz(kind="nrz", **PAIR, amplitude_deg_s=0.0)],
        [Bias(kind="bias", **PAIR, amplitude_percent=0.0)],
    ]
    detector = bench.sliding_mode(loop)
    healthy, same = (
        bench.fly(loop, 4, 3.0, draws=draws, faults=faults, detector=detector, manoeuvres="turn_coordination_1")
        for faults in (None, zeros)
    )
    for name in healthy:
        if name != "state":  # the fault step remembers the value before its onset
            assert healthy[name].tobytes() == same[name].tobytes(), name


def test_a_fault_changes_nothing_before_its_onset(bench):
    loop = bench.loop(sensors="white")
    draws = drawn(loop, 4, 101)
    faulty = bench.fly(loop, 4, 1.0, draws=draws, faults=FAULTS[:4])
    healthy = bench.fly(loop, 4, 1.0, draws=draws)
    for name in ("r_deg_s", "phi_deg", "surface_deg", "r_true_deg_s"):
        assert faulty[name][:50].tobytes() == healthy[name][:50].tobytes()
    assert (faulty["r_deg_s"][50] != healthy["r_deg_s"][50]).any(axis=0).tolist() == [True, False, True, True]


def test_the_voted_rate_drives_the_law_so_a_common_fault_moves_the_aircraft_and_a_single_one_does_not(bench):
    now = bench.fly(bench.loop(), 2, 3.0, faults=[FAULTS[0], FAULTS[3]])
    assert np.abs(now["r_true_deg_s"][:, 0]).max() > 0.1
    assert not now["r_true_deg_s"][:, 1].any()


def test_sideslip_is_relative_to_the_air(bench):
    """In a gust at rest the first measured sideslip is that of the gust alone."""
    loop = bench.loop(wind="moderate")
    begun = bench.start(loop, 1, normals=np.array([[1.0], [-0.5], [0.0], [0.0]]))
    draws = np.zeros((4 * (len(loop.consumers) + 1), 1))
    _, measured, truth, _ = loop.step(begun.state, begun.constants, draws, 0.0)
    assert truth["gust_m_s"][0] != 0.0
    assert measured.beta_deg[0] == pytest.approx(-np.rad2deg(np.arcsin(truth["gust_m_s"][0] / 199.28)), rel=1e-4)


def test_every_random_number_has_one_reader(bench):
    """Rows 0-5 are sensor noise, 8-9 the gust, 12-15 the fault slot; no row moves what another one feeds."""
    loop = bench.loop(sensors="white", wind="light")
    begun = bench.start(loop, 17, faults=[[Nrz(kind="nrz", sites=("r1",), onset_s=0.0, amplitude_deg_s=2.0)]] * 17)
    draws = np.full((16, 17), 0.5)
    draws[np.arange(16), np.arange(16)] = -0.5  # case i has row i reversed; case 16 is the reference
    after, measured, *_ = loop.step(begun.state, begun.constants, draws, 0.0)
    seen = {
        "r1": measured.r_deg_s[0],
        "r2": measured.r_deg_s[1],
        "r3": measured.r_deg_s[2],
        "others": measured.beta_deg + 2.0 * measured.p_deg_s + 4.0 * measured.phi_deg,
        "gust": loop.states.unpack(after).gust.sum(axis=0),
    }
    readers = {name: np.flatnonzero(value != value[16]).tolist() for name, value in seen.items()}
    assert readers == {"r1": [0, 12], "r2": [1], "r3": [2], "others": [3, 4, 5], "gust": [8, 9]}


def test_gust_scale_zero_is_still_air_and_the_gust_has_its_sigma(bench):
    loop = bench.loop(wind="severe")
    n_cases = 400
    normals = np.random.default_rng(3).normal(size=(4, n_cases))
    now = bench.fly(
        loop, n_cases, 0.2, draws=drawn(loop, n_cases, 21), normals=normals,
        gust_scale_ratio=np.where(np.arange(n_cases) < 200, 0.0, 0.5),
    )  # fmt: skip
    assert not now["gust_m_s"][:, :200].any()
    assert now["gust_m_s"][0, 200:].std() == pytest.approx(3.0, rel=0.15)
    assert now["gust_m_s"][-1, 200:].std() == pytest.approx(3.0, rel=0.15)


def test_a_flight_has_departed_beyond_90_deg_of_bank_and_when_it_is_not_a_number(bench):
    loop = bench.loop()
    begun = bench.start(loop, 4)
    state = begun.state.copy()
    state[0] = np.deg2rad([89.9, -90.1, 90.1, 0.0])
    state[0, 3] = np.nan
    with np.errstate(all="ignore"):
        *_, departed = loop.step(state, begun.constants, np.zeros((12, 4)), 0.0)
    assert departed.tolist() == [False, True, True, True]


def test_law_and_detectors_get_measured_parameters_and_the_plant_keeps_the_true_ones(bench):
    now = bench.fly(bench.loop(), 2, 7.0, manoeuvres="turn_coordination_1", mass_error_percent=[0.0, 10.0],
                    v_cas_error_percent=[0.0, 10.0])  # fmt: skip
    assert now["mass_kg"][0].tolist() == pytest.approx([200e3, 220e3])
    assert now["v_cas_kt"][0].tolist() == pytest.approx([290.0, 319.0])
    assert now["v_tas_m_s"][0, 1] > now["v_tas_m_s"][0, 0]
    # mass enters no law, so an error of it alone changes no flight
    alone = bench.fly(bench.loop(), 1, 7.0, manoeuvres="turn_coordination_1", mass_error_percent=10.0)
    assert np.array_equal(alone["phi_true_deg"][:, 0], now["phi_true_deg"][:, 0])
    assert not np.array_equal(now["phi_true_deg"][:, 1], now["phi_true_deg"][:, 0])


def test_bus_names_what_a_step_measures(bench):
    loop = bench.loop(sensors="white")
    begun = bench.start(loop, 3)
    _, measured, truth, _ = loop.step(begun.state, begun.constants, np.zeros((12, 3)), 0.0)
    assert set(vars(measured)) == set(loop.bus.signals)
    for name, rows in loop.bus.signals.items():
        assert np.shape(getattr(measured, name)) == ((rows, 3) if rows else (3,)), name
    assert tuple(truth) == loop.truth


def test_choices_that_do_not_exist_are_refused(bench):
    with pytest.raises(UnknownNameError, match="no voter is called 'mean'"):
        bench.loop(voter="mean")


def test_literature_limits_and_ranges(bench):
    limits = [bench.benchmark.detection_time_limit_s(n) for n in (1, 2, 3)]
    assert limits == [120.0, 0.36, 0.36]
    units = bench.benchmark.fault_units
    assert (units.unit, units.admissible, units.sensor_range) == ("deg/s", 40.0, 128.0)
