"""A campaign flown until what it requires is decided: more runs in the same folder, stage by stage."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import ceil
from pathlib import Path
from typing import Any

from fddbench.api.campaigns import read
from fddbench.api.campaigns import run as fly
from fddbench.api.requiring import judgements
from fddbench.campaign.meaning import Campaign
from fddbench.errors import FddbenchError
from fddbench.metrics.requirements import Judgement
from fddbench.results.fingerprint import Fingerprint
from fddbench.results.folder import changed_files, provenance_of
from fddbench.results.stages import stages_in
from fddbench.runner.fingerprint import frozen, frozen_before
from fddbench.runner.growing import grow_to
from fddbench.runner.run import RunReport

__all__ = ["next_runs", "run_until_decided"]

_AT_MOST = 20
"""Times the runs of the campaign that are flown where nobody says how many."""
_RUNS = "dispersions.monte_carlo.runs"


def run_until_decided(
    campaign: str | Path,
    folder: str | Path | None = None,
    *,
    overrides: Sequence[str] = (),
    at_most: int | None = None,
    fresh: bool = False,
    notice: Callable[[str], None] | None = None,
    **options: Any,
) -> RunReport:
    """Fly a campaign, and more runs of it in the same folder until every requirement passes or fails.

    A verdict holds at any look, so looking after every stage costs nothing of its confidence, and neither does going on with a
    folder that was flown before. The rows are those of the campaign with more runs, bit for bit.

    Parameters
    ----------
    campaign : str or Path
        File of a campaign, or name of a shipped one, with requirements.
    folder : str or Path, optional
        Where the results go, ``results/<name>`` by default; one that holds more runs of the campaign is gone on with.
    overrides : sequence of str
        As of `fddbench.read`.
    at_most : int, optional
        Runs after which it ends undecided, 20 times those of the campaign by default.
    fresh, notice
        See `fddbench.run`.
    options
        All others of `fddbench.run` but ``only``: verdicts are on whole runs.

    Raises
    ------
    FddbenchError
        It requires nothing or draws nothing, `at_most` lies below its runs, or as `fddbench.run`.
    """
    if options.get("only"):
        raise FddbenchError(
            "verdicts are on whole runs: fly them all, or judge what was flown without going on until decided"
        )
    own = read(campaign, overrides)
    most = _most(own, at_most)
    path = Path("results") / own.name if folder is None else Path(folder)
    if not fresh:
        own = _as_far_as_flown(own, campaign, overrides, path)
    flown = own.dispersions.monte_carlo.runs if own.dispersions.monte_carlo else 1
    report = fly(own, path, fresh=fresh, notice=notice, **options)
    done, flights, wall_s = report, report.flights, report.wall_s
    while not done.interrupted:
        found = judgements(path)
        runs = next_runs(found, flown, most)
        if runs is None:
            _tell_the_rest(found, flown, notice)
            break
        if notice is not None:
            notice(f"undecided; flying {runs} runs in all")
        larger, flown = read(campaign, [*overrides, f"{_RUNS}={runs}"]), runs
        grow_to(path, frozen(path), larger)
        done = fly(larger, path, notice=notice, **options)
        flights, wall_s = flights + done.flights, wall_s + done.wall_s
    return replace(done, flights=flights, continued=report.continued, wall_s=wall_s)


def next_runs(found: Sequence[Judgement], runs: int, most: int) -> int | None:
    """Runs of the next stage, None where there is to be none: all is decided, or no more runs would do.

    As many as the present rate asks for and a tenth more, at least a quarter and at most as many again.

    Parameters
    ----------
    found : sequence of Judgement
        On the runs of this stage.
    runs, most : int
        Monte-Carlo runs of this stage, and largest number of them.
    """
    # of scenarios with runs of their own there are no more to be had
    able = [one for one in found if one.verdict == "undecided" and one.runs_planned == runs]
    if not able or runs >= most:
        return None
    asked = max(runs if one.runs_needed is None else ceil(one.runs_needed * 11 / 10) for one in able)
    return min(runs + min(max(asked, ceil(runs / 4)), runs), most)


def _tell_the_rest(found: Sequence[Judgement], runs: int, notice: Callable[[str], None] | None) -> None:
    """Why it ends although something is undecided."""
    own = dict.fromkeys(one.name for one in found if one.verdict == "undecided" and one.runs_planned != runs)
    if own and notice is not None:
        notice(
            f"undecided stays {', '.join(own)}: its scenarios have `runs:` of their own, which do not grow; remove them"
        )


def _most(campaign: Campaign, at_most: int | None) -> int:
    """Runs after which it ends, if more runs of the campaign can decide what it requires.

    Raises
    ------
    FddbenchError
        They cannot.
    """
    drawn = campaign.dispersions.monte_carlo
    if not campaign.requirements:
        raise FddbenchError(f"nothing to decide: {campaign.path} has no requirements; write them into it")
    if drawn is None:
        raise FddbenchError(f"{campaign.path} draws nothing (it has no monte_carlo), so it has no runs to add")
    if campaign.keep != "all":
        raise FddbenchError(
            f"{campaign.path} keeps a part of its rows (keep: {campaign.keep}), and verdicts are by rows, those of the first "
            f"{campaign.kept_runs} runs, so that more runs decide nothing. Fly it with --set keep=all"
        )
    if at_most is not None and at_most < drawn.runs:
        raise FddbenchError(
            f"at most {at_most} runs, but the campaign itself has {drawn.runs}; allow more, or --set {_RUNS}="
        )
    return at_most or _AT_MOST * drawn.runs


def _as_far_as_flown(own: Campaign, campaign: str | Path, overrides: Sequence[str], folder: Path) -> Campaign:
    """The campaign with the runs of its folder of results, where an earlier run has added some."""
    if not (folder / "provenance.json").is_file():
        return own
    for runs in _runs_begun(folder):
        begun = read(campaign, [*overrides, f"{_RUNS}={runs}"])
        if begun.sha256 == Fingerprint.of(provenance_of(folder)).campaign_sha256:
            return begun
    there, here = frozen_before(folder).dispersions.monte_carlo, own.dispersions.monte_carlo
    if there is None or here is None or there.runs <= here.runs:
        return own
    return read(campaign, [*overrides, f"{_RUNS}={there.runs}"])


def _runs_begun(folder: Path) -> list[int]:
    """What may be the runs of a stage that was cut off before its campaign was frozen; none where nothing was cut off."""
    stages = stages_in(provenance_of(folder))
    if len(stages) < 2 or changed_files(folder) != ["campaign.yaml"]:
        return []
    return sorted({runs for _, _, runs in stages[-1].scenarios.values()}, reverse=True)
