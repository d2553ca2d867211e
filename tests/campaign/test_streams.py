import pytest
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
    assert (consumers.UNCERTAINTY_0, consumers.DISTURBANCE) == (4, 10)
    assert (consumers.DISPERSION, consumers.MAX_ATTEMPTS) == (256, 256)
    assert (consumers.SENSORS_MORE_0, consumers.FAULT_SITES_MORE_0, consumers.DETECTOR_0) == (512, 1024, 4096)
    assert (consumers.SENSORS_START, consumers.UNIT_NOISE_0, consumers.UNIT_ERRORS_0) == (18, 576, 3104)
    assert [consumers.unit_noise_number(j, 1) for j in (0, 1, 2, 255)] == [(576, 1), (576, 3), (577, 1), (703, 3)]
    assert [consumers.sensor_number(j) for j in (0, 2, 3, 6, 7)] == [(0, 0), (0, 2), (512, 0), (512, 3), (513, 0)]
    assert [consumers.fault_number(1, j) for j in (0, 3, 4, 8)] == [(65, 0), (65, 3), (1025, 0), (1057, 0)]
    assert scenario_stream("evaluation", "jam_a") == FROZEN_JAM_A
    assert scenario_stream("tuning", "jam_a") == FROZEN_JAM_A | 1 << 31


def test_no_two_names_have_one_number():
    """Every site in every slot, every redundant sensor and every attempt of a dispersion is drawn for itself alone."""
    faults = [
        consumers.fault_number(slot, site)
        for slot in range(consumers.FAULT_SLOTS)
        for site in range(consumers.MOST_SITES)
    ]
    sensors = [consumers.sensor_number(j) for j in range(consumers.MOST_SITES)]
    others = [(number, place) for number in (1, 2, 3, *range(4, 11)) for place in range(4)]
    dispersions = [(consumers.DISPERSION + attempt, 0) for attempt in range(consumers.MAX_ATTEMPTS)]
    every = [*faults, *sensors, *others, *dispersions, (consumers.DETECTOR_0, 0)]
    assert len(set(every)) == len(every)
    assert max(number for number, _ in every) == consumers.DETECTOR_0
    with pytest.raises(ValueError, match="site < 256"):
        consumers.fault_number(0, consumers.MOST_SITES)
    with pytest.raises(ValueError, match="below 256"):
        consumers.sensor_number(consumers.MOST_SITES)
