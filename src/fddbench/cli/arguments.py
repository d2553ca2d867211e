"""The arguments of all commands."""

import argparse
from pathlib import Path

from fddbench import __version__
from fddbench.cli import (
    aircraft,
    asking,
    commands,
    completing,
    counting,
    data_sets,
    designing,
    exporting,
    looking,
    requiring,
)
from fddbench.cli.added import add
from fddbench.cli.checked_numbers import flights as _flights
from fddbench.cli.checked_numbers import probability as _probability
from fddbench.cli.checked_numbers import share as _share
from fddbench.cli.folder_arguments import growing_arguments, looking_arguments, trusting, verify_arguments
from fddbench.cli.run_arguments import run_arguments
from fddbench.cli.sharding import sharding_arguments

__all__ = ["parser"]


def parser() -> argparse.ArgumentParser:
    """Parser of all commands; the docstring of a command is its help."""
    top = argparse.ArgumentParser(
        prog="fddbench",
        description="Monte-Carlo benchmark campaigns for aerospace fault detection and diagnosis.",
        epilog="Exit codes: 0 done, 1 done but some cases failed or a requirement is not met, 2 a mistake in what you wrote, "
        "74 a disk that is full or fails, 130 interrupted (Ctrl-C), 143 ended from outside (SIGTERM).",
    )
    top.add_argument("--version", action="version", version=f"fddbench {__version__}")
    subs = top.add_subparsers(metavar="COMMAND")

    run = add(subs, "run", commands.run)
    run_arguments(run)
    _set(run)
    requiring.arguments(run)

    _reading(subs)
    looking_arguments(subs)
    verify_arguments(add(subs, "verify", looking.verify))
    growing_arguments(subs)
    sharding_arguments(subs, _campaign)

    _counting(subs)
    cost = add(subs, "cost", commands.cost)
    cost.add_argument("detector", metavar="DETECTOR", help="name of a design")
    cost.add_argument(
        "--campaign",
        type=Path, metavar="CAMPAIGN.yaml",
        help="campaign whose benchmark and sample time count (default: the first shipped one that feeds it)",
    )  # fmt: skip

    exporting.arguments(add(subs, "export", exporting.export))
    data = add(subs, "dataset", data_sets.dataset)
    _campaign(data)
    data_sets.dataset_arguments(data)
    _bound(add(subs, "bound", commands.bound))

    check = add(subs, "check", commands.check)
    _campaign(check)

    design = add(subs, "design", designing.design)
    design.add_argument("design", type=Path, metavar="FILE", help="design file with a recipe")
    design.add_argument("--output", type=Path, metavar="FILE", help="where to write the design (default: print it)")
    design.add_argument("--force", action="store_true", help="replace the file when it exists")
    _tune(add(subs, "tune", designing.tune))

    _modes(add(subs, "modes", aircraft.modes))
    _asking(subs)
    completing.attach(top)
    return top


def _reading(subs) -> None:  # type: ignore[no-untyped-def]
    """Commands that read a folder of results."""
    report = add(subs, "report", commands.report)
    report.add_argument(
        "folders", type=Path, nargs="*", metavar="DIR",
        help="folder of results (default: the newest under results/); of several their comparison",
    )  # fmt: skip
    report.add_argument("--no-replay", action="store_true", help="no signals and no bound: nothing is flown again")
    report.add_argument(
        "--output",
        type=Path,
        metavar="FILE",
        help="page to write (default: DIR/report.html; of several comparison.html beside the first)",
    )

    trusting(report)

    scores = add(subs, "scores", commands.scores)
    scores.add_argument("folder", type=Path, metavar="DIR", help="folder of results")
    trusting(scores)

    finding = add(subs, "finding", commands.finding)
    finding.add_argument("folder", type=Path, metavar="DIR", help="folder of results")
    trusting(finding)


def _counting(subs) -> None:  # type: ignore[no-untyped-def]
    """Commands that count and compare."""
    table = add(subs, "table", counting.table)
    table.add_argument("folder", type=Path, metavar="DIR", help="folder of results")
    table.add_argument(
        "--format", choices=counting.FORMATS, default="markdown", help="what to write it as (default: markdown)"
    )
    table.add_argument(
        "--by", action="append", default=[], metavar="COLUMN", help="split by this column (may be repeated)"
    )
    table.add_argument("--output", type=Path, metavar="FILE", help="file to write (default: print it)")

    pod = add(subs, "pod", counting.pod)
    pod.add_argument("folder", type=Path, metavar="DIR", help="folder of results")
    pod.add_argument("--size", default="", metavar="COLUMN", help="size of the fault (default: every one that differs)")

    compare = add(subs, "compare", counting.compare)
    compare.add_argument("folder", type=Path, metavar="A", help="folder of results")
    compare.add_argument("other", type=Path, nargs="?", metavar="B", help="another one (default: A itself)")
    compare.add_argument(
        "--detector", action="append", default=[], metavar="NAME",
        help="detector of A, and once more that of B (default: every one with itself)",
    )  # fmt: skip
    compare.add_argument(
        "--require", action="append", default=[], metavar="MEASURE",
        help="end with 1 where this got worse: right, wrong_site, false_alarm, detection_time, or stated (may be repeated)",
    )  # fmt: skip


