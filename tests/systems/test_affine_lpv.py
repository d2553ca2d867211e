"""Law: the published lateral aircraft is one instance, bit for bit; any number of parameters; what is missing is named."""

import numpy as np
import pytest

from fddbench.blocks.linear import column
from fddbench.flight.lateral_lpv import SCHEDULING, lateral_lpv
from fddbench.systems import AffineLpv, MisfitError

PUBLISHED = lateral_lpv()
AIRCRAFT = AffineLpv(tables=PUBLISHED.tables, names=SCHEDULING, trim=PUBLISHED.trim, scale=PUBLISHED.scale)


def test_the_published_aircraft_bit_for_bit():
    random = np.random.default_rng(0)
    values = PUBLISHED.trim + PUBLISHED.scale * random.uniform(-1.2, 1.2, (4, 9))
    rho = PUBLISHED.rho(*values)
    np.testing.assert_array_equal(AIRCRAFT.rho(*values), rho)
    np.testing.assert_array_equal(AIRCRAFT.rho(*values[:2], v_cas_kt=values[3], altitude_ft=values[2]), rho)
    for found, expected in zip(AIRCRAFT.matrices(rho), PUBLISHED.matrices(rho), strict=True):
        np.testing.assert_array_equal(found, expected)
    np.testing.assert_array_equal(AIRCRAFT.matrix("B", rho), PUBLISHED.matrices(rho)[1])
    np.testing.assert_allclose(AIRCRAFT.values(rho), values, rtol=1e-14)


@pytest.mark.parametrize("n", [0, 1, 3, 6])
def test_any_number_of_parameters(n):
    tables = np.random.default_rng(n).standard_normal((n + 1, 2, 3, 1))
    model = AffineLpv(
        tables={"K": tables}, names=tuple(f"p{j}" for j in range(n)), trim=np.zeros((n, 1)), scale=np.ones((n, 1))
    )
    corners = model.vertices()
    assert corners.shape == (n, 2**n)
    assert len({tuple(corner) for corner in corners.T}) == 2**n
    found = model.matrix("K", corners) if n else model.matrix("K", np.zeros((0, 1)))
    expected = tables[0] + np.einsum("jabc,jk->abk", tables[1:], corners)
    np.testing.assert_allclose(found, expected, atol=1e-12)


def test_affine_models_are_inside_the_hull_of_their_corners():
    corners = AIRCRAFT.matrix("A", AIRCRAFT.vertices())
    inside = AIRCRAFT.matrix("A", np.random.default_rng(1).uniform(-1.0, 1.0, (4, 50)))
    assert np.all(inside <= corners.max(axis=2, keepdims=True) + 1e-9)
    assert np.all(inside >= corners.min(axis=2, keepdims=True) - 1e-9)


@pytest.mark.parametrize(
    ("values", "named"),
    [((1.0,), {}), ((1.0, 2.0, 3.0), {}), ((1.0,), {"p0": 2.0, "p1": 1.0}), ((1.0,), {"p2": 2.0})],
)
def test_a_parameter_is_given_once(values, named):
    model = AffineLpv(
        tables={"K": np.zeros((3, 1, 1, 1))}, names=("p0", "p1"), trim=np.zeros((2, 1)), scale=np.ones((2, 1))
    )
    with pytest.raises(MisfitError, match="rho needs each of p0, p1 once, got"):
        model.rho(*(np.array([v]) for v in values), **{name: np.array([v]) for name, v in named.items()})


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"tables": {"K": np.zeros((2, 1, 1, 1))}}, r"table K has shape \(2, 1, 1, 1\), need \(3, rows, columns, 1\)"),
        ({"trim": np.zeros(2)}, r"trim has shape \(2,\), need \(2, 1\)"),
        ({"scale": column([1.0, 0.0])}, r"scale is \[1.0, 0.0\]: no parameter may have a box without a width"),
        ({"names": ("p", "p")}, "a name stands twice"),
    ],
)
def test_what_is_no_model_is_refused(changed, message):
    whole = {
        "tables": {"K": np.zeros((3, 1, 1, 1))},
        "names": ("p", "q"),
        "trim": np.zeros((2, 1)),
        "scale": np.ones((2, 1)),
    }
    with pytest.raises(MisfitError, match=message):
        AffineLpv(**(whole | changed))
