"""What exported C takes: bytes and ticks, of a small and of a large detector."""

import pytest

from fddbench.exported.code import sources
from fddbench.exported.compiling import CompileError, compiler
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
    assert "inputs 0; no loop depends on data (gcc" in str(large) or large.ticks is None


@pytest.mark.slow
def test_the_stack_is_that_of_a_step():
    interface, *_ = exported("smoke", "voting_monitor")
    files = sources(interface, assembled("smoke").detectors["voting_monitor"].detector)
    name = f"{interface.name}.c"
    large = "    volatile double room[1000];\n    room[0U] = 0.0;\n"
    found = {}
    for function in ("init", "step"):
        head, body = files[name].split(f"void voting_monitor_{function}(", 1)
        text = f"{head}void voting_monitor_{function}({body.replace('{' + chr(10), '{' + chr(10) + large, 1)}"
        found[function] = load_in_c(interface, {**files, name: text}, compiler("gcc")).stack_bytes
    own = load("voting_monitor").stack_bytes
    assert found["init"] == own
    assert found["step"] >= own + 8000 - 200


@pytest.mark.slow
def test_a_compiler_that_refuses_is_said_in_words():
    interface, *_ = exported("smoke", "voting_monitor")
    with pytest.raises(CompileError, match="gcc ended with 1: .*no_such_header"):
        load_in_c(interface, {"voting_monitor.c": "#include <no_such_header.h>\n"}, compiler("gcc"))