def _asking(subs) -> None:  # type: ignore[no-untyped-def]
    """Commands that tell what there is, and that give something to start from."""
    ask = add(subs, "list", asking.list_)
    ask.add_argument(
        "subject", nargs="?", default="", metavar="SUBJECT",
        help="name of a benchmark, or benchmarks, faults, voters, detectors, campaigns, designs (default: everything)",
    )  # fmt: skip
    init = add(subs, "init", asking.init)
    init.add_argument("folder", type=Path, nargs="?", default=Path(), metavar="DIR", help="where to (default: here)")
    names = (
        "[--detector NAME | --trained NAME |\n" + " " * 21 + "--benchmark NAME | --fault NAME | --campaign NAME | --ci]"
    )
    init.usage = f"fddbench init [-h] [DIR] {names}"  # argparse does not break a group
    one = init.add_mutually_exclusive_group()
    for what in ("detector", "trained", "benchmark", "fault", "campaign"):
        said = "detector that is trained on labelled flights" if what == "trained" else f"{what} of your own"
        one.add_argument(f"--{what}", metavar="NAME", help=f"a small {said}, and a campaign that flies it")
    one.add_argument("--ci", action="store_true", help="a workflow of GitHub for the campaigns in DIR")
    schema = add(subs, "schema", asking.schema)
    schema.add_argument("subject", nargs="?", default="", metavar="BENCHMARK", help="name of a benchmark, or designs")
    schema.add_argument("--output", type=Path, metavar="FILE", help="file to write (default: print it)")
    completion = add(subs, "completion", completing.completion)
    completion.add_argument("shell", choices=completing.SHELLS, help="bash, zsh or fish")


def _campaign(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "campaign", type=Path, metavar="CAMPAIGN.yaml", help="campaign file, or the name of a shipped one"
    )
    _set(command)


def _set(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--set", action="append", default=[], metavar="PATH=VALUE", dest="overrides",
        help="change a value of the campaign, e.g. dispersions.monte_carlo.runs=10 (may be repeated)",
    )  # fmt: skip


def _bound(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "campaign",
        type=Path,
        metavar="CAMPAIGN.yaml",
        help="campaign file, name of a shipped one, or folder of results",
    )
    command.add_argument(
        "--p-fa", type=_probability, default=1e-6, metavar="P", help="false alarms of one decision (default: 1e-6)"
    )
    command.add_argument(
        "--flights",
        type=_flights,
        default=25,
        metavar="N",
        help="flights of a scenario that are looked at (default: 25)",
    )


def _tune(command: argparse.ArgumentParser) -> None:
    command.add_argument("design", type=Path, metavar="DESIGN", help="name of a design, or its file")
    _campaign(command)
    command.usage = (  # argparse does not break a group
        "fddbench tune [-h] DESIGN CAMPAIGN.yaml [--set PATH=VALUE]\n                     [--false-alarm-rate SHARE |"
        " --per-flight SHARE |\n                     --per-hour RATE] [options]"
    )
    target = command.add_mutually_exclusive_group()
    target.add_argument(
        "--false-alarm-rate", type=_share, metavar="SHARE",
        help="largest share of these very flights with a false alarm (default: 0.01)",
    )  # fmt: skip
    target.add_argument("--per-flight", type=_share, metavar="SHARE", help="largest share of other flights, e.g. 0.01")
    target.add_argument("--per-hour", type=float, metavar="RATE", help="most false alarms per hour of other flights")
    command.add_argument(
        "--confidence", type=_share, metavar="SHARE", help="with which that holds, e.g. 0.95 (default: on average)"
    )
    command.add_argument(
        "--by", choices=("factor", "residual"),
        help="one factor on all thresholds, or equally many flights beyond each residual (default where the kind shows them)",
    )  # fmt: skip
    command.add_argument("--only", metavar="KEY[,KEY]", help="tune only these thresholds, by one factor")
    command.add_argument(
        "--output", type=Path, metavar="FILE", help="file to write (default: detectors/DESIGN_tuned.yaml)"
    )
    command.add_argument("--force", action="store_true", help="replace the file when it exists")


def _modes(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "aircraft", type=Path, nargs="?", metavar="FILE", help="file of an aircraft (default: the shipped twin-jet)"
    )
    command.add_argument("--feasible", action="store_true", help="only the points that it can fly")
