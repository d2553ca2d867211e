"""The closed loop as a whole: bits, sub-steps, sensors, faults, gusts and departures."""

from dataclasses import replace

import numpy as np
import pytest

from fddbench import kinds
from fddbench.benchmarks.yaw_rate.plants.lateral_lpv import LateralLpvPlant
from fddbench.errors import UnknownNameError
from fddbench.faults.bias import Bias
from fddbench.faults.jam import Jam
from fddbench.faults.nrz import Nrz
from fddbench.faults.runaway import Runaway
from fddbench.interfaces.benchmark import default_choices
from fddbench.interfaces.site import limit_s

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
    return np.random.default_rng(seed).normal(size=(n, loop.draws.size, n_cases))


@pytest.mark.parametrize("wind", ["none", "light"])
def test_a_case_alone_has_the_bits_it_has_in_company(bench, wind):
    loop = bench.loop(sensors="white", wind=wind, faults=FAULTS)
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
        loop = bench.loop(sensors="white", substeps=substeps, faults=FAULTS)
        found.append(bench.fly(loop, 5, 8.0, draws=drawn(loop, 5, 801), detector=bench.sliding_mode(loop), **MIXED))
    one, two = found
    assert one["declared"].any(axis=(0, 1)).tolist() == [True, True, True, True, False]
    assert np.array_equal(one["declared"], two["declared"])
    assert all(name.startswith("plant.") for name in loop.states.names[:6])
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
    zeros = [
        [Jam(kind="jam", **PAIR, amplitude_deg_s=0.0)],
        [Runaway(kind="runaway", **PAIR, rate_deg_s2=0.0)],
        [Nrz(kind="nrz", **PAIR, amplitude_deg_s=0.0)],
        [Bias(kind="bias", **PAIR, amplitude_percent=0.0)],
    ]
    loop = bench.loop(sensors="white", faults=zeros)
    draws, detector = drawn(loop, 4, 301), bench.sliding_mode(loop)
    healthy, same = (
        bench.fly(loop, 4, 3.0, draws=draws, faults=faults, detector=detector, manoeuvres="turn_coordination_1")
        for faults in (None, zeros)
    )
    for name in healthy:
        if name != "state":  # a fault remembers the bit that stands
            assert healthy[name].tobytes() == same[name].tobytes(), name
    flown = [row for row, name in enumerate(loop.states.names) if "faults" not in name]
    assert healthy["state"][:, flown].tobytes() == same["state"][:, flown].tobytes()


def test_what_other_scenarios_break_changes_no_bit_of_a_healthy_flight(bench):
    """A loop that knows no fault, and one that knows four kinds and a frozen sensor."""
    frozen = [Jam(kind="jam", **PAIR, mode="replace", freeze=True)]
    alone, among = bench.loop(sensors="white"), bench.loop(sensors="white", faults=[*FAULTS, frozen])
    draws = drawn(among, 2, 101)
    one = bench.fly(alone, 2, 1.0, draws=draws[:, : alone.draws.size], manoeuvres="roll_doublet")
    other = bench.fly(among, 2, 1.0, draws=draws, manoeuvres="roll_doublet")
    assert all(one[name].tobytes() == other[name].tobytes() for name in one if name != "state")


def test_a_fault_changes_nothing_before_its_onset(bench):
    loop = bench.loop(sensors="white", faults=FAULTS)
    draws = drawn(loop, 4, 101)
    faulty = bench.fly(loop, 4, 1.0, draws=draws, faults=FAULTS[:4])
    healthy = bench.fly(loop, 4, 1.0, draws=draws)
    for name in ("r_deg_s", "phi_deg", "surface_deg", "r_true_deg_s"):
        assert faulty[name][:50].tobytes() == healthy[name][:50].tobytes()
    assert (faulty["r_deg_s"][50] != healthy["r_deg_s"][50]).any(axis=0).tolist() == [True, False, True, True]


def test_the_voted_rate_drives_the_law_so_a_common_fault_moves_the_aircraft_and_a_single_one_does_not(bench):
    now = bench.fly(bench.loop(faults=FAULTS), 2, 3.0, faults=[FAULTS[0], FAULTS[3]])
    assert np.abs(now["r_true_deg_s"][:, 0]).max() > 0.1
    assert not now["r_true_deg_s"][:, 1].any()


def test_sideslip_is_relative_to_the_air(bench):
    """In a gust at rest the first measured sideslip is that of the gust alone."""
    loop = bench.loop(wind="moderate")
    constants, state = bench.start(loop, 1, normals=np.array([[1.0], [-0.5], [0.0], [0.0]]))
    _, seen = loop.step(state, constants, loop.draws.unpack(np.zeros((loop.draws.size, 1))), 0.0)
    gust_m_s = seen.truth["gust_m_s"][0]
    assert gust_m_s != 0.0
    assert seen.measured.beta_deg[0] == pytest.approx(-np.rad2deg(np.arcsin(gust_m_s / 199.28)), rel=1e-4)


FLIGHT, SCENARIO = "flight", "scenario"


