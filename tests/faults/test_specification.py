"""What a campaign may write about a fault, and what is refused with which words."""

import math

import pytest
from pydantic import ValidationError

from fddbench.faults.bias import Bias
from fddbench.faults.drift import Drift
from fddbench.faults.jam import Jam
from fddbench.faults.noise import Noise
from fddbench.faults.nrz import Nrz
from fddbench.faults.oscillatory import Oscillatory
from fddbench.faults.runaway import Runaway
from fddbench.faults.specification import FaultWave, one_of
from fddbench.interfaces import FaultUnits

UNITS = FaultUnits(unit="deg/s", admissible=40.0, sensor_range=128.0)
WHERE = {"sites": ("r1", "r2"), "onset_s": 2.0}

# kind, percent sizes, the same sizes in units at an admissible range of 40 deg/s, and the wave they make
SIZES = (
    (Bias, "bias", {"amplitude_percent": 5.0}, {"amplitude_deg_s": 2.0}, {"offset": 2.0}),
    (Jam, "jam", {"amplitude_percent": 1.25}, {"amplitude_deg_s": 0.5}, {"offset": 0.5}),
    (Runaway, "runaway", {"rate_percent_s": 2.5}, {"rate_deg_s2": 1.0}, {"rate": 1.0, "clip": 128.0}),
    (Nrz, "nrz", {"amplitude_percent": 320.0}, {"amplitude_deg_s": 128.0}, {"bit": 128.0, "bit_s": 0.05}),
    (Noise, "noise", {"variance_percent": 1.25}, {"variance_deg2_s2": 0.5}, {"sigma": math.sqrt(0.5)}),
    (
        Drift,
        "drift",
        {"rate_percent_s": 1.0, "amplitude_percent": 5.0},
        {"rate_deg_s2": 0.4, "amplitude_deg_s": 2.0},
        {"rate": 0.4, "ramp_limit": 2.0},
    ),
    (
        Oscillatory,
        "oscillatory",
        {"amplitude_percent": 3.75, "frequency_hz": 0.5},
        {"amplitude_deg_s": 1.5, "frequency_rad_s": math.pi},
        {"amplitude": 1.5, "frequency_rad_s": math.pi},
    ),
)
names = [entry[1] for entry in SIZES]


@pytest.mark.parametrize(("kind", "name", "percent", "units", "wave"), SIZES, ids=names)
def test_percent_and_units_make_the_same_wave(kind, name, percent, units, wave):
    for sizes in (percent, units):
        found = kind(kind=name, **WHERE, **sizes).wave(UNITS)
        for key in FaultWave.__dataclass_fields__:
            expected = wave.get(key, getattr(FaultWave(), key))
            if key == "bit_s":
                expected = wave.get(key, 1.0)
            assert getattr(found, key) == pytest.approx(expected, rel=1e-15), key


@pytest.mark.parametrize(("kind", "name", "percent", "units", "wave"), SIZES, ids=names)
def test_a_size_is_given_exactly_once(kind, name, percent, units, wave):
    for missing in percent:
        rest = {key: value for key, value in percent.items() if key != missing}
        with pytest.raises(ValidationError, match="need exactly one of .*got none"):
            kind(kind=name, **WHERE, **rest)
    for twice in units:
        with pytest.raises(ValidationError, match="need exactly one of .*got .*, "):
            kind(kind=name, **WHERE, **percent, **{twice: units[twice]})


@pytest.mark.parametrize(("kind", "name", "percent", "units", "wave"), SIZES, ids=names)
def test_numbers_must_be_finite_and_keys_known(kind, name, percent, units, wave):
    for key in units:
        for bad in (math.inf, math.nan):
            with pytest.raises(ValidationError, match="finite"):
                kind(kind=name, **WHERE, **{**units, key: bad})
    with pytest.raises(ValidationError, match="Extra inputs"):
        kind(kind=name, **WHERE, **units, amplitude=1.0)


