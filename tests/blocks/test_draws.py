"""Literature: the known answers of Random123, in NumPy and inside a kernel; and normals with the same bits in both."""

from typing import Any

import numpy as np
import pytest

from fddbench.blocks import philox
from fddbench.blocks.kernel import Addresses, build
from fddbench.blocks.program import trace

ANSWERS = [
    ((0, 0, 0, 0), 0, "6627e8d5 e169c58d bc57ac4c 9b00dbd8"),
    ((0xFFFFFFFF,) * 4, 0xFFFFFFFFFFFFFFFF, "408f276d 41c83b0e a20bc7c6 6d5451fd"),
    ((0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344), 0x299F31D0A4093822, "d16cfe09 94fdcceb 5001e420 24126ea1"),
]


@pytest.mark.parametrize(("counter", "key", "expected"), ANSWERS)
def test_known_answers_in_numpy(counter: Any, key: int, expected: str) -> None:
    assert " ".join(f"{int(word):08x}" for word in philox.philox4x32(counter, key)) == expected


@pytest.mark.parametrize(("counter", "key", "expected"), ANSWERS)
@pytest.mark.parametrize("stream", ["flight", "scenario"])
def test_known_answers_in_a_kernel(where: Any, counter: Any, key: int, expected: str, stream: str) -> None:
    program = trace(lambda state, uniforms: {"state": state, "y": uniforms}, state=1, uniforms=4)
    sample, consumer, run, word = counter
    whose = {"consumers" if stream == "flight" else "fault_consumers": (consumer,)}
    other = "scenario" if stream == "flight" else "flight"
    flown = build(program, recorded=("y",), **whose, **where).fly(
        np.zeros((1, 1)), np.zeros((0, 1)), np.array([sample + 1]),
        Addresses(key=key, run=run, **{stream: word, other: 77}), first=sample, end=sample + 1,
    )  # fmt: skip
    words = (flown.recorded["y"][0, :, 0] * 2.0**32 - 0.5).astype(np.int64)
    assert " ".join(f"{word:08x}" for word in words) == expected


def test_normals_have_the_same_bits(where: Any, same: Any) -> None:
    program = trace(lambda state, normals: {"state": state, "y": normals}, state=1, normals=12)
    n_cases, first, end, key = 37, 4_000_000, 4_000_020, 0xDEADBEEFCAFEF00D
    run, scenario = np.arange(n_cases) * 7919, np.arange(n_cases) % 3 + 10
    flown = build(program, consumers=(5, 2), fault_consumers=(9,), recorded=("y",), **where).fly(
        np.zeros((1, n_cases)), np.zeros((0, n_cases)), np.full(n_cases, end),
        Addresses(key=key, run=run, flight=3, scenario=scenario), first=first, end=end,
    )  # fmt: skip
    for k in range(first, end):
        parts = [philox.normals((k, c, run, w), key) for c, w in ((5, 3), (2, 3), (9, scenario))]
        assert same(flown.recorded["y"][k - first], np.concatenate(parts))


def test_normals_are_normal() -> None:
    drawn = philox.normals((np.arange(50_000), 1, 2, 3), 4).ravel()
    assert abs(drawn.mean()) < 0.01
    assert abs(drawn.std() - 1.0) < 0.01
    assert abs((np.abs(drawn) > 1.959964).mean() - 0.05) < 0.002
