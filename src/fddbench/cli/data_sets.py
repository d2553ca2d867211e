"""Command that writes labelled flights."""

import argparse
import sys
from pathlib import Path

__all__ = ["dataset", "dataset_arguments"]


def dataset(args: argparse.Namespace) -> int:
    """Write labelled signals of all flights of a campaign, for those who train detectors.

    Train and validation are flights of purpose tuning, apart by aircraft; test are flights of purpose evaluation. Measured
    signals and labels lie in one folder a split, what no detector sees in truth/. A card says what is what.
    """
    from fddbench.api.campaigns import read
    from fddbench.api.datasets import dataset as written

    shown = sys.stderr.isatty() and not args.quiet

    def progress(done: int, of: int) -> None:
        if shown:
            print(f"\r{done} of {of} flights", end="" if done < of else "\n", file=sys.stderr, flush=True)

    folder = written(
        read(args.campaign, args.overrides), args.output, rate_hz=args.rate, dtype=args.dtype, progress=progress
    )
    print(f"labelled flights in {folder}; {folder / 'README.md'} says what is what")
    return 0


def dataset_arguments(command: argparse.ArgumentParser) -> None:
    """Arguments of `dataset`, beside the campaign and what is set in it."""
    command.add_argument("--output", type=Path, required=True, metavar="DIR", help="new folder")
    command.add_argument("--rate", type=float, required=True, metavar="HZ", help="samples a second")
    command.add_argument("--dtype", choices=("float32", "float64"), default="float32", help="of the signals")
    command.add_argument("--quiet", action="store_true", help="no progress")