def test_every_random_number_has_one_reader_and_its_frozen_address(bench):
    """Rows 0-5 are sensor noise, 8-10 the gust, 12-15 the fault slot; no row moves what another one feeds."""
    nrz = [Nrz(kind="nrz", sites=("r1",), onset_s=0.0, amplitude_deg_s=2.0)]
    loop = bench.loop(sensors="white", wind="light", faults=[nrz])
    assert loop.draws.streams == ((0, FLIGHT), (1, FLIGHT), (2, FLIGHT), (64, SCENARIO))
    assert loop.before.streams == ((3, FLIGHT),)
    constants, state = bench.start(loop, 17, faults=[nrz] * 17)
    draws = np.full((16, 17), 0.5)
    draws[np.arange(16), np.arange(16)] = -0.5  # case i has row i reversed; case 16 is the reference
    after, seen = loop.step(state, constants, loop.draws.unpack(draws), 0.0)
    measured = seen.measured
    seen = {
        "r1": measured.r_deg_s[0],
        "r2": measured.r_deg_s[1],
        "r3": measured.r_deg_s[2],
        "beta": measured.beta_deg,
        "p": measured.p_deg_s,
        "phi": measured.phi_deg,
        "gust": after.gust.gust.first + after.gust.gust.second,
        "roll": after.gust.roll,
    }
    readers = {name: np.flatnonzero(value != value[16]).tolist() for name, value in seen.items()}
    assert readers == {
        "r1": [0, 12],
        "r2": [1],
        "r3": [2],
        "beta": [3],
        "p": [4],
        "phi": [5],
        "gust": [8, 9],
        "roll": [10],
    }


def test_each_site_of_an_independent_fault_has_the_number_of_its_position(bench):
    """Slot j is consumer 64 + j, site i its number i; what is the same on all sites is number 0."""
    own = Nrz(kind="nrz", sites=("r3", "r1", "r2"), onset_s=0.0, amplitude_deg_s=2.0, correlation="independent")
    same = Nrz(kind="nrz", sites=("r2", "r3"), onset_s=0.0, amplitude_deg_s=2.0)
    for slot, fault, expected in ((0, own, [[8], [9], [10]]), (1, same, [[], [8], [8]])):
        faults = [Bias(kind="bias", **PAIR, amplitude_deg_s=0.0)] * slot + [fault]
        loop = bench.loop(faults=[faults])
        assert loop.draws.streams == ((0, FLIGHT), (1, FLIGHT), (64 + slot, SCENARIO))
        constants, state = bench.start(loop, 13, faults=[faults] * 13)
        draws = np.full((12, 13), 0.5)
        draws[np.arange(12), np.arange(12)] = -0.5
        _, seen = loop.step(state, constants, loop.draws.unpack(draws), 0.0)
        assert [np.flatnonzero(row != row[12]).tolist() for row in seen.measured.r_deg_s] == expected


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
    constants, state = bench.start(loop, 4)
    phi_rad = np.deg2rad([89.9, -90.1, 90.1, np.nan])
    state = replace(state, plant=replace(state.plant, phi_rad=phi_rad))
    with np.errstate(all="ignore"):
        _, seen = loop.step(state, constants, loop.draws.unpack(np.zeros((loop.draws.size, 4))), 0.0)
    assert seen.departed.tolist() == [False, True, True, True]


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
    beta = bench.fly(bench.loop(), 2, 0.0, beta_error_deg=[0.0, 0.5])["beta_deg"]
    assert (beta[0, 1] - beta[0, 0], beta[0, 0]) == (0.5, 0.0)


def test_bus_names_what_a_step_measures(bench):
    loop = bench.loop(sensors="white")
    constants, state = bench.start(loop, 3)
    after, seen = loop.step(state, constants, loop.draws.unpack(np.zeros((loop.draws.size, 3))), 0.0)
    assert set(vars(seen.measured)) == set(loop.bus.signals)
    for name, rows in loop.bus.signals.items():
        assert np.shape(getattr(seen.measured, name)) == ((rows, 3) if rows else (3,)), name
    assert tuple(seen.truth) == loop.truth
    loop.states.check(after, 3)


def test_calm_air_and_no_faults_leave_no_row_behind(bench):
    loop, windy = bench.loop(), bench.loop(wind="light")
    assert loop.states.size == 6 + 13 + 1
    assert windy.states.size == loop.states.size + 4
    assert not any("gust." in name or "faults" in name for name in (*loop.states.names, *loop.constants.names))
    assert (loop.draws.size, windy.draws.size, loop.before.size) == (8, 12, 0)


def test_choices_and_their_defaults(bench):
    found = {key: tuple(choice.options) for key, choice in bench.benchmark.choices.items()}
    assert found == {
        "plant": ("lateral_lpv", "transport_6dof"),
        "voter": ("median", "closest_two", "monitored"),
        "sensors": ("white", "ideal", "iru"),
        "wind": ("none", "light", "moderate", "severe", "one_minus_cosine"),
    }
    chosen = default_choices(bench.benchmark)
    assert all(chosen[key] is bench.benchmark.choices[key].options[names[0]] for key, names in found.items())
    assert bench.benchmark.plant(chosen) is LateralLpvPlant


@pytest.mark.parametrize(("family", "name"), [("voter", "mean"), ("plant", "nonsense"), ("wind", "storm")])
def test_choices_that_do_not_exist_are_refused(bench, family, name):
    choice = bench.benchmark.choices[family]
    assert name not in choice.options
    with pytest.raises(UnknownNameError, match=f"no {family} is called '{name}'"):
        kinds.load(choice.family, name)


def test_literature_limits_and_ranges(bench):
    sites = LateralLpvPlant.sites
    assert [site.name for site in sites] == ["r1", "r2", "r3"]
    assert [limit_s(sites[:n]) for n in (1, 2, 3)] == [120.0, 0.36, 0.36]
    assert [limit_s([site]) for site in sites] == [120.0] * 3
    for row, site in enumerate(sites):
        assert (site.unit_name, site.admissible, site.stops) == ("deg/s", 40.0, (-128.0, 128.0))
        assert (site.kind, site.signal, site.row) == ("sensor", "r_deg_s", row)
