"""Machine code through llvmlite: which processor, how many lanes, and a loaded function. Optional: see `available`."""

import ctypes
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from itertools import count
from typing import Any

from fddbench.blocks import cache as objects

__all__ = ["Loaded", "Machine", "available", "compile_object", "load", "machine"]

_NAMED = {
    "x86-64": ("x86-64", "", ("sse2",), 2),
    "nehalem": ("nehalem", "", ("sse4.2",), 2),
    "haswell": ("haswell", "", ("avx2", "fma", "bmi2"), 4),
}
_ARGUMENTS = (*[ctypes.c_int64] * 3, ctypes.c_uint64, *[ctypes.c_void_p] * 8)
_OLDEST = (0, 45)
_libraries = count()


@dataclass(frozen=True)
class Machine:
    """A processor to compile for.

    Attributes
    ----------
    triple, cpu, features : str
        As LLVM names them.
    lanes : int
        Runs side by side when nothing else is asked for: two hardware vectors, of 512 bits one: twice as many double the
        time to compile and gain nothing, because the state leaves the first cache.
    rounds : bool
        Rounds to whole numbers in one instruction.
    """

    triple: str
    cpu: str
    features: str
    lanes: int
    rounds: bool

    @property
    def key(self) -> str:
        """Everything here that machine code depends on."""
        return f"{self.triple} {self.cpu} {self.features}"


def available() -> bool:
    """Whether llvmlite is installed, in a version whose LLVM reads what `ir` writes, and can be loaded."""
    try:
        major, minor = version("llvmlite").split(".")[:2]
    except PackageNotFoundError:
        return False
    if (int(major), int(minor)) < _OLDEST:
        return False
    try:
        _binding()
    except (ImportError, OSError, RuntimeError):  # a broken installation is none
        return False
    return True


@cache
def _binding() -> Any:
    """Llvmlite's binding, ready for this processor; imported at the first compilation and not before."""
    import llvmlite.binding as binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    return binding


@cache
def machine(name: str = "host") -> Machine | None:
    """The processor called ``host``, ``x86-64``, ``nehalem`` or ``haswell``; None when this one cannot run its code."""
    binding = _binding()
    triple, own = binding.get_process_triple(), binding.get_host_cpu_features()
    if name == "host":
        rounds = bool(own.get("sse4.1")) or not triple.startswith("x86")
        return Machine(triple, binding.get_host_cpu_name(), own.flatten(), 8 if own.get("avx") else 4, rounds)
    cpu, features, needed, width = _NAMED[name]
    if not triple.startswith("x86_64") or not all(own.get(feature) for feature in needed):
        return None
    return Machine(triple, cpu, features, 2 * width, name != "x86-64")


@dataclass(frozen=True)
class Loaded:
    """Machine code in memory: the function of `ir.write`, which releases the GIL, and the vectors of its workspace."""

    fly: Callable[..., None]
    slots: int
    library: Any


def load(identity: str, text: Callable[[], str], target: Machine) -> Loaded:
    """Kernel called `identity` for a processor, from the cache or compiled now from the LLVM text.

    The text is a pure function of the identity and of this package's source, so it need not be written to look up the
    cache.
    """
    binding = _binding()
    name = objects.key(identity, objects.source(), ".".join(map(str, binding.llvm_version_info)), target.key)
    body = objects.load(name)
    if body is None:
        body = compile_object(text(), target)
        objects.store(name, body)
    builder = binding.JITLibraryBuilder().add_object_img(body).add_current_process()
    library = builder.export_symbol("fly").export_symbol("slots").link(_jit(), f"fddbench_{next(_libraries)}")
    slots = int(ctypes.CFUNCTYPE(ctypes.c_int64)(library["slots"])())
    return Loaded(ctypes.CFUNCTYPE(None, *_ARGUMENTS)(library["fly"]), slots, library)


@cache
def _jit() -> Any:
    """Linker of object files in memory.

    JITLink puts code and constants into one stretch of memory. The older linker maps them apart, and a distance above 2 GB
    overflows the 32-bit addresses of the small code model without a word.
    """
    return _binding().create_lljit_compiler(use_jit_link=sys.platform != "win32")


def compile_object(text: str, target: Machine, optimise: int = 2) -> bytes:
    """Object file of an LLVM module."""
    binding = _binding()
    module = binding.parse_assembly(text)
    module.triple = target.triple
    maker = binding.Target.from_triple(target.triple).create_target_machine(
        cpu=target.cpu, features=target.features, opt=optimise, reloc="pic", codemodel="small"
    )
    return maker.emit_object(module)  # type: ignore[no-any-return]
