"""Numbers of a design by their names: never by that of another constant, never with a unit that nobody stated."""

from dataclasses import dataclass

from fddbench.exported.constants import Constants
from fddbench.exported.members import Members
from fddbench.exported.naming import Names
from fddbench.exported.spelling import DOUBLE
from fddbench.exported.statements import Statement


@dataclass
class Model:
    """Two tables with one number in common."""

    A: tuple[float, ...] = (0.25, 0.0012)
    B: tuple[float, ...] = (0.0012, 7.0)
    trim: tuple[float, ...] = (200000.0, 0.3)
    floor_deg_s: float = 0.35


def constants():
    return Constants(Members(Model()), Names(), DOUBLE)


def statement(*words):
    return Statement("linear", "product(A, x) + product(B, u)", "observer.py:100", words)


def test_a_number_of_one_constant_has_its_name():
    assert constants().text(7.0, statement("A", "B")) == "B[1U]"


def test_a_number_that_two_constants_have_stands_in_figures():
    assert constants().text(0.0012, statement("A", "B"), (0.25, 0.0012, 7.0)) == "0.0012"


def test_of_two_constants_the_one_with_all_numbers_beside_is_meant():
    assert constants().text(0.0012, statement("A", "B"), (0.0012, 7.0)) == "B[0U]"


def test_a_constant_has_a_unit_where_its_name_tells_it():
    own = constants()
    own.text(200000.0, statement("trim"))
    own.text(0.35, statement("floor_deg_s"))
    assert [lines[0] for lines in own.definitions().values()] == ["/* trim */", "/* floor_deg_s [deg/s] */"]
