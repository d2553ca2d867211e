"""What exported C takes: bytes and ticks, of a small and of a large detector."""

import pytest

from fddbench.exported.code import sources
from fddbench.exported.compiling import compiler
from fddbench.exported.load_c import load_in_c
from tests.exported.conftest import assembled, exported


def load(name):
    interface, *_ = exported("smoke", name)
    return load_in_c(interface, sources(interface, assembled("smoke").detectors[name].detector), compiler("gcc"))


@pytest.mark.slow
def test_the_observer_takes_more_than_the_comparison():
    small, large = load("voting_monitor"), load("sliding_mode_published")
    assert (small.state_bytes, large.state_bytes) == (40, 384)
    assert small.code_bytes < large.code_bytes
    assert small.table_bytes < large.table_bytes
    assert 0 < small.stack_bytes < large.stack_bytes
    assert small.ticks is None or small.ticks < large.ticks
    assert "one path, the longest (gcc" in str(small)
