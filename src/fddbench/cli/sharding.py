"""Commands that fly a campaign in shards, for batch systems."""

import argparse
import re
import sys
from pathlib import Path
from shlex import quote

from fddbench.cli.added import add
from fddbench.cli.checked_numbers import flights, jobs
from fddbench.cli.folder_arguments import trusting

__all__ = ["plan", "shard", "sharding_arguments", "slurm"]


def plan(args: argparse.Namespace) -> int:
    """Freeze a campaign into a folder that is flown in shards, by as many jobs.

    Then `fddbench shard 1 DIR` to `fddbench shard N DIR`, in any order and place that sees the folder, and `fddbench merge
    DIR --output WHOLE`; the table is that of one run.
    """
    from fddbench.api import campaigns
    from fddbench.api.sharding import plan_shards

    campaign = campaigns.read(args.campaign, args.overrides)
    folder = _folder(args, campaign.name)
    plan_shards(campaign, args.shards, folder)
    print(f"{folder}: {campaigns.plan(campaign).n_cases} flights in {args.shards} shards")
    print(f"next: fddbench shard 1 {quote(str(folder))}, ..., then fddbench merge {quote(str(folder))} --output DIR")
    return 0


def shard(args: argparse.Namespace) -> int:
    """Fly one shard of a planned campaign, or what is left of it.

    SIGTERM and Ctrl-C save what is finished; the same command goes on.
    """
    from fddbench.api.sharding import fly_shard
    from fddbench.cli.progress import said_of_interrupted, shown

    with shown(f"shard {args.number}", quiet=args.quiet) as progress:
        report = fly_shard(
            args.number,
            args.folder,
            jobs=args.jobs,
            progress=progress,
            notice=lambda text: print(f"fddbench: {text}", file=sys.stderr),
        )
    if report.interrupted:
        return said_of_interrupted(report)
    again = f", {report.continued} found done" if report.continued else ""
    failed = f"; {report.failed_rows} rows failed" if report.failed_rows else ""
    print(f"{report.flights} flights flown{again} in {report.wall_s:.1f} s; shard in {report.folder}{failed}")
    return 1 if report.failed_rows else 0


def slurm(args: argparse.Namespace) -> int:
    """Print a job array of SLURM that flies a campaign in shards.

    fddbench slurm CAMPAIGN.yaml > job.sbatch. A job whose time is over, or that has to make room, saves what is finished, is
    requeued and goes on.
    """
    from fddbench.api import campaigns
    from fddbench.api.sharding import slurm_job

    campaign = campaigns.read(args.campaign, args.overrides)
    folder = _folder(args, campaign.name)
    words = [str(args.campaign), *(word for text in args.overrides for word in ("--set", text))]
    command = ["fddbench", "plan", *words, "--shards", str(args.shards), "--out", str(folder)]
    text = slurm_job(campaign, args.shards, folder, jobs=args.jobs, time=args.time, plan=" ".join(map(quote, command)))
    print(text, end="")
    print(f"next: {' '.join(map(quote, command))}, then sbatch the job", file=sys.stderr)
    return 0


def sharding_arguments(subs, common) -> None:  # type: ignore[no-untyped-def]
    """Arguments of these commands; `common` adds those of every command that reads a campaign."""
    for command in (add(subs, "plan", plan), add(subs, "slurm", slurm)):
        common(command)
        is_job = command.prog.endswith("slurm")
        command.add_argument(
            "--shards", type=flights, required=not is_job, default=10, metavar="N",
            help="how many" + (" (default: 10)" if is_job else ""),
        )  # fmt: skip
        command.add_argument(
            "--out", type=Path, metavar="DIR", help="folder that all jobs see (default: results/<name of the campaign>)"
        )
        if is_job:
            command.add_argument("--jobs", type=jobs, default=2, metavar="N", help="processors of a job (default: 2)")
            command.add_argument(
                "--time",
                type=_time,
                default="04:00:00",
                metavar="HH:MM:SS",
                help="of a job at most (default: 04:00:00)",
            )
    one = add(subs, "shard", shard)
    one.add_argument("number", type=_number, metavar="K", help="number of the shard, from 1")
    one.add_argument("folder", type=Path, metavar="DIR", help="folder that `fddbench plan` made")
    one.add_argument("--jobs", type=jobs, default=2, metavar="N", help="worker processes (default: 2)")
    one.add_argument("--quiet", action="store_true", help="no progress")
    trusting(one)


def _folder(args: argparse.Namespace, name: str) -> Path:
    return args.out if args.out is not None else Path("results") / name


def _number(text: str) -> int:
    if not text.isascii() or not text.isdigit() or not 1 <= int(text) <= 10_000:
        raise argparse.ArgumentTypeError(f"need the number of a shard, from 1, got {text!r}")
    return int(text)


def _time(text: str) -> str:
    if not re.fullmatch(r"(\d+-)?\d{1,2}:[0-5]\d:[0-5]\d", text):
        raise argparse.ArgumentTypeError(f"need HH:MM:SS or D-HH:MM:SS, got {text!r}")
    return text
