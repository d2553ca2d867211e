"""Numbers of a fault that are drawn or swept, and numbers that a clock cannot show."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.stats import kstest

from fddbench import kinds
from fddbench.campaign.streams import name_word
from fddbench.campaign.variation import at_levels, flown, level_radices, variations
from fddbench.faults.bias import Bias
from fddbench.faults.jam import Jam
from fddbench.faults.noise import Noise
from fddbench.faults.nrz import Nrz
from fddbench.faults.oscillatory import Oscillatory
from fddbench.interfaces import Site

SITE = Site(name="r1", signal="r", unit_name="deg/s", admissible=40.0, stops=(-128.0, 128.0))
RUNS = np.arange(4000)


def read(kind, **keys):
    """As a campaign's YAML is read."""
    entry = {"kind": kind.__name__.lower(), "sites": ["r1"], "onset_s": 2, **keys}
    return kind.model_validate_json(json.dumps(entry), strict=True)


def drawn(fault, line=0, run=RUNS, level=None, key=5, stream=77):
    level = np.zeros_like(run) if level is None else level
    faults = (*[read(Bias, amplitude_percent=1)] * line, fault)
    return flown(faults, level=level, run=run, key=key, stream=stream, sample_s=0.01)[1]


def test_a_number_stays_the_number_it_was():
    plain = read(Jam, amplitude_percent=5)
    assert plain.amplitude_percent == 5.0
    assert isinstance(plain.amplitude_percent, float)
    assert plain.model_dump(mode="json")["amplitude_percent"] == 5.0
    assert variations([plain]) == ()


def test_what_varies_is_part_of_the_fingerprint_and_of_the_schema():
    swept = read(Jam, amplitude_percent={"grid": [1, 2]})
    assert swept.model_dump(mode="json", by_alias=True)["amplitude_percent"] == {"grid": [1.0, 2.0]}
    schema = Jam.model_json_schema()
    number, varied = schema["properties"]["onset_s"]["anyOf"]
    assert number == {"type": "number", "minimum": 0.0}
    assert set(varied["properties"]) == {"uniform", "grid"}  # a time is bounded
    number, varied, _ = schema["properties"]["amplitude_percent"]["anyOf"]
    assert set(varied["properties"]) == {"uniform", "log_uniform", "normal", "grid"}


@pytest.mark.parametrize(
    ("how", "law"),
    [
        ({"uniform": [-2, 6]}, ("uniform", (-2.0, 8.0))),
        ({"log_uniform": [0.1, 1000]}, ("loguniform", (0.1, 1000.0))),
        ({"normal": {"mean": 3, "std": 2}}, ("norm", (3.0, 2.0))),
    ],
)
def test_draws_have_the_distribution_that_is_written(how, law):
    values = drawn(read(Jam, amplitude_deg_s=how))["f1_amplitude_deg_s"]
    assert kstest(values, law[0], args=law[1]).pvalue > 1e-3


def test_a_draw_belongs_to_its_line_key_run_and_stream():
    how = {"uniform": [0, 1]}
    one = drawn(read(Jam, amplitude_percent=how))["f1_amplitude_percent"]
    both = drawn(read(Oscillatory, amplitude_percent=how, phase_rad=how, frequency_hz=1))
    np.testing.assert_array_equal(both["f1_amplitude_percent"], one)
    np.testing.assert_array_equal(
        drawn(read(Jam, amplitude_percent=how), run=RUNS[[7, 3]])["f1_amplitude_percent"], one[[7, 3]]
    )
    others = [
        both["f1_phase_rad"],
        drawn(read(Jam, amplitude_percent=how), line=1)["f2_amplitude_percent"],
        drawn(read(Jam, amplitude_percent=how), stream=78)["f1_amplitude_percent"],
        drawn(read(Jam, amplitude_percent=how), key=6)["f1_amplitude_percent"],
    ]
    for other in others:
        assert abs(np.corrcoef(one, other)[0, 1]) < 0.05


def test_drawn_times_lie_on_the_clock_within_their_ends():
    values = drawn(read(Jam, amplitude_percent=1, onset_s={"uniform": [1.99, 2.05]}))["f1_onset_s"]
    assert set(values) == {1.99, 2.0, 2.01, 2.02, 2.03, 2.04, 2.05}


