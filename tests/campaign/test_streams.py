from hypothesis import given
from hypothesis import strategies as st

from fddbench.blocks import consumers
from fddbench.campaign.streams import flight_stream, scenario_stream

FROZEN_JAM_A = 0x22BF5626


@given(st.text(min_size=1))
def test_a_scenario_never_has_the_stream_of_a_flight(name):
    for purpose in ("tuning", "evaluation"):
        assert scenario_stream(purpose, name) != flight_stream(purpose)
        assert scenario_stream(purpose, name) >> 31 == flight_stream(purpose) >> 31
        assert scenario_stream(purpose, name) < 2**32


def test_consumers_are_frozen():
    """Append only: a changed number changes every published flight."""
    assert (consumers.SENSORS_A, consumers.SENSORS_B, consumers.GUST, consumers.START) == (0, 1, 2, 3)
    assert (consumers.FAULT_SLOT_0, consumers.FAULT_SLOTS) == (64, 32)
    assert (consumers.DISPERSION, consumers.MAX_ATTEMPTS) == (256, 256)
    assert scenario_stream("evaluation", "jam_a") == FROZEN_JAM_A
    assert scenario_stream("tuning", "jam_a") == FROZEN_JAM_A | 1 << 31
