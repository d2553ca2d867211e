"""The command that makes C of a design."""

import argparse
import shlex
from pathlib import Path
from typing import Any

__all__ = ["arguments", "export"]


def export(args: argparse.Namespace) -> int:
    """Write a design as C99 for a flight computer, with a self-test of a recorded flight that travels with it.

    Header, source, vector file and self-test. Compiled without contraction (-ffp-contract=off) the code is the detector of
    the campaign bit for bit. A library of allowed symbols, --symbols, refuses a detector that needs more.
    """
    from fddbench.api.exporting import export as exported
    from fddbench.exported.compiling import selftest_command

    output = args.output or Path(args.design)
    code = exported(
        args.design,
        output,
        campaign=args.campaign,
        precision=args.precision,
        symbols=_symbols(args.symbols),
        force=args.force,
    )
    name, (n_in, n_state, n_out) = code.interface.name, code.interface.numbers
    for file, text in code.files.items():
        print(f"{output / file}  {len(text.splitlines())} lines")
    print(f"{n_in} inputs, {n_state} states, {n_out} outputs; a step every {code.interface.step_s:g} s")
    if code.loss:
        said = ", ".join(f"{key} {value:.2g}" for key, value in code.loss.items())
        print(f"single precision against double, on the vectors: {said}")
    print(f"test it: cd {shlex.quote(str(output))} && {selftest_command(name)}")
    return 0


def _symbols(text: str | None) -> Any:
    """A library by name, or a list of symbols with sizes: ``add,mul,lookup:64``."""
    from fddbench.errors import FddbenchError
    from fddbench.exported.symbols import LIBRARIES, SYMBOLS

    if text is None or text in LIBRARIES:
        return text
    found: list[Any] = []
    for part in text.split(","):
        name, colon, size = part.strip().partition(":")
        if colon and not (size.isascii() and size.isdigit() and len(size) < 10):
            raise FddbenchError(f"--symbols: a size is a whole number, as in lookup:64; got {part!r}")
        found.append({name: int(size)} if colon else name)
    return found if len(found) > 1 or ":" in text or text in SYMBOLS else text


def arguments(export: argparse.ArgumentParser) -> None:
    """What the command takes."""
    export.add_argument("design", metavar="DESIGN", help="name of a design")
    export.add_argument(
        "--campaign", type=Path, metavar="CAMPAIGN.yaml",
        help="campaign whose signals and sample time count (default: the first shipped one that feeds it)",
    )  # fmt: skip
    export.add_argument("--language", choices=("c",), default="c", help="C99 (default, and the only one)")
    export.add_argument("--output", type=Path, metavar="DIR", help="folder for the files (default: the design's name)")
    export.add_argument(
        "--precision", choices=("double", "single"), default="double",
        help="double: the bits of every flight (default); single: says what it loses",
    )  # fmt: skip
    export.add_argument(
        "--symbols", default=None, metavar="LIBRARY",
        help="symbol library that it must keep to: scalar, or add,mul,lookup:64,...",
    )  # fmt: skip
    export.add_argument("--force", action="store_true", help="replace files that are there")
