"""Commands that make designs: from a recipe, and thresholds from healthy flights."""

import argparse
import sys
from pathlib import Path

from fddbench.errors import FddbenchError

__all__ = ["design", "tune"]


def design(args: argparse.Namespace) -> int:
    """Make the numbers of a design anew from its recipe, with its guaranteed gamma and the certificate.

    Prints the design, or writes it with --output. Thresholds of a detector are untuned: go on with `fddbench tune`.
    """
    from fddbench.design.recipe import cook

    cooked = cook(args.design)
    for name, value in cooked.found.items():
        was = f" (the file says {cooked.before[name]})" if cooked.before.get(name, value) != value else ""
        print(f"{name}: {value}{was}", file=sys.stderr)
    if args.output is None:
        print(cooked.text, end="")
    else:
        _write(args.output, cooked.text, force=args.force)
        if "thresholds" in cooked.gains:
            print(f"{args.output}: thresholds are untuned; next: fddbench tune {args.output} CAMPAIGN", file=sys.stderr)
    return 0


def tune(args: argparse.Namespace) -> int:
    """Choose the smallest thresholds that keep a false-alarm rate on the healthy flights of a tuning campaign.

    Writes a new design that says what it was tuned on.
    """
    from fddbench.api.campaigns import read
    from fddbench.api.designs import tune as tuned

    made = tuned(args.design, read(args.campaign, args.overrides), false_alarm_rate=args.false_alarm_rate)
    output, found = args.output or Path("detectors") / f"{made.name}_tuned.yaml", made.found
    _write(output, made.text, force=args.force)
    print(f"thresholds: {', '.join(f'{value:.6g}' for value in found.thresholds)}")
    print(
        f"false alarms: {found.alarms} of these {found.flights} flights ({100.0 * found.alarms / found.flights:.3g} %), asked "
        f"at most {100.0 * args.false_alarm_rate:g} %; other flights may give more, an evaluation tells"
    )
    print(output)
    return 0


def _write(path: Path, text: str, *, force: bool) -> None:
    """Write a file, its folder made."""
    if path.exists() and not force:
        raise FddbenchError(f"{path} exists; name another file with --output, or replace it with --force")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise FddbenchError(f"cannot write {path}: {error.strerror}; name another file with --output") from error
