"""Who draws which random numbers: the frozen second word of every Philox counter.

Append only. A number that changes or is used twice changes every published flight.
"""

from typing import Final

__all__ = [
    "DISPERSION",
    "DISTURBANCE",
    "FAULT_SLOTS",
    "FAULT_SLOT_0",
    "GUST",
    "MAX_ATTEMPTS",
    "SENSORS_A",
    "SENSORS_B",
    "START",
    "UNCERTAINTY_0",
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

FAULT_SLOT_0: Final = 64
"""First fault of a scenario, the next ones follow: 64..95."""
FAULT_SLOTS: Final = 32
"""Fault slots that have a number."""

DISPERSION: Final = 256
"""Dispersed parameters, first attempt of the rejection sampling; the next ones follow: 256..511."""
MAX_ATTEMPTS: Final = 256
"""Attempts that have a number."""
