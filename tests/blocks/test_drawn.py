"""Random numbers by name: each has one owner, and the frozen addresses are what they always were."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fddbench.blocks import consumers
from fddbench.blocks.block import NO_DRAWS
from fddbench.blocks.consumers import fault_number, sensor_number
from fddbench.blocks.drawn import Draw, Draws
from fddbench.blocks.layout import Nothing, leaves, record


@record
class Two:
    one: object
    other: object


def test_a_number_under_two_names_is_refused():
    for other in (Draw(7, 1), Draw(7, 0, rows=2), Draw(7, 1, shared=True)):
        with pytest.raises(ValueError, match=r"drawn under two names or does not exist: \[\(7, 'flight', 1\)\]"):
            Draws(Two(one=Draw(7, 1), other=other))


def test_a_number_may_be_shared_when_all_its_names_share_it():
    draws = Draws(Two(one=Draw(64, 0, shared=True), other=(Draw(64, 0, shared=True), Draw(64, 1, shared=True))))
    found = draws.unpack(np.arange(4.0)[:, np.newaxis])
    assert (found.one[0], found.other[0][0], found.other[1][0]) == (0.0, 0.0, 1.0)


def test_the_same_number_of_two_streams_or_of_two_consumers_is_two_numbers():
    assert Draws(Two(one=Draw(64, 0), other=Draw(64, 0, stream="scenario"))).size == 8
    assert Draws(Two(one=Draw(64, 0), other=Draw(65, 0))).size == 8
    assert Draws(Two(one=Draw(64, 0), other=Draw(64, 1))).size == 4


@pytest.mark.parametrize("draw", [Draw(0, 4), Draw(0, 2, rows=3), Draw(0, -1)])
def test_a_number_beyond_the_four_of_a_consumer_does_not_exist(draw):
    with pytest.raises(ValueError, match="does not exist"):
        Draws(draw)
    assert Draws(Draw(0, 3)).size == Draws(Draw(0, 0, rows=4)).size == Draws(Draw(0, 2, rows=2)).size == 4


def test_streams_are_in_the_order_of_their_names_those_of_the_flight_first():
    names = (
        Draw(65, stream="scenario"),
        Draw(1, 1),
        Draw(64, stream="scenario"),
        Draw(0),
        Draw(1, 0),
        Draw(65, 1, stream="scenario"),
    )
    assert Draws(names).streams == ((1, "flight"), (0, "flight"), (65, "scenario"), (64, "scenario"))


def test_a_name_gets_its_own_row_of_the_kernel_s_normals():
    draws = Draws(Two(one=(Draw(9, 2), Draw(5, 1, rows=2)), other=Draw(5, 3, stream="scenario")))
    rows = np.arange(12.0)[:, np.newaxis] * np.ones(2)
    found = draws.unpack(rows)
    assert draws.streams == ((9, "flight"), (5, "flight"), (5, "scenario"))
    assert found.one[0].tolist() == [2.0, 2.0]
    assert found.one[1].tolist() == [[5.0, 5.0], [6.0, 6.0]]
    assert found.other.tolist() == [11.0, 11.0]


numbers = st.tuples(st.integers(0, 6), st.integers(0, 3), st.sampled_from(("flight", "scenario")))


@given(st.lists(numbers, unique=True, max_size=12))
def test_whatever_is_drawn_is_the_number_of_its_address(addresses):
    draws = Draws(tuple(Draw(consumer, place, stream=stream) for consumer, place, stream in addresses))
    code = {"flight": 0.0, "scenario": 1000.0}
    rows = [[code[stream] + 10.0 * consumer + place] for consumer, stream in draws.streams for place in range(4)]
    found = draws.unpack(np.array(rows).reshape(draws.size, 1))
    assert [row[0] for row in found] == [
        code[stream] + 10.0 * consumer + place for consumer, place, stream in addresses
    ]


def test_what_draws_nothing_has_no_streams():
    assert (NO_DRAWS.streams, NO_DRAWS.size) == ((), 0)
    assert NO_DRAWS.unpack(np.zeros((0, 5))) == Nothing()
    assert list(leaves(NO_DRAWS.names)) == []


# the addresses of every published flight
def test_frozen_numbers_of_sensors():
    assert [sensor_number(j) for j in range(3)] == [(0, 0), (0, 1), (0, 2)]
    assert (consumers.SENSORS_A, consumers.SENSORS_B, consumers.GUST, consumers.START) == (0, 1, 2, 3)
    assert [sensor_number(j) for j in (3, 4, 6, 7, 255)] == [(512, 0), (512, 1), (512, 3), (513, 0), (575, 0)]


def test_frozen_numbers_of_fault_slots():
    for slot in range(32):
        assert [fault_number(slot, site) for site in range(4)] == [(64 + slot, place) for place in range(4)]
    assert [fault_number(j, 4) for j in (0, 1, 31)] == [(1024, 0), (1025, 0), (1055, 0)]
    assert [fault_number(0, i) for i in (5, 7, 8, 255)] == [(1024, 1), (1024, 3), (1056, 0), (3008, 3)]
    assert fault_number(31, 255) == (3039, 3)


def test_frozen_numbers_of_everything_else():
    assert (consumers.UNCERTAINTY_0, consumers.DISTURBANCE, consumers.DISPERSION, consumers.DETECTOR_0) == (
        4,
        10,
        256,
        4096,
    )
    assert (consumers.FAULT_SLOT_0, consumers.FAULT_SLOTS, consumers.MAX_ATTEMPTS, consumers.MOST_SITES) == (
        64,
        32,
        256,
        256,
    )


def test_no_two_have_the_same_number():
    sensors = [sensor_number(j) for j in range(consumers.MOST_SITES)]
    faults = [fault_number(j, i) for j in range(consumers.FAULT_SLOTS) for i in range(consumers.MOST_SITES)]
    # sideslip is the fourth number of the first sensors; 1 to 10 are the other parts of a flight, four numbers each
    others = [(0, 3), *((consumer, place) for consumer in range(1, 11) for place in range(4))]
    dispersion = [(256 + attempt, place) for attempt in range(256) for place in range(4)]
    every = [*sensors, *faults, *others, *dispersion]
    assert len(set(every)) == len(every)
    assert max(consumer for consumer, _ in every) < consumers.DETECTOR_0
    assert {place for _, place in every} == {0, 1, 2, 3}


@pytest.mark.parametrize(("slot", "site"), [(32, 0), (-1, 0), (0, 256), (0, -1)])
def test_a_slot_or_site_without_a_number_is_refused(slot, site):
    with pytest.raises(ValueError, match=rf"need slot < 32 and site < 256, got slot={slot}, site={site}"):
        fault_number(slot, site)


@pytest.mark.parametrize("sensor", [-1, 256])
def test_a_sensor_without_a_number_is_refused(sensor):
    with pytest.raises(ValueError, match=f"need a sensor below 256, got {sensor}"):
        sensor_number(sensor)
