"""What a campaign may write about a fault, and what is refused with which words."""

import math

import numpy as np
import pytest
from pydantic import ValidationError

from fddbench.blocks.layout import leaves
from fddbench.errors import FddbenchError
from fddbench.faults.bias import Bias
from fddbench.faults.drift import Drift
from fddbench.faults.injection import SignalFaults
from fddbench.faults.jam import Jam
from fddbench.faults.noise import Noise
from fddbench.faults.nrz import Nrz
from fddbench.faults.oscillatory import Oscillatory
from fddbench.faults.runaway import Runaway
from fddbench.faults.specification import FaultSpecification, one_of
from fddbench.interfaces import FlightFaults, Site

SITE = Site(name="r1", signal="r_deg_s", unit_name="deg/s", admissible=40.0, stops=(-128.0, 128.0))
HALF = np.full(1, 0.5)
WHERE = {"sites": ("r1", "r2"), "onset_s": 2.0}

# kind, percent sizes, the same sizes in units at an admissible range of 40 deg/s, and the constants they make
SIZES = (
    (Bias, "bias", {"amplitude_percent": 5.0}, {"amplitude_deg_s": 2.0}, {"offset": 2.0}),
    (Jam, "jam", {"amplitude_percent": 1.25}, {"amplitude_deg_s": 0.5}, {"offset": 0.5}),
    (Runaway, "runaway", {"rate_percent_s": 2.5}, {"rate_deg_s2": 1.0}, {"rate": 1.0}),
    (Nrz, "nrz", {"amplitude_percent": 320.0}, {"amplitude_deg_s": 128.0}, {"size": 128.0, "bit_s": 0.05}),
    (Noise, "noise", {"variance_percent": 1.25}, {"variance_deg2_s2": 0.5}, {"sigma": math.sqrt(0.5)}),
    (
        Drift,
        "drift",
        {"rate_percent_s": 1.0, "amplitude_percent": 5.0},
        {"rate_deg_s2": 0.4, "amplitude_deg_s": 2.0},
        {"rate": 0.4, "limit": 2.0},
    ),
    (
        Oscillatory,
        "oscillatory",
        {"amplitude_percent": 3.75, "frequency_hz": 0.5},
        {"amplitude_deg_s": 1.5, "frequency_rad_s": math.pi},
        {"amplitude": 1.5, "frequency_rad_s": math.pi, "phase_rad": 0.0},
    ),
)
names = [entry[1] for entry in SIZES]


@pytest.mark.parametrize(("kind", "name", "percent", "units", "made"), SIZES, ids=names)
def test_percent_and_units_make_the_same_constants(kind, name, percent, units, made):
    for sizes in (percent, units):
        found = dict(leaves(kind(kind=name, **WHERE, **sizes).numbers(SITE, HALF)))
        assert found == {key: pytest.approx(value, rel=1e-15) for key, value in made.items()}


@pytest.mark.parametrize(("kind", "name", "percent", "units", "made"), SIZES, ids=names)
def test_a_size_is_given_exactly_once(kind, name, percent, units, made):
    for missing in percent:
        rest = {key: value for key, value in percent.items() if key != missing}
        with pytest.raises(ValidationError, match="need exactly one of .*got none"):
            kind(kind=name, **WHERE, **rest)
    for twice in units:
        with pytest.raises(ValidationError, match="need exactly one of .*got .*, "):
            kind(kind=name, **WHERE, **percent, **{twice: units[twice]})


@pytest.mark.parametrize(("kind", "name", "percent", "units", "made"), SIZES, ids=names)
def test_numbers_must_be_finite_and_keys_known(kind, name, percent, units, made):
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
    with pytest.raises(ValidationError, match="greater than or equal to 0"):
        Nrz(kind="nrz", **WHERE, amplitude_deg_s=1.0, bit_s=-1.0)


@pytest.mark.parametrize(("kind", "sizes"), [(Bias, {"amplitude_deg_s": 1.0}),
                                             (Drift, {"rate_deg_s2": 1.0, "amplitude_deg_s": 1.0})])  # fmt: skip
def test_bias_and_drift_are_added_only(kind, sizes):
    with pytest.raises(ValidationError, match="'add'"):
        kind(kind=kind.__name__.lower(), **WHERE, mode="replace", **sizes)


