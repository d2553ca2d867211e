"""One function a command; everything heavy is imported by the command that needs it."""

import argparse
import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from fddbench.cli.outputs import require_writable
from fddbench.cli.requiring import all_pass, refuse_unstated, until_decided
from fddbench.errors import FddbenchError

if TYPE_CHECKING:
    import pandas as pd

    from fddbench.runner.run import RunReport

__all__ = [
    "bound",
    "check",
    "cost",
    "finding",
    "report",
    "run",
    "scores",
    "told",
]


_INTERRUPTED = 130


def run(args: argparse.Namespace) -> int:
    """Fly campaigns and write their tables.

    Goes on where an earlier run of the same campaign stopped. Ctrl-C stops after saving what is finished. Of several campaigns
    one with a mistake does not keep the others from flying; the exit code is the worst of theirs. What a campaign requires is
    judged; with --require the run ends with 1 unless all of it is shown to be met; with --until decided more runs are
    flown until each verdict is pass or fail.
    """
    if len(args.campaigns) == 1:
        return _run(args.campaigns[0], args)
    for option, what in (("out", "folder"), ("junit", "verdicts")):
        if getattr(args, option) is not None:
            raise FddbenchError(f"--{option} names the {what} of one campaign; several go into results/<name of each>")
    codes: dict[Path, int] = {}
    for path in args.campaigns:
        print(f"== {path}")
        try:
            codes[path] = _run(path, args)
        except FddbenchError as error:
            print(f"fddbench: {error}", file=sys.stderr)
            codes[path] = 2
        if codes[path] == _INTERRUPTED:
            return _INTERRUPTED
        print()
    words = {0: "done", 1: "done, some flights failed or requirements not met", 2: "not flown, see above"}
    width = max(len(str(path)) for path in codes)
    for path, code in codes.items():
        print(f"{path!s:<{width}}  {words[code]}")
    return max(codes.values())


def _run(path: Path, args: argparse.Namespace) -> int:
    """Fly one campaign."""
    from fddbench.api import campaigns
    from fddbench.cli.progress import shown

    campaign = campaigns.read(path, args.overrides)
    refuse_unstated(campaign, args)
    kept: list[tuple[pd.DataFrame, pd.DataFrame]] = []
    with shown(campaign.name, quiet=args.quiet) as progress:
        fly = until_decided(path, args) if args.until else partial(campaigns.run, campaign)
        report = fly(
            folder=args.out,
            jobs=args.jobs,
            fresh=args.fresh,
            backend=args.backend,
            compiled_as=args.compiled_as,
            engine=args.engine,
            address=args.dask_address or args.ray_address,
            only=args.only,
            retry_failed=args.retry_failed,
            progress=progress,
            notice=lambda text: print(f"fddbench: {text}", file=sys.stderr),
            summarised=lambda *tables: kept.append(tables),
        )
    return told(report, kept, wide=args.wide, require=args.require, junit=args.junit)


def told(
    report: "RunReport",
    kept: "list[tuple[pd.DataFrame, pd.DataFrame]]",
    *,
    wide: bool,
    require: bool = False,
    junit: Path | None = None,
) -> int:
    """Print how a run ended, its tables and the verdicts on what its campaign requires; exit code of the command."""
    from fddbench.results.folder import provenance_of

    folder = report.folder
    if report.interrupted:
        from fddbench.cli.progress import said_of_interrupted

        return said_of_interrupted(report)
    _summary(folder, kept[-1], wide=wide, failed=report.failed_rows > 0)
    passed = all_pass(folder, junit=junit, job=require)
    again = f", {report.continued} found done" if report.continued else ""
    print(f"\n{report.flights} flights flown{again} in {report.wall_s:.1f} s; results in {folder}")
    logs: dict[str, str] = provenance_of(folder).get("logs", {})
    print("".join(f"log {name}: {said}\n" for name, said in logs.items()), end="")
    print(f"next: fddbench report {folder}")
    return 1 if report.failed_rows or (require and not passed) else 0


def _summary(folder: Path, tables: "tuple[pd.DataFrame, pd.DataFrame]", *, wide: bool, failed: bool) -> None:
    """Print the summary tables of a folder of results, wide ones with their bounds, and which of its flights failed."""
    from fddbench.reporting.terminal import to_text
    from fddbench.results.kept import kept_of
    from fddbench.results.whole import holdings

    found = holdings(folder)
    if found.partial:
        print(f"not the whole campaign: {found.sentence}")
    kept = kept_of(folder)
    if kept is not None:
        print(f"all rows are counted; kept are {kept}")
    summary, alarms = tables
    print(to_text(_with_bounds(folder, summary) if wide else summary, alarms, wide=wide))
    if failed:
        _failures(folder)


