"""Exports a design as C that is the detector, bit for bit."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from fddbench.designs.design import Design
from fddbench.errors import DesignError
from fddbench.exported.child import Child
from fddbench.exported.child_main import main_text
from fddbench.exported.code import Code, code_of, sources, with_vectors
from fddbench.exported.compiling import built, compiler, selftest_command
from fddbench.exported.flown_c import FlownC
from fddbench.exported.interface import Interface, interface_of
from fddbench.exported.symbols import library, require_symbols
from fddbench.exported.vectors import Vectors
from fddbench.results.provenance import version_of
from fddbench.runner.assembly import Assembly
from fddbench.runner.single import assembly_with
from fddbench.runner.vectors import flown_samples

__all__ = ["export", "exported", "write"]


def export(
    design: str | Path,
    output: str | Path | None = None,
    *,
    campaign: str | Path | None = None,
    precision: str = "double",
    symbols: str | Sequence[Any] | None = None,
    force: bool = False,
) -> Code:
    """C99 of a design: header, source, vectors of a flight and a self-test, written to a folder if one is given.

    Parameters
    ----------
    design : str or Path
        Name of a design, as campaigns write it.
    output : str or Path, optional
        Folder for the files; made if it is not there.
    campaign : str or Path, optional
        Whose bus and sample time the code is for, and whose first faulty flight the vectors are; by default the first shipped
        campaign that feeds the design.
    precision : {"double", "single"}
        Double precision gives the bits of every flight; single precision says what it loses.
    symbols : str or sequence, optional
        Symbol library that it must keep to, see `fddbench.exported.symbols`, beside those that its design and the campaign
        state.
    force : bool
        Replace files that are there.

    Raises
    ------
    FddbenchError
        The detector is ordinary Python or needs other symbols; the folder has such files; single precision finds no compiler,
        or what it computes is no number.
    """
    if precision not in {"double", "single"}:
        raise DesignError(f"no precision is called {precision!r}; known: double, single")
    assembly = assembly_with(str(design), None if campaign is None else Path(campaign))
    name = next(iter(assembly.detectors))
    code = exported(assembly, name, precision=precision, symbols=symbols)
    if output is not None:
        write(code.files, Path(output), force=force)
    return code


def exported(
    assembly: Assembly, name: str, *, precision: str = "double", symbols: str | Sequence[Any] | None = None
) -> Code:
    """C of a detector of an assembly; see `export`."""
    own, bus = assembly.detectors[name], assembly.loop.bus
    design = next(each for each in assembly.plan.campaign.designs if each.name == name)
    interface = interface_of(own, bus, name=name, about=design.about)
    if symbols is not None:
        require_symbols(interface.program, library(symbols), name)
    about = _about(design, interface, str(assembly.plan.campaign.name))
    code = code_of(interface, own.detector, flown_samples(assembly, own.every), about=about)
    return code if precision == "double" else _single(code, own.detector, about)


def write(files: Mapping[str, str], folder: Path, *, force: bool = False) -> None:
    """Write files into a folder.

    Raises
    ------
    DesignError
        Some are there with another content and shall not be replaced, or the folder cannot be written.
    """
    try:
        there = [
            name for name, text in files.items() if (folder / name).exists() and (folder / name).read_text() != text
        ]
        if there and not force:
            raise DesignError(
                f"{folder} has another {', '.join(there)}; replace it with --force, or choose another folder"
            )
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in files.items():
            (folder / name).write_text(text, encoding="utf-8", newline="\n")
    except (OSError, UnicodeDecodeError) as error:
        said = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise DesignError(f"{folder} cannot be written: {said}; choose another folder with --output") from error


def _about(design: Design, interface: Interface, campaign: str) -> list[str]:
    """Paragraphs of the head of the files."""
    tuned = "; ".join(
        f"{each.campaign} ({each.seed})" if hasattr(each, "seed") else str(each) for each in design.tuned_on
    )
    return [
        f"{design.about or design.kind.name}: the detector {design.name} ({design.kind.name}) of fddbench "
        f"{version_of('fddbench')}, design sha256 {design.sha256[:16]}, for the signals of {campaign}, a step every "
        f"{interface.step_s:g} s.",
        f"Numbers from: {' '.join(design.source.split())}",
        f"Tuned on: {tuned or 'nothing'}.",
        "It is the same detector as in the campaign, operation by operation: compiled without contraction it gives the same "
        "bits on every machine with IEEE 754. No heap, no recursion, no loop that depends on data.",
        f"Self-test: {selftest_command(interface.name)}",
    ]


def _single(code: Code, detector: Any, about: Sequence[str]) -> Code:
    """The same in single precision, with what it loses on the vectors, measured by the compiler here."""
    interface = code.interface
    double = _vectors_of(interface, detector, code, "double")
    single = _vectors_of(interface, detector, code, "single")
    loss, column = dict[str, float](), 0
    for member in interface.outputs:
        rows = slice(column, column + member.size)
        column += member.size
        apart = np.abs(single.outputs[:, rows] - double.outputs[:, rows])
        if member.source in {"declared", "alarm"}:
            loss[member.source] = float((apart > 0.0).any(axis=1).mean())
        else:
            loss[member.source] = float(
                apart.max(initial=0.0) / max(np.abs(double.outputs[:, rows]).max(initial=0.0), 1e-300)
            )
    lost = [key for key, value in loss.items() if not np.isfinite(value)]
    if lost:
        raise DesignError(
            f"{interface.name} in single precision makes no numbers of {', '.join(lost)} on the vectors, measured by "
            f"{compiler()}; keep to double precision"
        )
    said = ", ".join(f"{key} {value:.2g}" for key, value in loss.items())
    told = [
        *about[:3],
        f"Single precision: on the vectors it differs from double precision by at most (share of the largest value of each "
        f"output; of decisions, the share of samples): {said}. The vectors are its own outputs, measured by {compiler()}.",
        *about[4:],
    ]
    files = sources(interface, detector, precision="single", about=told) | with_vectors(interface, single, "single")
    return replace(code, files=files, precision="single", loss=loss)


def _vectors_of(interface: Interface, detector: Any, code: Code, precision: str) -> Vectors:
    """What compiled code of a precision makes of the inputs of the vectors."""
    files = {**sources(interface, detector, precision=precision), "flown.c": main_text(interface.name)}
    flown = FlownC(interface, Child(built(files, compiler())))
    inputs = code.vectors.inputs
    state, given = flown.start[:, np.newaxis], []
    for row in inputs:
        own, column = dict[str, Any](), 0
        for member in interface.inputs:
            own[member.source] = row[column : column + member.size, np.newaxis]
            column += member.size
        state, out = flown.step(state, own)
        given.append(np.concatenate([out[member.source][:, 0] for member in interface.outputs]))
    flown.child.close()
    return Vectors(inputs, np.array(given))
