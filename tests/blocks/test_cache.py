"""Laws of the object cache: what was stored or nothing, and a kernel in either case."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fddbench import private
from fddbench.blocks import cache, llvm
from fddbench.blocks.kernel import Addresses, build
from fddbench.blocks.program import trace
from fddbench.errors import ResultsWarning


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("FDDBENCH_CACHE", str(tmp_path / "here"))
    return tmp_path / "here"


def _fly(value: float = 2.0) -> Any:
    program = trace(lambda state: {"state": state * value + 1.0}, state=1)
    kernel = build(program, backend="llvm")
    nowhere = Addresses(key=0, run=0, flight=0, scenario=0)
    return kernel.fly(np.ones((1, 2)), np.zeros((0, 2)), np.full(2, 3), nowhere, first=0, end=3).state.tolist()


def test_what_was_stored_comes_back(own: Path) -> None:
    cache.store("a", b"body")
    assert cache.load("a") == b"body"
    assert cache.load("b") is None
    assert [path.name for path in own.iterdir()] == ["a.o"]


@pytest.mark.parametrize("damage", [b"", b"short", b"x" * 100])
def test_a_damaged_entry_is_no_entry(own: Path, damage: bytes) -> None:
    cache.store("a", b"body")
    (own / "a.o").write_bytes(damage)
    assert cache.load("a") is None


def test_one_flipped_bit_is_seen(own: Path) -> None:
    cache.store("a", b"body")
    content = bytearray((own / "a.o").read_bytes())
    content[-1] ^= 1
    (own / "a.o").write_bytes(content)
    assert cache.load("a") is None


def test_a_folder_that_cannot_be_written_is_no_reason_to_stop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("FDDBENCH_CACHE", str(tmp_path / "file" / "below"))
    cache.store("a", b"body")
    assert cache.load("a") is None


def test_a_folder_that_others_may_write_keeps_nothing_and_says_so(own: Path) -> None:
    cache.store("a", b"body")
    own.chmod(0o777)
    with pytest.warns(ResultsWarning, match="can be written by others.*chmod 700"):
        assert cache.load("a") is None
    cache.store("b", b"body")
    assert [path.name for path in own.iterdir()] == ["a.o"]


def test_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("FDDBENCH_CACHE", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", "/somewhere")
    assert private.folder() == Path("/somewhere/fddbench")
    monkeypatch.delenv("XDG_CACHE_HOME")
    assert private.folder() == Path.home() / ".cache" / "fddbench"


def test_a_kernel_is_compiled_once(own: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("llvmlite")
    expected = _fly()
    compiled = []
    monkeypatch.setattr(llvm, "compile_object", lambda *_: compiled.append(1))
    assert _fly() == expected
    assert compiled == []
    assert len(list(own.iterdir())) == 1


def test_a_damaged_kernel_is_rebuilt(own: Path) -> None:
    pytest.importorskip("llvmlite")
    expected = _fly()
    (entry,) = own.iterdir()
    good = entry.read_bytes()
    entry.write_bytes(good[:-7])
    assert _fly() == expected
    assert entry.read_bytes() == good


def test_another_step_or_processor_is_another_entry(own: Path) -> None:
    pytest.importorskip("llvmlite")
    _fly(2.0)
    _fly(3.0)
    assert len(list(own.iterdir())) == 2
    assert len({cache.key("ir", "22", cpu) for cpu in ("znver5", "haswell")}) == 2
    assert cache.key("a", "b") != cache.key("ab", "")


def test_everything_the_machine_code_depends_on_is_in_its_name(own: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("llvmlite")
    program = trace(lambda state, normals: {"state": state + normals[:1], "y": state}, state=1, normals=4)
    for how in (
        {"consumers": (1,)},
        {"consumers": (2,)},
        {"fault_consumers": (1,)},
        {"consumers": (1,), "recorded": ("y",)},
        {"consumers": (1,), "lanes": 1},
        {"consumers": (1,), "target": "x86-64", "lanes": 4},
    ):
        build(program, backend="llvm", **how)
    assert len(list(own.iterdir())) == 6
    monkeypatch.setattr(cache, "source", lambda: "another version of this package")
    build(program, backend="llvm", consumers=(1,))
    assert len(list(own.iterdir())) == 7