def _with_bounds(folder: Path, summary: "pd.DataFrame") -> "pd.DataFrame":
    """Summary with the bound of each score; without it where none can be stated, which is said."""
    from fddbench.api.bounds import bounds
    from fddbench.metrics.bound import breaches, with_bounds

    try:
        stated = bounds(folder)
    except FddbenchError as error:  # of somebody else's benchmark; what was flown is shown all the same
        print(f"fddbench: no bound: {error}", file=sys.stderr)
        return summary
    for sentence in breaches(summary, stated):
        print(f"above its bound: {sentence}")
    return with_bounds(summary, stated)


def _failures(folder: Path) -> None:
    """Print what went wrong in which flights."""
    from fddbench.results.table import read_rows

    rows = read_rows(folder, ["scenario", "point", "level", "run", "detector", "status", "reason"])
    failed = rows[~rows["status"].isin(["ok", "infeasible"])]
    for (detector, status, reason), group in failed.groupby(["detector", "status", "reason"], dropna=False):
        first = group[["scenario", "point", "level", "run"]].head(3)
        cases = ", ".join("/".join(map(str, address)) for address in first.itertuples(index=False))
        print(f"{status}: {detector}, {len(group)} flights (case {cases}{', ...' if len(group) > 3 else ''}): {reason}")


def report(args: argparse.Namespace) -> int:
    """Write the page of a folder of results: one HTML file that needs no network.

    Without a folder that of the newest under results/; of several their comparison, flight by flight where they hold the same.
    """
    from fddbench.api.pages import report as write

    if args.output is not None:
        if args.output.suffix.lower() not in {".html", ".htm"}:
            raise FddbenchError(f"{args.output}: the page is HTML; let the name of the file end in .html")
        require_writable(args.output, "--output")
    print(write(args.folders or None, args.output, replay=not args.no_replay))
    return 0


def bound(args: argparse.Namespace) -> int:
    """Print how well any detector can do: the ideal test that knows model, fault and time.

    By scenario and by what it is supposed to know: detectability d, and the probability P_D that it finds the faulty sites.
    """
    from fddbench.api.bounds import bounds
    from fddbench.reporting.bounds import bounds_text

    print(bounds_text(bounds(args.campaign, p_fa=args.p_fa, flights=args.flights)))
    return 0


def scores(args: argparse.Namespace) -> int:
    """Print the scores of a folder of results as YAML, to keep under version control.

    A folder that does not hold all flights of its campaign is refused.
    """
    from fddbench.api.tables import detectable, overview
    from fddbench.reporting.scores import scores_text
    from fddbench.results.folder import provenance_of
    from fddbench.results.kept import kept_of
    from fddbench.results.whole import require_whole

    require_whole(args.folder)
    maps = detectable(args.folder) if kept_of(args.folder) is None else None
    print(scores_text(*overview(args.folder), provenance_of(args.folder), maps), end="")
    return 0


def finding(args: argparse.Namespace) -> int:
    """Print what a campaign found: its question and at most ten lines of Markdown, written from its rows.

    A folder that does not hold all flights of its campaign is refused.
    """
    from fddbench.api.findings import finding as found

    print(found(args.folder), end="")
    return 0


def cost(args: argparse.Namespace) -> int:
    """Count what a step of a detector costs: the load on a flight computer.

    Operations by kind, multiply-add pairs, bytes of state and tables, and nanoseconds per step and flight in compiled
    code on this machine; then the same of the exported C, where a compiler is here: code, tables, stack and time-stamp ticks.
    """
    from fddbench.runner.load import detector_load, in_words
    from fddbench.runner.single import assembly_with

    assembly = assembly_with(args.detector, args.campaign)
    load = detector_load(assembly.detectors[args.detector], assembly.loop.bus)
    print(f"{args.detector}, at {assembly.loop.bus.sample_s} s: {in_words(load)}")
    if load.cost is not None:
        from fddbench.runner.in_c import in_c_words

        print(in_c_words(args.detector, assembly.detectors[args.detector], assembly.loop.bus))
        for name, number in load.cost.operations.items():
            print(f"  {name:<12}{number:>6}")
    return 0


def check(args: argparse.Namespace) -> int:
    """Say every mistake of a campaign at once, or what it would fly, and how long that takes.

    Every detector is stepped a few samples; those that cannot be compiled are named with what they cost.
    """
    from fddbench.api.checking import described

    print(described(args.campaign, args.overrides))
    return 0
