"""Commands that make designs: from a recipe, and thresholds from healthy flights."""

import argparse
import sys
from dataclasses import replace
from pathlib import Path

from fddbench.errors import DesignError, FddbenchError

__all__ = ["design", "tune"]


def design(args: argparse.Namespace) -> int:
    """Make the numbers of a design anew from its recipe, with its guaranteed gamma and the certificate.

    Prints the design, or writes it with --output. Its thresholds are untuned: go on with `fddbench tune`.
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
        print(f"{args.output}: thresholds are untuned; next: fddbench tune {args.output} CAMPAIGN", file=sys.stderr)
    return 0


def tune(args: argparse.Namespace) -> int:
    """Choose the smallest thresholds that keep a false-alarm rate on the healthy flights of a tuning campaign.

    Writes a new design that says what it was tuned on.
    """
    import numpy as np

    from fddbench.campaign.load import find_campaign, read_campaign
    from fddbench.campaign.reading.yaml_nodes import read_yaml
    from fddbench.design.tuning import held_peaks, require_tuning, tuned, tuned_text
    from fddbench.designs.design import read_design
    from fddbench.designs.finding import find_design
    from fddbench.interfaces import Tunable
    from fddbench.runner.assembly import assemble
    from fddbench.runner.observe import healthy_signals

    campaign = read_campaign(args.campaign, args.overrides)
    require_tuning(campaign)
    path = args.design
    if not path.is_file():
        path = find_design(str(args.design), find_campaign(args.campaign).parent)
    chosen = read_design(path)
    assembly = assemble(replace(campaign, designs=(chosen,)))
    detector = assembly.detectors[chosen.name].detector
    if not isinstance(detector, Tunable):
        raise DesignError(
            f"the thresholds of {chosen.kind.name} designs cannot be tuned: the kind evaluates no signals"
        )
    peaks = [
        np.stack([held_peaks(signals[name], round(detector.confirm_samples)) for name in detector.evaluated], axis=1)
        for signals in healthy_signals(assembly, chosen.name, detector.evaluated)
    ]
    if not peaks:
        raise DesignError(f"none of the healthy flights of {campaign.path} can be flown")
    found = tuned(np.concatenate(peaks), args.false_alarm_rate)
    output = args.output or Path("detectors") / f"{chosen.name}_tuned.yaml"
    _write(output, tuned_text(chosen, read_yaml(path).data, found.thresholds, campaign), force=args.force)
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