def test_levels_count_lines_then_keys_by_the_alphabet_the_last_fastest():
    faults = (
        read(Oscillatory, frequency_hz={"grid": [1, 2]}, amplitude_percent={"grid": [10, 20, 30]}),
        read(Jam, amplitude_percent={"grid": [5, 6]}),
    )
    assert level_radices(faults) == (3, 2, 2)
    written = [(a.amplitude_percent, a.frequency_hz, b.amplitude_percent) for a, b in at_levels(faults)]
    level = np.arange(12)
    columns = flown(faults, level=level, run=level, key=1, stream=1, sample_s=0.01)[1]
    assert list(columns) == ["f1_amplitude_percent", "f1_frequency_hz", "f2_amplitude_percent"]
    assert list(zip(*columns.values(), strict=True)) == written
    assert written[:4] == [(10.0, 1.0, 5.0), (10.0, 1.0, 6.0), (10.0, 2.0, 5.0), (10.0, 2.0, 6.0)]


@given(st.lists(st.floats(-50, 50), min_size=1, max_size=5))
def test_sizes_are_arrays_in_flight(values):
    sizes = np.array(values)
    swept = read(Jam, amplitude_percent={"uniform": [-50, 50]}).flown({"amplitude_percent": sizes})
    np.testing.assert_array_equal(swept.numbers(SITE, np.full(len(values), 0.5)).offset, sizes / 100.0 * 40.0)


def test_every_drawn_number_has_a_draw_of_its_own():
    """Keys of all kinds in all units have different hashes."""
    keys = {
        kind.in_unit(unit).key(name)
        for kind in (kinds.load("fault", name) for name in kinds.known("fault"))
        for unit in ("deg/s", "deg", "m", "")
        for name in kind.model_fields
    }
    assert len({name_word(key) for key in keys}) == len(keys)


@pytest.mark.parametrize(
    ("kind", "keys", "message"),
    [
        (Jam, {"amplitude_percent": {"uniform": [2, 2]}}, "uniform needs low below high, got low 2 and high 2"),
        (Jam, {"amplitude_percent": {"grid": []}}, "at least 1"),
        (Jam, {"onset_s": {"uniform": [-1, 2]}, "amplitude_percent": 1}, "uniform must stay >= 0.0, got -1"),
        (Jam, {"freeze": {"grid": [1, 0]}, "mode": "replace"}, "valid boolean"),
        (Noise, {"variance_percent": {"grid": [1, -1]}}, "grid must stay >= 0.0, got -1"),
        (Jam, {"amplitude_percent": {"grid": [1, 2]}, "amplitude_deg_s": 1}, "need exactly one of amplitude_percent"),
    ],
)
def test_what_cannot_vary_so_is_refused(kind, keys, message):
    with pytest.raises(ValidationError, match=message):
        read(kind, **keys)


@pytest.mark.parametrize(
    ("kind", "keys", "sample_s", "wrong"),
    [
        (Oscillatory, {"amplitude_percent": 1, "frequency_hz": 49.99}, 0.01, []),
        (Oscillatory, {"amplitude_percent": 1, "frequency_hz": 50}, 0.01, ["frequency_hz"]),
        (Oscillatory, {"amplitude_percent": 1, "frequency_hz": {"uniform": [1, 20]}}, 0.04, ["frequency_hz"]),
        (
            Oscillatory,
            {"amplitude_percent": 1, "frequency_hz": {"normal": {"mean": 3, "std": 1}}},
            0.01,
            ["frequency_hz"],
        ),
        (Oscillatory, {"amplitude_percent": 1, "frequency_rad_s": -1}, 0.01, ["frequency_rad_s"]),
        (Oscillatory, {"amplitude_percent": 1, "frequency_rad_s": 314.1}, 0.01, []),
        (Oscillatory, {"amplitude_percent": 1, "frequency_rad_s": 314.2}, 0.01, ["frequency_rad_s"]),
        (Nrz, {"amplitude_percent": 1, "bit_s": 0.03}, 0.01, []),
        (Nrz, {"amplitude_percent": 1, "bit_s": {"uniform": [0, 0.03]}}, 0.01, ["bit_s"]),
        (Nrz, {"amplitude_percent": 1}, 0.04, ["bit_s"]),
        (Jam, {"amplitude_percent": 1, "end_s": 4.02, "delay_s": {"grid": [0, 0.03]}}, 0.02, ["delay_s"]),
    ],
)
def test_what_the_clock_cannot_show_is_named(kind, keys, sample_s, wrong):
    assert [key for key, _ in read(kind, **keys).unfit(sample_s)] == wrong
