"""Arguments of the commands that look at single flights, check folders of results and let them grow."""

import argparse
from pathlib import Path

from fddbench.cli import growing, looking
from fddbench.cli.added import add
from fddbench.cli.checked_numbers import flights as _flights
from fddbench.cli.checked_numbers import jobs as _jobs
from fddbench.cli.checked_numbers import runs as _runs
from fddbench.cli.checked_numbers import seed as _seed
from fddbench.cli.run_arguments import by_engine

__all__ = ["growing_arguments", "looking_arguments", "trusting", "verify_arguments"]


def looking_arguments(subs) -> None:  # type: ignore[no-untyped-def]
    """Commands that look at single flights."""
    replay = add(subs, "replay", looking.replay)
    replay.add_argument("source", type=Path, metavar="DIR", help="folder of results, or a campaign")
    replay.add_argument("case", metavar="CASE", help="name of the flight as in the column case, jam_a/3/0/17")
    replay.add_argument(
        "--detector", action="append", default=[], metavar="NAME", help="show this detector alone (may be repeated)"
    )
    replay.add_argument(
        "--signal",
        action="append",
        default=[],
        metavar="NAME",
        help="draw this signal (may be repeated; default: a few)",
    )
    replay.add_argument("--plot", type=Path, metavar="FILE", help="picture to write: .html, .png, .svg or .pdf")
    replay.add_argument("--to", type=Path, metavar="FILE", help="table to write: .csv, .parquet, .mat or .h5")
    trusting(replay)

    worst = add(subs, "worst", looking.worst)
    worst.add_argument("folder", type=Path, metavar="DIR", help="folder of results")
    worst.add_argument(
        "--detector", action="append", default=[], metavar="NAME", help="this detector alone (may be repeated)"
    )
    worst.add_argument(
        "--most", type=_jobs, default=3, metavar="N", help="flights of a kind in a scenario (default: 3)"
    )


def growing_arguments(subs) -> None:  # type: ignore[no-untyped-def]
    """Commands by which folders of results grow."""
    extend = add(subs, "extend", growing.extend)
    extend.add_argument("folder", type=Path, metavar="DIR", help="folder of results")
    extend.add_argument("campaign", type=Path, nargs="?", metavar="CAMPAIGN.yaml", help="campaign that says more")
    extend.add_argument("--runs", type=_runs, metavar="N", help="Monte-Carlo runs that there are to be in all")
    extend.add_argument(
        "--detector", action="append", default=[], metavar="DESIGN",
        help="name or file of a design to add (may be repeated)",
    )  # fmt: skip
    extend.add_argument(
        "--scenario", action="append", default=[], metavar="NAME",
        help="add this scenario of CAMPAIGN.yaml alone (may be repeated)",
    )  # fmt: skip
    extend.add_argument("--jobs", type=_jobs, default=2, metavar="N", help="worker processes (default: 2)")
    extend.add_argument("--backend", choices=("auto", "llvm", "numpy"), default="auto", help="as of run")
    by_engine(extend)
    extend.add_argument("--quiet", action="store_true", help="no progress")
    trusting(extend)

    merge = add(subs, "merge", growing.merge)
    merge.add_argument("folders", type=Path, nargs="+", metavar="DIR", help="folders of results")
    merge.add_argument("--output", type=Path, required=True, metavar="DIR", help="new folder")

    compact = add(subs, "compact", growing.compact)
    compact.add_argument("folder", type=Path, metavar="DIR", help="folder of results")


def verify_arguments(command: argparse.ArgumentParser) -> None:
    """Arguments of `verify`."""
    command.add_argument("folder", type=Path, metavar="DIR", help="folder of results")
    command.add_argument("--refly", type=_flights, default=0, metavar="N", help="fly so many of its flights again")
    command.add_argument(
        "--seed", type=_seed, metavar="N", help="of the draw of these flights (default: another every time)"
    )
    trusting(command)


def trusting(command: argparse.ArgumentParser) -> None:
    """The flag by which plug-ins of a folder from elsewhere may run."""
    command.add_argument(
        "--trust", action="store_true", help="run plug-ins in DIR, now and later, though never flown from here"
    )
