"""Laws of flying: width, company, pauses and recording change no bit."""

import builtins
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import PackageNotFoundError
from typing import Any

import numpy as np
import pytest

from fddbench.blocks import functions, llvm
from fddbench.blocks.kernel import Addresses, Compiled, Interpreted, build
from fddbench.blocks.primitives import pick
from fddbench.blocks.program import Program, trace
from fddbench.blocks.ring import ring
from fddbench.errors import FddbenchError

N_STATE, DRAWS = 12, {"consumers": (0, 1), "fault_consumers": (64,)}


def _step(state: Any, constants: Any, normals: Any, sample: Any) -> dict[str, Any]:
    x, held, delayed = state[:4], state[4:7], state[7:]
    share = functions.exp(-constants[0]) + 1.0 / (1.0 + constants[1] * constants[1])
    light = constants[1] > 0.0
    drive = functions.sin(0.01 * sample * constants[2]) + np.where(light, normals[1:5], normals[5:9]) * 0.1
    moved = x * (0.9 + 0.05 * np.minimum(share, 1.0)) + drive + normals[9] * np.where(sample >= 8.0, 0.3, 0.0)
    delayed, oldest = ring(delayed, moved[0], sample)
    held = np.concatenate([held[1:], (oldest + moved[1])[np.newaxis]])
    gone = np.abs(moved[3]) > constants[3]
    return {
        "state": np.concatenate([moved, held, delayed]),
        "seen": np.stack([oldest, held[0], moved[2]]),
        "gone": gone[np.newaxis],
        "finished": gone[np.newaxis],
    }


def _program() -> Program:
    return trace(_step, state=N_STATE, constants=4, normals=12, sample=0)


def _flight(n_cases: int) -> dict[str, Any]:
    rng = np.random.default_rng(7)
    case = np.arange(200)
    constants = np.concatenate([rng.normal(size=(3, 200)), rng.uniform(0.5, 3.0, (1, 200))])
    return {
        "state": rng.normal(size=(N_STATE, 200))[:, :n_cases],
        "constants": constants[:, :n_cases],
        "samples": rng.integers(0, 60, 200)[:n_cases],
        "addresses": Addresses(key=2**63 + 5, run=case[:n_cases] * 3, flight=1, scenario=(case % 4 + 2**31)[:n_cases]),
    }


@pytest.mark.parametrize("n_cases", [1, 3, 64, 100])
def test_machine_code_flies_as_numpy_does(where: Any, same: Any, n_cases: int) -> None:
    chunk = _flight(n_cases)
    expected, found = (
        build(_program(), recorded=("seen", "gone"), **DRAWS, **how).fly(**chunk, first=0, end=50)
        for how in ({"backend": "numpy"}, where)
    )
    assert same(found.state, expected.state)
    assert np.array_equal(found.samples, expected.samples)
    assert all(same(found.recorded[name], expected.recorded[name]) for name in ("seen", "gone"))
    assert np.isnan(found.recorded["seen"]).any()


@pytest.mark.parametrize("backend", ["numpy", "llvm"])
def test_company_and_pauses_change_nothing(same: Any, backend: str) -> None:
    if backend == "llvm":
        pytest.importorskip("llvmlite")
    kernel, whole = build(_program(), backend=backend, **DRAWS), _flight(100)
    together = kernel.fly(**whole, first=0, end=60)
    chunk, paused = _flight(7), None
    state, samples = chunk.pop("state"), chunk.pop("samples")
    for first in range(0, 60, 11):
        paused = kernel.fly(state, samples=samples, **chunk, first=first, end=min(first + 11, 60))
        state, samples = paused.state, paused.samples
    assert same(state, together.state[:, :7])
    assert np.array_equal(samples, together.samples[:7])
    assert (together.samples < whole["samples"]).any()


@pytest.mark.parametrize("backend", ["numpy", "llvm"])
def test_recording_changes_nothing(same: Any, backend: str) -> None:
    if backend == "llvm":
        pytest.importorskip("llvmlite")
    silent, recording = (build(_program(), backend=backend, recorded=names, **DRAWS) for names in ((), ("seen",)))
    assert same(silent.fly(**_flight(30), first=0, end=60).state, recording.fly(**_flight(30), first=0, end=60).state)


def test_threads_share_a_kernel(same: Any) -> None:
    kernel = build(_program(), **DRAWS)
    chunks = [_flight(n_cases) for n_cases in (100, 37, 64, 5)] * 4
    alone = [kernel.fly(**chunk, first=0, end=60).state for chunk in chunks]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda chunk: kernel.fly(**chunk, first=0, end=60).state, chunks))
    assert all(same(a, b) for a, b in zip(alone, together, strict=True))


