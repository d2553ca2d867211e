"""Figures as systems: the same as the algebra of feedback, and refusals."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fddbench.design.tracking.wiring import Block, wire
from fddbench.errors import DesignError
from fddbench.systems import StateSpace, feedback


def drawn(seed, n):
    random = np.random.default_rng(seed)
    A = random.standard_normal((n, n))
    return StateSpace(A, *(random.standard_normal(shape) for shape in ((n, 1), (1, n), (1, 1))))


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32), st.integers(0, 3), st.integers(0, 3), st.floats(0.01, 100.0))
def test_a_wired_loop_is_the_feedback_of_its_blocks(seed, n, m, frequency):
    G, K = drawn(seed, n), drawn(seed + 1, m)
    blocks = [Block(G, ["u"], ["y"]), Block(K, ["y"], ["v"])]
    wired = wire(blocks, {"u": {"c": 1.0, "v": -1.0}}, inputs=["c"], outputs={"y": {"y": 1.0}})
    np.testing.assert_allclose(wired.at(frequency), feedback(G, K).at(frequency), rtol=1e-6, atol=1e-9)


def test_a_signal_that_is_none_is_refused_with_those_there_are():
    lag = Block(StateSpace.diagonal([-1.0], [1.0], [1.0], [0.0]), ["u"], ["y"])
    with pytest.raises(DesignError, match="no signal of the figure is called 'z'; known: y, c"):
        wire([lag], {"u": {"z": 1.0}}, inputs=["c"], outputs={})


def test_a_loop_without_a_lag_and_wrong_counts_of_names_are_refused():
    one = Block(StateSpace.gain(1.0), ["u"], ["y"])
    with pytest.raises(DesignError, match="loop without any lag"):
        wire([one], {"u": {"y": 1.0}}, inputs=["c"], outputs={})
    with pytest.raises(DesignError, match="1 inputs and 1 outputs needs as many names"):
        Block(StateSpace.gain(1.0), ["a", "b"], ["y"])