def jam(**more):
    return Jam(**{"kind": "jam", **WHERE, **more})


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"amplitude_deg_s": 1.0, "end_s": 2.0}, "end_s must lie after onset_s = 2.0, got 2.0"),
        ({"amplitude_deg_s": 1.0, "sites": ("r1", "r1")}, "a site is named twice"),
        ({"amplitude_deg_s": 1.0, "sites": ()}, "at least 1"),
        ({"amplitude_deg_s": 1.0, "freeze": True}, "need mode: replace"),
        ({"amplitude_deg_s": 1.0, "hold_value_deg_s": 0.0}, "need mode: replace"),
        ({"mode": "replace"}, "needs freeze: true | hold_value_deg_s"),
        ({"mode": "replace", "freeze": True, "hold_value_deg_s": 1.0}, "give one of freeze, hold_value_deg_s"),
        ({"mode": "replace", "hold_value_percent": 1.0, "hold_value_deg_s": 1.0}, "give one of freeze"),
        ({"mode": "replace", "freeze": True, "amplitude_deg_s": 1.0}, "remove the amplitude"),
        ({"amplitude_deg_s": 1.0, "onset_s": -0.01}, "greater than or equal to 0"),
        ({"amplitude_deg_s": 1.0, "delay_s": -0.01}, "greater than or equal to 0"),
        ({"amplitude_deg_s": 1.0, "correlation": "same"}, "'identical', 'independent' or 'opposite'"),
        ({"amplitude_deg_s": 1.0, "mode": "multiply"}, "'add' or 'replace'"),
    ],
)
def test_what_is_refused_and_why(keys, message):
    with pytest.raises(ValidationError, match=message):
        jam(**keys)


def test_signs_that_make_no_sense_are_refused():
    with pytest.raises(ValidationError, match="greater than or equal to 0"):
        Noise(kind="noise", **WHERE, variance_deg2_s2=-1.0)
    with pytest.raises(ValidationError, match="greater than or equal to 0"):
        Drift(kind="drift", **WHERE, rate_deg_s2=1.0, amplitude_deg_s=-1.0)
    with pytest.raises(ValidationError, match="greater than 0"):
        Nrz(kind="nrz", **WHERE, amplitude_deg_s=1.0, bit_s=0.0)


@pytest.mark.parametrize(("kind", "sizes"), [(Bias, {"amplitude_deg_s": 1.0}),
                                             (Drift, {"rate_deg_s2": 1.0, "amplitude_deg_s": 1.0})])  # fmt: skip
def test_bias_and_drift_are_added_only(kind, sizes):
    with pytest.raises(ValidationError, match="'add'"):
        kind(kind=kind.__name__.lower(), **WHERE, mode="replace", **sizes)


def test_phase_is_a_number_or_drawn_but_not_both():
    sizes = {"amplitude_deg_s": 1.0, "frequency_hz": 1.0}
    with pytest.raises(ValidationError, match="give phase_rad or phase: uniform, not both"):
        Oscillatory(kind="oscillatory", **WHERE, **sizes, phase="uniform", phase_rad=0.0)
    assert Oscillatory(kind="oscillatory", **WHERE, **sizes, phase_rad=-1.026).wave(UNITS).phase_rad == -1.026
    assert Oscillatory(kind="oscillatory", **WHERE, **sizes, phase="uniform").wave(UNITS).phase_uniform == 1.0


def test_one_of_takes_a_zero_for_a_value():
    assert one_of(amplitude_percent=None, amplitude_deg_s=0.0) == 0.0


@pytest.mark.parametrize(("hold", "offset"), [({}, 0.0), ({"hold_value_deg_s": 3.0}, 3.0),
                                              ({"hold_value_percent": 5.0}, 2.0)])  # fmt: skip
def test_replace_drops_the_healthy_signal(hold, offset):
    wave = Nrz(kind="nrz", **WHERE, mode="replace", amplitude_deg_s=1.0, **hold).wave(UNITS)
    assert (wave.keep, wave.hold, wave.hold_value, wave.offset) == (0.0, 0.0, offset, 0.0)
    wave = Nrz(kind="nrz", **WHERE, mode="replace", amplitude_deg_s=1.0, freeze=True).wave(UNITS)
    assert (wave.keep, wave.hold, wave.offset) == (0.0, 1.0, 0.0)
