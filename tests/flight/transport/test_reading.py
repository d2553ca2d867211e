"""The file of an aircraft: what is refused, with its name and what is plausible."""

import copy

import pytest
import yaml

from fddbench.errors import FddbenchError
from fddbench.flight.transport.aircraft import Aircraft
from fddbench.flight.transport.reading import SHIPPED, read_aircraft, twin_jet
from fddbench.flight.transport.shipped import shipped_numbers

DATA = yaml.safe_load(SHIPPED.read_text(encoding="utf-8"))


def numbers(part, path=()):
    if isinstance(part, dict):
        for key, value in part.items():
            yield from numbers(value, (*path, key))
    elif isinstance(part, float | int):
        yield path


def changed(path, value):
    data = copy.deepcopy(DATA)
    place = data
    for key in path[:-1]:
        place = place[key]
    if value is None:
        del place[path[-1]]
    else:
        place[path[-1]] = value(place[path[-1]]) if callable(value) else value
    return data


def refusal(tmp_path, data):
    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump(data), encoding="utf-8")
    with pytest.raises(FddbenchError) as caught:
        read_aircraft(file)
    return str(caught.value)


def test_a_copy_of_the_shipped_file_is_the_shipped_aircraft(tmp_path):
    copied = tmp_path / "mine.yaml"
    copied.write_bytes(SHIPPED.read_bytes())
    assert read_aircraft(copied) == twin_jet()
    assert isinstance(twin_jet(), Aircraft)


@pytest.mark.parametrize("path", [*numbers(DATA)], ids=".".join)
def test_every_number_is_needed(path, tmp_path):
    assert f"{'.'.join(path)} is missing" in refusal(tmp_path, changed(path, None))


PER_DEGREE, FEET, KNOTS = 0.017453292519943295, 3.280839895013123, 1.9438444924406046
SLIPS = (
    ("lateral.c_n_beta.value", PER_DEGREE, "plausible is 0.01 to 0.4, got 0.00173294; is it in per degree?"),
    ("lateral.c_l_p.value", PER_DEGREE, "per degree?"),
    ("lateral.c_l_r.value", PER_DEGREE, "plausible is 0.005 to 0.6"),
    ("lateral.c_y_beta.value", PER_DEGREE, "per degree?"),
    ("lateral.c_n_r.value", PER_DEGREE, "per degree?"),
    ("lateral.c_l_beta.value", -1.0, "plausible is -0.6 to -0.02, got 0.23113"),
    ("lift.c_l_alpha", PER_DEGREE, "plausible is 3 to 8, got 0.089291; is it in per degree?"),
    ("pitch.c_m_elevator", PER_DEGREE, "per degree?"),
    ("pitch.c_m_q", -1.0, "plausible is -50 to -5"),
    ("surfaces.rudder.c_n", PER_DEGREE, "surfaces.rudder: c_n: plausible is -0.4 to -0.02"),
    ("surfaces.spoiler.c_l", PER_DEGREE, "plausible is -0.1 to -0.003"),
    ("lift.alpha_zero_deg", PER_DEGREE, "is it in radians?"),
    ("geometry.span_m", FEET, "plausible is 20 to 90, got 197.835; is it in feet?"),
    ("geometry.chord_m", FEET, "feet?"),
    ("geometry.wing_area_m2", FEET * FEET, "square feet?"),
    ("geometry.x_cg_reference_ratio", 100.0, "percent?"),
    ("limits.v_mo_kt", 1.0 / KNOTS, "plausible is 200 to 450, got 169.767; is it in m/s?"),
    ("inertia.mass_kg", 2.2046226, "plausible is 250 to 950 kg/m2"),
    ("inertia.i_xx_kg_m2", -1.0, "inertia.i_xx_kg_m2: plausible is 100000 to 1e+08, got -1.15e+07"),
    ("inertia.i_zz_kg_m2", 0.0, "inertia.i_zz_kg_m2: plausible is"),
    ("inertia.i_zz_kg_m2", 1.2, "no body has I_xx 1.15e+07"),
    ("thrust.sea_level_n", 1.0 / 4448.2, "plausible is 80000"),
    ("actuators.elevator.rate_deg_s", PER_DEGREE, "plausible is 3 to 200, got 0.523599; is it in radians?"),
)


@pytest.mark.parametrize(("name", "factor", "words"), SLIPS, ids=[f"{name} x {factor:g}" for name, factor, _ in SLIPS])
def test_usual_slips_are_refused_with_name_and_range(name, factor, words, tmp_path):
    message = refusal(tmp_path, changed(name.split("."), lambda value: value * factor))
    assert words in message
    assert name.split(".")[0] in message


def test_unknown_names_meet_the_nearest_known_one(tmp_path):
    message = refusal(tmp_path, changed(("lift", "c_l_alfa"), 5.0))
    assert "lift.c_l_alfa is no number of an aircraft. Did you mean 'c_l_alpha'?" in message


def test_a_buffet_table_rises(tmp_path):
    assert "buffet_mach rises" in refusal(tmp_path, changed(("limits", "buffet_mach"), [0.3, 0.2]))


def test_text_is_no_number(tmp_path):
    assert "drag.c_d_0: Input should be a valid number" in refusal(tmp_path, changed(("drag", "c_d_0"), "small"))


def test_something_else_is_no_aircraft(tmp_path):
    assert "an aircraft is a mapping" in refusal(tmp_path, [1, 2])
    (tmp_path / "mine.yaml").write_text("a: [", encoding="utf-8")
    with pytest.raises(FddbenchError, match="cannot be read as the YAML of an aircraft"):
        read_aircraft(tmp_path / "mine.yaml")


@pytest.mark.parametrize("part", ["geometry", "drag", "thrust", "limits"])
def test_numbers_read_without_the_model_are_those_of_the_model(part):
    """What the limits of flight are computed from."""
    judged = getattr(twin_jet(), part).model_dump()
    assert vars(getattr(shipped_numbers(), part)) == judged
