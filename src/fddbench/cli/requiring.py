"""What a run says of the requirements of its campaign."""

import argparse
import os
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from fddbench.cli.checked_numbers import runs
from fddbench.errors import FddbenchError

if TYPE_CHECKING:
    from fddbench.campaign.meaning import Campaign
    from fddbench.metrics.requirements import Judgement
    from fddbench.runner.run import RunReport

__all__ = ["all_pass", "arguments", "leave", "refuse_unstated", "until_decided", "write_ci"]


def arguments(run: argparse.ArgumentParser) -> None:
    """What `fddbench run` does with the verdicts."""
    run.add_argument(
        "--require", action="store_true",
        help="end with 1 unless every requirement of the campaign passes; summary for a job of GitHub",
    )  # fmt: skip
    run.add_argument(
        "--until",
        choices=("decided",),
        help="fly more runs, in the same folder, until every requirement passes or fails",
    )
    run.add_argument(
        "--at-most",
        type=runs,
        metavar="RUNS",
        help="end --until undecided after so many runs (default: 20 times the campaign's)",
    )
    run.add_argument(
        "--junit",
        type=Path,
        metavar="FILE",
        help="verdicts as JUnit XML (default: requirements.junit.xml beside the rows)",
    )


def refuse_unstated(campaign: "Campaign", args: argparse.Namespace) -> None:
    """Refuse to judge a campaign that requires nothing, before it is flown.

    Raises
    ------
    FddbenchError
        It has no requirements, or --at-most stands alone.
    """
    if args.at_most is not None and not args.until:
        raise FddbenchError("--at-most ends --until decided; without it the campaign says how many runs are flown")
    asked = [option for option in ("require", "junit", "until") if getattr(args, option)]
    if asked and not campaign.requirements:
        raise FddbenchError(
            f"--{asked[0]} judges what a campaign requires, and {campaign.path} requires nothing; write requirements: into it, "
            "such as [{of: right_share, at_least: 0.95}]"
        )


def until_decided(path: Path, args: argparse.Namespace) -> "Callable[..., RunReport]":
    """What flies a campaign until it is decided, for the arguments of a run."""
    from fddbench.api.deciding import run_until_decided

    return partial(run_until_decided, path, overrides=args.overrides, at_most=args.at_most)


def write_ci(folder: Path) -> int:
    """Write a workflow that judges the campaigns in a folder."""
    from fddbench.api.continuous import write_workflow

    print(write_workflow(folder))
    return 0


def all_pass(folder: Path, *, junit: Path | None = None, job: bool = False) -> bool:
    """Print the verdicts on a folder of results and leave them as JUnit XML; whether all pass, True where nothing is required.

    Parameters
    ----------
    junit : Path, optional
        Another file than ``requirements.junit.xml`` in the folder.
    job : bool
        Append them to the summary of a job of GitHub, where there is one.
    """
    from fddbench.api.requiring import judgements
    from fddbench.reporting.requirements import to_text

    found = judgements(folder)
    if not found:
        return True
    print(f"\n{to_text(found)}")
    leave(found, folder, junit=junit, job=job)
    return all(one.verdict == "pass" for one in found)


def leave(found: "list[Judgement]", folder: Path, *, junit: Path | None, job: bool) -> None:
    """Write the verdicts for servers.

    Raises
    ------
    FddbenchError
        The file cannot be written.
    """
    from fddbench.api.requiring import write_junit
    from fddbench.reporting.requirements import to_summary
    from fddbench.results.folder import provenance_of

    campaign = str(provenance_of(folder)["campaign"])
    path = write_junit(found, campaign, folder / "requirements.junit.xml" if junit is None else junit)
    if junit is not None:
        print(f"verdicts in {path}")
    summary = os.environ.get("GITHUB_STEP_SUMMARY") if job else None
    if summary:
        try:
            with Path(summary).open("a", encoding="utf-8") as file:
                file.write(to_summary(found, campaign))
        except OSError as error:  # no reason to hide the verdicts
            print(f"fddbench: no summary of the job: {summary}: {error.strerror}", file=sys.stderr)
