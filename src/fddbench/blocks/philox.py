"""Random numbers by address: Philox4x32-10, so that flight 7 flies in the same air whatever flies beside it.

A draw is a pure function of a key (the campaign's seed) and a counter of four 32-bit words (sample, consumer, run,
stream), so any number of any flight can be had alone, in any order, on any worker.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.blocks.functions import cos, log, sin
from fddbench.blocks.layout import Rows

__all__ = ["PER_DRAW", "box_muller", "normals", "philox4x32", "uniforms"]

Words = npt.NDArray[np.uint64]

PER_DRAW = 4
"""Normals that one counter yields: four 32-bit words, two Box-Muller pairs."""

_M0, _M1 = np.uint64(0xD2511F53), np.uint64(0xCD9E8D57)
_W0, _W1 = 0x9E3779B9, 0xBB67AE85
_LOW, _HALF = np.uint64(0xFFFFFFFF), np.uint64(32)
_UNIT = 2.0**-32


def philox4x32(counter: tuple[Any, Any, Any, Any], key: int) -> tuple[Words, Words, Words, Words]:
    """Four random 32-bit words (held in uint64) for every counter.

    Parameters
    ----------
    counter : four integers or arrays of them, broadcast together
        Words of 32 bits, least significant first.
    key : int
        64 bits.

    References
    ----------
    Salmon, Moraes, Dror, Shaw (2011), Parallel random numbers: as easy as 1, 2, 3, SC'11; constants and the known
    answers of the tests from the authors' Random123 library.
    """
    x0, x1, x2, x3 = np.broadcast_arrays(*(np.asarray(word, dtype=np.uint64) for word in counter))
    k0, k1 = key & 0xFFFFFFFF, key >> 32
    for _ in range(10):
        p0, p1 = x0 * _M0, x2 * _M1
        x0, x1, x2, x3 = (p1 >> _HALF) ^ x1 ^ np.uint64(k0), p1 & _LOW, (p0 >> _HALF) ^ x3 ^ np.uint64(k1), p0 & _LOW
        k0, k1 = (k0 + _W0) & 0xFFFFFFFF, (k1 + _W1) & 0xFFFFFFFF
    return x0, x1, x2, x3


def uniforms(counter: tuple[Any, Any, Any, Any], key: int) -> npt.NDArray[np.float64]:
    """Four uniform numbers of the open interval (0, 1) per counter, (4, ...), of 32 bits each: (word + 1/2) / 2^32."""
    return (np.stack(philox4x32(counter, key)).astype(float) + 0.5) * _UNIT


def normals(counter: tuple[Any, Any, Any, Any], key: int) -> npt.NDArray[np.float64]:
    """Four standard normal numbers per counter, (4, ...), by Box-Muller; the largest possible is 6.76 sigma."""
    drawn: npt.NDArray[np.float64] = box_muller(uniforms(counter, key))
    return drawn


def box_muller(u: Rows) -> Rows:
    """Standard normal numbers, (2 n, ...), of as many uniform ones."""
    radius = np.sqrt(-2.0 * log(u[0::2]))
    angle = (2.0 * np.pi) * u[1::2]
    out = np.empty_like(u)
    out[0::2], out[1::2] = radius * cos(angle), radius * sin(angle)
    return out
