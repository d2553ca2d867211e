"""Law: elementary functions are as accurate as they say, against 80-bit arithmetic."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from fddbench.blocks import functions as f

RNG = np.random.default_rng(11)
LONG: Any = np.longdouble

pytestmark = pytest.mark.skipif(np.finfo(np.longdouble).nmant < 63, reason="no arithmetic here to compare with")


def _ulps(found: Any, exact: Any) -> float:
    return float(np.max(np.abs(found.astype(LONG) - exact) / np.spacing(np.abs(exact.astype(float)))))


@pytest.mark.parametrize(
    ("own", "exact", "x", "ulps"),
    [
        (f.log, np.log, RNG.lognormal(0.0, 50.0, 20_000), 1.0),
        (f.exp, np.exp, RNG.uniform(-700.0, 700.0, 20_000), 1.0),
        (f.asin, np.arcsin, RNG.uniform(-1.0, 1.0, 20_000), 3.0),
    ],
)
def test_relative_error(own: Callable[[Any], Any], exact: Any, x: Any, ulps: float) -> None:
    assert _ulps(own(x), exact(x.astype(LONG))) < ulps


@pytest.mark.parametrize(("own", "exact"), [(f.sin, np.sin), (f.cos, np.cos)])
def test_absolute_error_of_sine_and_cosine(own: Callable[[Any], Any], exact: Any) -> None:
    x = RNG.uniform(-100.0, 100.0, 50_000)
    assert float(np.max(np.abs(own(x) - exact(x.astype(LONG))))) < 1.5e-16


def test_angle_of_a_point() -> None:
    y, x = RNG.normal(size=(2, 20_000)) * RNG.lognormal(0.0, 5.0, (2, 20_000))
    assert _ulps(f.atan2(y, x), np.arctan2(y.astype(LONG), x.astype(LONG))) < 2.0


def test_powers() -> None:
    x, y = RNG.uniform(0.1, 3.0, 20_000), 5.2561
    exact = x.astype(LONG) ** LONG(y)
    allowed = (1.0 + np.abs(y * np.log(x))) * 2.2e-16
    assert np.all(np.abs((f.pow_(x, y) - exact) / exact) < allowed)


def test_out_of_range() -> None:
    with np.errstate(all="ignore"):
        assert np.isnan(f.log(np.array([0.0, -1.0, np.nan]))).all()
        assert f.log(np.array([np.inf]))[0] == np.inf
        assert f.exp(np.array([1000.0, -1000.0])).tolist() == [np.inf, 0.0]


def test_bilinear_table() -> None:
    knots_x, knots_y = np.array([[0.0], [1.0], [3.0]]), np.array([[0.0], [2.0]])
    values = (knots_x[:, np.newaxis] + 10.0 * knots_y)[..., np.newaxis].reshape(3, 2, 1)
    x, y = np.array([0.5, 2.0, 9.0, -1.0]), np.array([1.0, 0.5, 9.0, -1.0])
    np.testing.assert_allclose(f.interpolate_2d(x, y, knots_x, knots_y, values), [10.5, 7.0, 23.0, 0.0])