def test_phase_is_a_number_or_drawn_but_not_both():
    sizes = {"amplitude_deg_s": 1.0, "frequency_hz": 1.0}
    with pytest.raises(ValidationError, match="give phase_rad or phase: uniform, not both"):
        Oscillatory(kind="oscillatory", **WHERE, **sizes, phase="uniform", phase_rad=0.0)
    given, drawn = ({"phase_rad": -1.026}, {"phase": "uniform"})
    uniform = np.array([0.0, 0.25, 1.0])
    assert Oscillatory(kind="oscillatory", **WHERE, **sizes, **given).numbers(SITE, uniform).phase_rad == -1.026
    phase_rad = Oscillatory(kind="oscillatory", **WHERE, **sizes, **drawn).numbers(SITE, uniform).phase_rad
    assert phase_rad.tolist() == pytest.approx([0.0, np.pi / 2.0, 2.0 * np.pi], rel=1e-15)


def test_one_of_takes_a_zero_for_a_value():
    assert one_of(amplitude_percent=None, amplitude_deg_s=0.0) == 0.0


def constants(spec):
    """Constants of a flight with this fault alone, on the only site there is."""
    step = SignalFaults([SITE], "r_deg_s", [[spec]], 0.01)
    (found,) = step.prepare(FlightFaults(lists=[[spec]], which=np.zeros(1, int), uniform=np.full((1, 1, 1), 0.5)))
    return found


@pytest.mark.parametrize(("hold", "offset"), [({}, 0.0), ({"hold_value_deg_s": 3.0}, 3.0),
                                              ({"hold_value_percent": 5.0}, 2.0)])  # fmt: skip
def test_replace_drops_the_healthy_signal(hold, offset):
    spec = Nrz(kind="nrz", **WHERE, mode="replace", amplitude_deg_s=1.0, **hold)
    assert (spec.mode, spec.freeze, spec.held(SITE)) == ("replace", False, offset)
    c = constants(spec)
    assert (c.stands[0, 0], c.freezes[0, 0], c.held[0, 0]) == (1.0, 0.0, offset)
    c = constants(Nrz(kind="nrz", **WHERE, mode="replace", amplitude_deg_s=1.0, freeze=True))
    assert (c.stands[0, 0], c.freezes[0, 0], c.held[0, 0]) == (1.0, 1.0, 0.0)
    c = constants(Nrz(kind="nrz", **WHERE, amplitude_deg_s=1.0))
    assert (c.stands[0, 0], c.freezes[0, 0], c.held[0, 0]) == (0.0, 0.0, 0.0)


def test_times_and_sign_of_a_flight_are_whole_samples():
    c = constants(jam(amplitude_deg_s=1.0, end_s=2.4))
    assert (c.first[0, 0], c.last[0, 0], c.sign[0, 0]) == (200.0, 239.0, 1.0)


@pytest.mark.parametrize(
    ("unit", "keys"),
    [
        ("deg/s", {"amplitude_deg_s", "hold_value_deg_s"}),
        ("deg", {"amplitude_deg", "hold_value_deg"}),
        ("m/s^2", {"amplitude_m_s2", "hold_value_m_s2"}),
        ("", {"amplitude", "hold_value"}),
    ],
)
def test_keys_carry_the_unit_of_the_sites_and_no_other_key_is_known(unit, keys):
    kind = Jam.in_unit(unit)
    own = {field.alias for name, field in kind.model_fields.items() if name in ("amplitude", "hold_value")}
    assert own == keys
    assert kind is Jam.in_unit(unit)  # always the same class, so that its flights share a program
    assert kind(kind="jam", **WHERE, **{kind.key("amplitude"): 2.0}).numbers(SITE, HALF).offset == 2.0
    with pytest.raises(ValidationError, match="Extra inputs are not permitted"):
        kind(kind="jam", **WHERE, amplitude_kt=2.0)
    with pytest.raises(ValidationError, match=f"got none|{kind.key('amplitude')}"):
        kind(kind="jam", **WHERE)


def test_rates_and_variances_carry_units_of_their_own():
    assert Runaway.in_unit("deg").key("rate") == "rate_deg_s"
    assert Runaway.in_unit("").key("rate") == "rate_per_s"
    assert Noise.in_unit("m/s^2").key("variance") == "variance_m2_s4"
    assert Nrz.in_unit("deg").key("bit_s") == "bit_s"


def test_a_unit_that_nobody_knows_is_refused():
    with pytest.raises(FddbenchError, match="no unit is called 'furlong'; known: '', 'deg'"):
        Jam.in_unit("furlong")


def test_a_kind_with_neither_profile_nor_block_is_refused():
    class Empty(FaultSpecification):
        kind: str = "empty"

        def numbers(self, site, uniform):
            return None

    with pytest.raises(FddbenchError, match="the fault Empty has neither a profile nor a block of its own"):
        Empty.block(1, 0.01)
