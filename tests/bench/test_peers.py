"""Contract: everybody flies the same step; who is not here is skipped with a word."""

import warnings

import numpy as np
import pytest

from fddbench.blocks import llvm
from tests.bench import absent, peers
from tests.bench.report import Line
from tests.bench.step import data

RUNS, SAMPLES = 64, 50
# of the peers' own making: C++ has shorter sines, SciPy steps as it likes
TOLERANCES = {"numpy": 0.0, "one_by_one": 1e-12, "solve_ivp": 1e-7, "hand_written": 1e-9, "heyoka": 1e-12}


@pytest.mark.skipif(not llvm.available(), reason="no llvmlite")
@pytest.mark.parametrize("name", [*TOLERANCES])
def test_peers_fly_the_engine_s_step(name):
    expected = peers.engine(*data(RUNS))(SAMPLES)
    assert np.isfinite(expected).all()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a peer's own affairs
        try:
            fly = getattr(peers, name)(*data(RUNS))
        except absent.AbsentError as reason:
            pytest.skip(str(reason))
        flown = fly(SAMPLES)
    np.testing.assert_allclose(flown, expected, rtol=TOLERANCES[name], atol=TOLERANCES[name])


def test_absent_peers_are_named():
    with pytest.raises(absent.AbsentError, match="no_such_peer is not installed"):
        absent.need("no_such_peer")
    assert str(Line(what="a peer", note="not installed")).endswith("skipped: not installed")
