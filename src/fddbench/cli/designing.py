"""Commands that make designs: from a recipe, and thresholds from healthy flights."""

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fddbench.cli.outputs import require_new
from fddbench.errors import FddbenchError

if TYPE_CHECKING:
    from fddbench.api.designs import TunedDesign

__all__ = ["design", "tune"]


def design(args: argparse.Namespace) -> int:
    """Make the numbers of a design anew from its recipe, with its guaranteed gamma and the certificate.

    Prints the design, or writes it with --output. Thresholds of a detector are untuned: go on with `fddbench tune`.
    """
    from fddbench.design.recipe import cook

    if args.output is not None:
        require_new(args.output, "--output", force=args.force)
    cooked = cook(args.design)
    for name, value in cooked.found.items():
        was = f" (the file says {cooked.before[name]})" if cooked.before.get(name, value) != value else ""
        print(f"{name}: {value}{was}", file=sys.stderr)
    if args.output is None:
        print(cooked.text, end="")
    else:
        _write(args.output, cooked.text)
        if "thresholds" in cooked.gains:
            print(f"{args.output}: thresholds are untuned; next: fddbench tune {args.output} CAMPAIGN", file=sys.stderr)
    return 0


def tune(args: argparse.Namespace) -> int:
    """Choose the smallest thresholds that keep a false-alarm target, on the healthy flights of a tuning campaign.

    Writes a new design that says what it was tuned on, and says what to expect on other flights.
    """
    from fddbench.api.campaigns import read
    from fddbench.api.designs import tune as tuned

    output = args.output or Path("detectors") / f"{args.design.name.removesuffix('.yaml')}_tuned.yaml"
    require_new(output, "--output", force=args.force)  # tuning may take hours: not after it
    only = [key.strip() for key in (args.only or "").split(",") if key.strip()]
    if args.only is not None and not only:
        raise FddbenchError(f"--only names thresholds, KEY or KEY,KEY; got {args.only!r}")
    made = tuned(
        args.design, read(args.campaign, args.overrides), false_alarm_rate=args.false_alarm_rate,
        per_flight=args.per_flight, per_hour=args.per_hour, confidence=args.confidence, by=args.by,
        only=only,
    )  # fmt: skip
    _write(output, made.text)
    _say(made)
    print(output)
    return 0


def _say(made: "TunedDesign") -> None:
    """Print what was found and what it promises."""
    found, per_flight = made.promise, made.target.per == "flight"

    def said(rate: float) -> str:
        return f"{100.0 * rate:.3g} %" if per_flight else f"{rate:.3g} per hour"

    for key, value in made.thresholds.items():
        print(f"{key}: {', '.join(f'{each:.6g}' for each in _numbers(value))}")
    if made.factor is not None:
        print(
            f"factor on what the design said: {made.factor:.5g}; {100.0 * (made.resolution or 0.0):.2g} % less is too small"
        )
    print(
        f"false alarms: {found.alarms} of these {found.flights} flights of {found.runs} runs ({said(found.here)}), asked "
        f"{made.target.words}"
    )
    print(
        f"on other flights: {said(found.expected)} expected, {said(found.low)} to {said(found.high)} with 95 % confidence"
    )
    print(f"budget: {found.flights} flights, {made.tried} set{'s' if made.tried > 1 else ''} of thresholds flown")


def _numbers(value: Any) -> Iterator[float]:
    """Numbers of a gain."""
    if isinstance(value, list):
        yield from (number for each in value for number in _numbers(each))
    else:
        yield float(value)


def _write(path: Path, text: str) -> None:
    """Write a file, its folder made."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise FddbenchError(f"cannot write {path}: {error.strerror}; name another file with --output") from error
