"""Whether a voter keeps the contract."""

from pathlib import Path

import numpy as np

from fddbench import kinds
from fddbench.blocks.layout import Nothing
from fddbench.blocks.program import trace
from fddbench.testing.campaigns import require
from fddbench.voting.block import VoterBlock

__all__ = ["check_voter"]

_CASES, _SAMPLES, _SAMPLE_S = 5, 20, 0.01


def check_voter(name: str, *, beside: str | Path = ".", n_sensors: int = 3) -> None:
    """Vote random sensors.

    The voted signal of equal sensors is theirs; it has the same bits in any company; it can be compiled.

    Parameters
    ----------
    name : str
        A registered voter, or ``mine.py:Mine``.
    beside : str or Path
        Folder of that file.
    n_sensors : int
        How many sensors.

    Raises
    ------
    AssertionError
        With what is wrong.
    FddbenchError
        It cannot be used at all.

    Examples
    --------
    >>> check_voter("median")
    """
    kind = kinds.find("voter", name, beside=Path(beside)).member
    block = VoterBlock.on(kind, "r_deg_s", n_sensors, _SAMPLE_S)
    sensors = np.random.default_rng(3).normal(size=(_SAMPLES, n_sensors, _CASES))
    together = _voted(block, sensors)
    require(together.shape == (_SAMPLES, _CASES), f"{name} gives the shape {together.shape[1:]}, needs (n_cases,)")
    require(
        np.array_equal(_voted(block, sensors[:, :, :1]), together[:, :1]), f"{name} depends on the company of flights"
    )
    equal = np.repeat(sensors[:, :1], n_sensors, axis=1)
    require(np.allclose(_voted(block, equal), equal[:, 0], rtol=1e-12), f"{name} of equal sensors is not their value")

    def step(state: object, sensors: object) -> dict[str, object]:
        after, voted = block.step(block.states.unpack(state), Nothing(), Nothing(), sensors)
        return {"state": block.states.pack(after), "voted": voted}

    trace(step, state=block.states.size, sensors=n_sensors)


def _voted(block: VoterBlock, sensors: np.ndarray) -> np.ndarray:
    """Voted signal, (n_time, n_cases)."""
    x, found = block.states.spread(block.start(Nothing()), sensors.shape[2]), []
    for rows in sensors:
        x, voted = block.step(x, Nothing(), Nothing(), rows)
        found.append(voted)
    return np.array(found)