def test_arrays_may_lie_in_memory_as_they_like(same: Any) -> None:
    kernel, chunk = build(_program(), **DRAWS), _flight(33)
    turned = {name: np.asfortranarray(chunk[name]) for name in ("state", "constants")}
    assert same(kernel.fly(**chunk, first=0, end=60).state, kernel.fly(**(chunk | turned), first=0, end=60).state)


def test_inputs_are_left_alone() -> None:
    chunk, copy = _flight(32), _flight(32)
    build(_program(), **DRAWS).fly(**chunk, first=0, end=60)
    assert np.array_equal(chunk["state"], copy["state"])
    assert np.array_equal(chunk["samples"], copy["samples"])


@pytest.mark.parametrize("backend", ["numpy", "llvm"])
def test_nothing_to_fly(backend: str) -> None:
    if backend == "llvm":
        pytest.importorskip("llvmlite")
    kernel = build(_program(), recorded=("seen",), backend=backend, **DRAWS)
    still = kernel.fly(**_flight(3), first=5, end=5)
    assert np.array_equal(still.state, _flight(3)["state"])
    assert still.recorded["seen"].shape == (0, 3, 3)
    assert kernel.fly(**_flight(0), first=0, end=5).recorded["seen"].shape == (5, 3, 0)


def _almost_rings(state: Any, sample: Any) -> dict[str, Any]:
    """Selects that look like rings: turns that never come, come late, are missing or not whole; picks outside."""
    a, b, c, d = state[:3], state[3:6], state[6:9], state[9:12]
    half = np.stack([np.where(sample * 0.5 == j, sample, a[j]) for j in range(3)])
    late = np.stack([np.where(sample - 4.0 == j, sample, b[j]) for j in range(3)])
    partial = np.stack([np.where(sample - 2.0 == j + 1.0, sample, c[j]) for j in range(3)])
    other = np.stack([np.where(sample == float(2 - j), sample, d[j]) for j in range(3)])
    seen = np.stack([pick(sample - 3.0, *a), pick(sample * 0.3, *b), pick(sample, c[2], c[1], c[0]), pick(d[0], *d)])
    return {"state": np.concatenate([half, late, partial, other]), "seen": np.concatenate([state, seen])}


def test_what_looks_like_a_ring(where: Any, same: Any) -> None:
    chunk = _flight(5) | {"samples": np.full(5, 12)}
    program = trace(_almost_rings, state=N_STATE, sample=0)
    found, expected = (
        build(program, recorded=("seen",), **how).fly(**chunk, first=0, end=12) for how in (where, {"backend": "numpy"})
    )
    assert same(found.state, expected.state)
    assert same(found.recorded["seen"], expected.recorded["seen"])


def test_rings_are_addressed_directly() -> None:
    pytest.importorskip("llvmlite")
    deep = trace(lambda state, sample: {"state": ring(state, state[3] + 1.0, sample)[0]}, state=500, sample=0)
    kernel = build(deep, backend="llvm")
    assert isinstance(kernel, Compiled)
    assert len(kernel.text().splitlines()) < 200


def test_an_unknown_back_end() -> None:
    with pytest.raises(FddbenchError, match="known: auto, llvm, numpy"):
        build(_program(), backend="gpu")


def _not_installed(_: str) -> str:
    raise PackageNotFoundError


@pytest.mark.parametrize("version", [_not_installed, lambda _: "0.44.0"])
def test_without_llvmlite_numpy_flies(monkeypatch: pytest.MonkeyPatch, version: Any) -> None:
    monkeypatch.setattr(llvm, "version", version)
    assert not llvm.available()
    assert isinstance(build(_program(), **DRAWS), Interpreted)
    with pytest.raises(FddbenchError, match="pip install llvmlite"):
        build(_program(), backend="llvm", **DRAWS)


def test_a_processor_that_is_not_here(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("llvmlite")
    monkeypatch.setattr(llvm, "machine", lambda _: None)
    with pytest.raises(FddbenchError, match="does not run code for 'haswell'"):
        build(_program(), backend="llvm", target="haswell", **DRAWS)


def test_llvmlite_is_imported_at_the_first_compilation_only(monkeypatch: pytest.MonkeyPatch) -> None:
    wanted: list[str] = []
    original = builtins.__import__

    def spy(name: str, *args: Any, **kwargs: Any) -> Any:
        wanted.append(name)
        return original(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", spy)
    build(_program(), backend="numpy", **DRAWS).fly(**_flight(2), first=0, end=3)
    assert not [name for name in wanted if name.startswith("llvmlite")]


def test_a_broken_llvmlite_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken() -> None:
        raise ImportError("libLLVM is missing")

    monkeypatch.setattr(llvm, "_binding", broken)
    assert not llvm.available()
