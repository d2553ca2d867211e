"""Who draws which random numbers: the frozen second word of every Philox counter.

Append only. A number that changes or is used twice changes every published flight.
"""

from typing import Final

__all__ = [
    "DETECTOR_0",
    "DISPERSION",
    "DISTURBANCE",
    "DRYDEN_LATERAL",
    "DRYDEN_LATERAL_START",
    "DRYDEN_LONGITUDINAL",
    "DRYDEN_LONGITUDINAL_START",
    "FAULT_NUMBERS_0",
    "FAULT_SLOTS",
    "FAULT_SLOT_0",
    "GUST",
    "MAX_ATTEMPTS",
    "MOST_SITES",
    "SENSORS_A",
    "SENSORS_B",
    "SENSORS_C",
    "SENSORS_D",
    "SENSORS_START",
    "START",
    "UNCERTAINTY_0",
    "UNIT_ERRORS_0",
    "UNIT_NOISE_0",
    "fault_number",
    "sensor_number",
    "unit_noise_number",
]

SENSORS_A: Final = 0
"""Sensor noise, first four numbers of a sample."""
SENSORS_B: Final = 1
"""Sensor noise, next four."""
GUST: Final = 2
"""Turbulence of a sample."""
START: Final = 3
"""What is random before the first sample; 3..31 are reserved for the flight itself."""
UNCERTAINTY_0: Final = 4
"""Uncertain dynamics of a flight, first four numbers; the next ones follow: 4..9."""
DISTURBANCE: Final = 10
"""Disturbances of a sample, at most four."""
SENSORS_C: Final = 11
"""Sensor noise, four more."""
DRYDEN_LONGITUDINAL: Final = 12
"""Dryden turbulence of a sample in the plane of symmetry: one number of u, three of w (q follows from w)."""
DRYDEN_LATERAL: Final = 13
"""Dryden turbulence of a sample out of it: three numbers of v (r follows from v), one of p."""
DRYDEN_LONGITUDINAL_START: Final = 14
"""The same before the first sample."""
DRYDEN_LATERAL_START: Final = 15
"""The same before the first sample; 16 is kept for what turbulence may need besides."""
SENSORS_D: Final = 17
"""Sensor noise, four more."""
SENSORS_START: Final = 18
"""Errors of single sensors before the first sample: sideslip, airspeed."""

FAULT_SLOT_0: Final = 64
"""First fault of a scenario, its first four sites; the next faults follow: 64..95."""
FAULT_SLOTS: Final = 32
"""Fault slots that have a number."""

DISPERSION: Final = 256
"""Dispersed parameters, first attempt of the rejection sampling; the next ones follow: 256..511."""
MAX_ATTEMPTS: Final = 256
"""Attempts that have a number."""

SENSORS_MORE_0: Final = 512
"""Noise of the fourth redundant sensor and of the next ones, four of them a number: 512..575."""
UNIT_NOISE_0: Final = 576
"""Noise of the roll rate and of the bank angle of two inertial units; the next two follow: 576..703."""
FAULT_SITES_MORE_0: Final = 1024
"""Fifth fault site and the next ones, four of them a number, slot after slot: 1024 + 32 (site // 4 - 1) + slot, to 3039."""
FAULT_NUMBERS_0: Final = 3072
"""Sizes and times of the first fault of a scenario that are drawn once a flight; the next faults follow: 3072..3103."""
UNIT_ERRORS_0: Final = 3104
"""Errors of an inertial unit before the first sample, eight numbers, so two consumers a unit: 3104..3615."""
MOST_SITES: Final = 256
"""Fault sites of a benchmark, and redundant sensors, that have a number."""
DETECTOR_0: Final = 4096
"""Detectors that draw random numbers; 4096..8191 are theirs, and two that take the same number see the same noise."""

_FOUR: Final = 4


def fault_number(slot: int, site: int) -> tuple[int, int]:
    """Consumer, and place among its four numbers, of a site (by its position in the benchmark) in a fault slot.

    >>> fault_number(0, 2), fault_number(1, 0), fault_number(1, 5)
    ((64, 2), (65, 0), (1025, 1))
    """
    four, place = divmod(site, _FOUR)
    if not (0 <= slot < FAULT_SLOTS and 0 <= site < MOST_SITES):
        raise ValueError(f"need slot < {FAULT_SLOTS} and site < {MOST_SITES}, got {slot=}, {site=}")
    return (FAULT_SLOT_0 + slot if four == 0 else FAULT_SITES_MORE_0 + FAULT_SLOTS * (four - 1) + slot), place


def sensor_number(sensor: int) -> tuple[int, int]:
    """Consumer, and place among its four numbers, of a redundant sensor; the fourth number of the first is another's.

    >>> sensor_number(2), sensor_number(3), sensor_number(7)
    ((0, 2), (512, 0), (513, 0))
    """
    if not 0 <= sensor < MOST_SITES:
        raise ValueError(f"need a sensor below {MOST_SITES}, got {sensor}")
    first = 3
    if sensor < first:
        return SENSORS_A, sensor
    more, place = divmod(sensor - first, _FOUR)
    return SENSORS_MORE_0 + more, place


def unit_noise_number(unit: int, signal: int) -> tuple[int, int]:
    """Consumer, and place among its four numbers, of the roll rate (0) and of the bank angle (1) of an inertial unit.

    >>> unit_noise_number(0, 0), unit_noise_number(1, 1), unit_noise_number(2, 0)
    ((576, 0), (576, 3), (577, 0))
    """
    if not (0 <= unit < MOST_SITES and signal in (0, 1)):
        raise ValueError(f"need a unit below {MOST_SITES} and a signal 0 or 1, got {unit=}, {signal=}")
    more, place = divmod(2 * unit + signal, _FOUR)
    return UNIT_NOISE_0 + more, place
