"""A detector as files of C, with all that travels with them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fddbench.exported.header import header_text
from fddbench.exported.interface import Interface
from fddbench.exported.layout_c import banner
from fddbench.exported.members import Members
from fddbench.exported.source import source_text
from fddbench.exported.spelling import DOUBLE, SINGLE
from fddbench.exported.upset import Upset, flown_with_upsets
from fddbench.exported.vectors import Vectors, selftest_text, vectors_text

__all__ = ["Code", "code_of", "sources"]

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Code:
    """Files of an exported detector.

    Attributes
    ----------
    interface : Interface
        Structs and program.
    files : mapping of str to str
        Text by name: header, source, vectors and self-test.
    precision : {"double", "single"}
        Of its numbers.
    vectors : Vectors
        Of the self-test.
    upsets : tuple of Upset
        What inputs do that are no numbers.
    loss : mapping of str to float
        Of single precision, by output: the largest difference to double precision on the vectors, as a share of the largest
        output [-]; of decisions the share of samples on which they differ.
    """

    interface: Interface
    files: Mapping[str, str]
    precision: str
    vectors: Vectors
    upsets: tuple[Upset, ...]
    loss: Mapping[str, float]


def sources(
    interface: Interface, detector: Any, *, precision: str = "double", about: Sequence[str] = ()
) -> dict[str, str]:
    """Header and source of a detector, without vectors."""
    spelling, name = SINGLE if precision == "single" else DOUBLE, interface.name
    head = banner(name, about)
    return {
        f"{name}.h": header_text(interface, spelling, head=head),
        f"{name}.c": source_text(interface, Members(detector), spelling, head=banner(name, about[:1])),
    }


def code_of(interface: Interface, detector: Any, signals: Mapping[str, Floats], *, about: Sequence[str]) -> Code:
    """All files of a detector in double precision."""
    vectors, upsets = flown_with_upsets(interface, signals)
    told = [*about, *_said(upsets)]
    files = sources(interface, detector, about=told) | with_vectors(interface, vectors, "double")
    return Code(interface=interface, files=files, precision="double", vectors=vectors, upsets=tuple(upsets), loss={})


def with_vectors(interface: Interface, vectors: Vectors, precision: str) -> dict[str, str]:
    """Vector file and self-test."""
    spelling, name = SINGLE if precision == "single" else DOUBLE, interface.name
    return {
        f"{name}_vectors.h": vectors_text(interface, vectors, spelling),
        f"{name}_selftest.c": selftest_text(interface, spelling),
    }


def _said(upsets: Sequence[Upset]) -> list[str]:
    """Paragraphs on inputs that are no numbers."""
    if not upsets:
        return []
    by_signal: dict[str, dict[str, list[str]]] = {}
    for each in upsets:
        by_signal.setdefault(each.signal, {}).setdefault(each.effect, []).append(each.kind)
    alike: dict[tuple[tuple[str, str], ...], list[str]] = {}
    for signal, effects in by_signal.items():
        key = tuple((", ".join(kinds), effect) for effect, kinds in effects.items())
        alike.setdefault(key, []).append(signal)
    return [
        "One sample that is no number, measured on the flight of the vectors:",
        *(
            f"{', '.join(names)}: {'; '.join(f'{kinds}: {effect}' for kinds, effect in key)}."
            for key, names in alike.items()
        ),
        "Ask the usable function before a step and keep the last good sample where it says no; where the sound function says "
        "no after a step, begin anew with the init function.",
    ]
