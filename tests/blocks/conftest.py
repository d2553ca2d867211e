"""Where compiled code can run here, and what it means that bits agree."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from fddbench.blocks import llvm
from fddbench.blocks.kernel import Addresses, build
from fddbench.blocks.program import Program

LANES = (1, 4, 8, 16)
TARGETS = ("x86-64", "nehalem", "haswell", "host")


@pytest.fixture(scope="session", autouse=True)
def _own_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Compile afresh: a cache entry of yesterday would hide a mistake of today."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("FDDBENCH_CACHE", str(tmp_path_factory.mktemp("objects")))
        yield


@pytest.fixture(params=[(target, lanes) for target in TARGETS for lanes in LANES], ids=lambda p: f"{p[0]}-{p[1]}")
def where(request: pytest.FixtureRequest) -> dict[str, Any]:
    """Processor and width to compile for."""
    pytest.importorskip("llvmlite")
    target, lanes = request.param
    if llvm.machine(target) is None:
        pytest.skip(f"this processor does not run {target} code")
    return {"backend": "llvm", "target": target, "lanes": lanes}


@pytest.fixture(scope="session")
def same() -> Callable[[Any, Any], bool]:
    """Whether two arrays have the same bits, any not-a-number being as good as another."""

    def agree(a: Any, b: Any) -> bool:
        a, b = np.ascontiguousarray(a, dtype=float), np.ascontiguousarray(b, dtype=float)
        nans = np.isnan(a)
        if a.shape != b.shape or not np.array_equal(nans, np.isnan(b)):
            return False
        return np.array_equal(a.view(np.int64)[~nans], b.view(np.int64)[~nans])

    return agree


@pytest.fixture(scope="session")
def once() -> Callable[..., Any]:
    """Outputs ``y`` of a program of ``state`` rows, flown for one sample."""

    def run(program: Program, state: Any, **where: Any) -> Any:
        state = np.asarray(state, dtype=float)
        n_cases = state.shape[1]
        flown = build(program, recorded=("y",), **where).fly(
            state, np.zeros((0, n_cases)), np.ones(n_cases, dtype=np.int64), NOWHERE, first=0, end=1
        )
        return flown.recorded["y"][0]

    return run


NOWHERE = Addresses(key=0, run=0, flight=0, scenario=0)
"""Random addresses for steps that draw nothing."""
