"""Arguments of `run`, and those that say who flies."""

import argparse
from pathlib import Path

from fddbench.cli.checked_numbers import jobs

__all__ = ["by_engine", "run_arguments"]


def run_arguments(command: argparse.ArgumentParser) -> None:
    """Arguments of `run`, but for those that other commands have too."""
    command.add_argument(
        "campaigns", type=Path, nargs="+", metavar="CAMPAIGN.yaml", help="campaign files, or names of shipped ones"
    )
    command.add_argument(
        "--out", type=Path, metavar="DIR", help="folder of results (default: results/<name of the campaign>)"
    )
    command.add_argument(
        "--jobs", type=jobs, default=2, metavar="N", help="worker processes (default: 2); no part of any result"
    )
    command.add_argument("--fresh", action="store_true", help="replace what the folder holds")
    command.add_argument(
        "--backend", choices=("auto", "llvm", "numpy"), default="auto",
        help="compiled where llvmlite is installed (auto), always, or never; no part of any result",
    )  # fmt: skip
    command.add_argument(
        "--compiled-as", choices=("c",), default=None,
        help="fly detectors as exported C, compiled by the system's compiler: the same rows",
    )  # fmt: skip
    command.add_argument(
        "--only", action="append", default=[], metavar="KEY=VALUE,...",
        help="fly a part: scenario=jam_a,detector=D,run=0-99 (keys: scenario, detector, point, level, run; may be repeated)",
    )  # fmt: skip
    command.add_argument(
        "--retry-failed", action="store_true",
        help="fly again what ended in error, nonfinite, memory, timeout or crashed (with the flights of its shards)",
    )  # fmt: skip
    by_engine(command)
    command.add_argument("--quiet", action="store_true", help="no progress")
    command.add_argument("--wide", action="store_true", help="every column of the table, as wide as it is")


def by_engine(command: argparse.ArgumentParser) -> None:
    """Options that say who flies."""
    command.add_argument(
        "--engine", choices=("auto", "threads", "loky", "dask", "ray"), default="auto",
        help="who flies: threads where compiled code flies, else processes (auto), or one by name; no part of any result",
    )  # fmt: skip
    address = command.add_mutually_exclusive_group()
    for name, port in (("dask", "tcp://host:8786"), ("ray", "ray://host:10001")):
        address.add_argument(
            f"--{name}-address",
            metavar="ADDRESS",
            help=f"{name} cluster to fly on, e.g. {port} (default: one of this machine)",
        )
