"""Fourth word of every random counter: who shares random numbers with whom.

The top bit is the purpose, so that tuning and evaluation never share a flight. The low 31 bits are 0 for what belongs
to the flight itself (run 7 of every scenario flies the same aircraft in the same air) and a hash of the scenario's name
for its faults.
"""

from hashlib import sha256

from fddbench.campaign.rules.model import Purpose

__all__ = ["flight_stream", "name_word", "scenario_stream"]

_TUNING = 0x8000_0000
_LOW_31 = 0x7FFF_FFFF


def name_word(name: str) -> int:
    """First 32 bits of the SHA-256 of a name.

    >>> hex(name_word("mass_kg"))
    '0xd27b0642'
    """
    return int.from_bytes(sha256(name.encode()).digest()[:4], "big")


def flight_stream(purpose: Purpose) -> int:
    """Stream of dispersions, sensor noise and turbulence, 32 bits.

    >>> flight_stream("evaluation"), hex(flight_stream("tuning"))
    (0, '0x80000000')
    """
    return _TUNING if purpose == "tuning" else 0


def scenario_stream(purpose: Purpose, scenario_name: str) -> int:
    """Stream of the faults of a scenario, 32 bits; never that of a flight."""
    return flight_stream(purpose) | ((name_word(scenario_name) & _LOW_31) or 1)
