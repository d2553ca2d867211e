"""Detection curves: known curves are found again, the end at 95 % holds, and a curve that never gets there says so."""

import numpy as np
import pytest
from scipy.special import ndtr, ndtri

from fddbench.errors import FddbenchError
from fddbench.metrics.detection_curve import detection_curve


def flights(rng, *, n=200, m=0.0, s=0.3, floor=0.0, ceiling=1.0, levels=None):
    """Sizes and whether each was found, of a known curve."""
    x = rng.choice(np.log(levels), n) if levels is not None else rng.uniform(m - 1.2, m + 1.2, n)
    return np.exp(x), rng.random(n) < floor + (ceiling - floor) * ndtr((x - m) / s)


def test_a_known_curve_is_found_again():
    size, found = flights(np.random.default_rng(1), n=2000, m=0.5, s=0.3)
    fit = detection_curve(size, found, np.arange(2000))
    assert (fit.floor, fit.ceiling) == (0.0, 1.0)
    assert fit.middle == pytest.approx(np.exp(0.5), rel=0.03)
    assert fit.spread == pytest.approx(0.3, rel=0.15)
    assert fit.size_90 == pytest.approx(np.exp(0.5 + 0.3 * ndtri(0.9)), rel=0.06)
    assert fit.share(fit.size_90) == pytest.approx(0.9)
    assert fit.size_90 < fit.size_90_95 < 1.1 * fit.size_90


def test_the_upper_end_holds_the_truth():
    rng, truth, inside = np.random.default_rng(2), np.exp(0.3 * ndtri(0.9)), 0
    for _ in range(30):
        fit = detection_curve(*flights(rng, n=120, levels=[0.4, 0.6, 0.8, 1.0, 1.3, 1.7, 2.2]), np.arange(120))
        inside += fit.size_90_95 is None or fit.size_90_95 >= truth
    assert inside >= 26  # 28.5 on average; fewer would be 6 in 1000


def test_floor_and_ceiling_where_the_flights_want_them_and_no_size_where_the_curve_ends_below():
    rng = np.random.default_rng(3)
    capped = detection_curve(*flights(rng, n=1500, ceiling=0.7), np.arange(1500))
    assert capped.ceiling == pytest.approx(0.7, abs=0.05)
    assert (capped.size_90, capped.size_90_95) == (None, None)
    assert capped.size_50 is not None
    floored = detection_curve(*flights(rng, n=1500, floor=0.3), np.arange(1500))
    assert floored.floor == pytest.approx(0.3, abs=0.07)
    assert floored.size_90 == pytest.approx(np.exp(0.3 * ndtri((0.9 - 0.3) / 0.7)), rel=0.12)


def test_flights_of_one_run_tell_less():
    size, found = flights(np.random.default_rng(4), n=100, levels=[0.5, 0.8, 1.0, 1.25, 2.0])
    once = detection_curve(size, found, np.arange(100))
    often = detection_curve(np.tile(size, 6), np.tile(found, 6), np.tile(np.arange(100), 6))
    assert often.size_90 == pytest.approx(once.size_90, rel=1e-3)
    assert often.design_effect == pytest.approx(6.0 * once.design_effect, rel=0.05) or once.design_effect == 1.0
    assert often.size_90_95 == pytest.approx(once.size_90_95, rel=0.05)


def test_a_step_between_two_sizes_is_no_trouble():
    size = np.repeat([1.0, 2.0, 4.0, 8.0], 20)
    fit = detection_curve(size, size > 3.0, np.arange(80))
    assert 2.0 <= fit.size_90 <= 4.0
    assert 2.0 < fit.size_90_95 <= 4.2


@pytest.mark.parametrize("size", [np.ones(30), np.linspace(0.0, 1.0, 30), np.linspace(1.0, 2.0, 10)])
def test_what_gives_no_curve_is_refused_in_words(size):
    with pytest.raises(
        FddbenchError, match="a detection curve needs 20 or more flights of three or more sizes above 0"
    ):
        detection_curve(size, np.ones(len(size)), np.arange(len(size)))
