"""Campaigns: read one, see what it would fly, fly it."""

from collections.abc import Callable, Sequence
from pathlib import Path

import pandas as pd

from fddbench.api.tables import leave_summary
from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import Plan
from fddbench.campaign.plan import plan as planned
from fddbench.campaign.selection import selected
from fddbench.errors import FddbenchError
from fddbench.runner.engines import Engine
from fddbench.runner.run import Progress, RunReport, run_campaign
from fddbench.runner.supervised.trial import read_safely

__all__ = ["plan", "read", "run"]


def read(path: str | Path, overrides: Sequence[str] = ()) -> Campaign:
    """Campaign of a file, or of a shipped campaign's bare name.

    Parameters
    ----------
    path : str or Path
        File, or a bare name such as ``"smoke"``.
    overrides : sequence of str
        ``path=value`` texts as of ``fddbench run --set``, e.g. ``["dispersions.monte_carlo.runs=5"]``.

    Raises
    ------
    fddbench.errors.CampaignError
        Every mistake in it, with its place; a plug-in that ends, hangs or exhausts the process that imports or makes it.

    Examples
    --------
    >>> read("smoke", ["detectors=[voting_monitor]"]).name
    'smoke'
    """
    return read_safely(Path(path), overrides)


def plan(campaign: Campaign | str | Path) -> Plan:
    """Case table of a campaign: scenarios with their lengths, onsets, limits and numbers of flights.

    >>> plan("smoke").n_cases
    55
    """
    return planned(campaign if isinstance(campaign, Campaign) else read(campaign))


def run(
    campaign: Campaign | str | Path,
    folder: str | Path | None = None,
    *,
    jobs: int = 2,
    fresh: bool = False,
    backend: str = "auto",
    compiled_as: str | None = None,
    engine: str = "auto",
    address: str | None = None,
    only: str | Sequence[str] = (),
    retry_failed: bool = False,
    progress: Callable[[Progress], None] | None = None,
    notice: Callable[[str], None] | None = None,
    summarised: Callable[[pd.DataFrame, pd.DataFrame], None] | None = None,
) -> RunReport:
    """Fly every case of a campaign that its folder of results does not hold yet, and leave its summary beside the rows.

    Parameters
    ----------
    campaign : Campaign, str or Path
        As read, or what `read` takes.
    folder : str or Path, optional
        Of results, ``results/<name>`` by default.
    jobs, fresh, backend, retry_failed, progress, notice
        See `fddbench.runner.run.run_campaign`.
    compiled_as : {"c"}, optional
        Detectors fly as the C that `fddbench.export` writes; the same rows.
    engine : {"auto", "threads", "loky", "dask", "ray"}
        Who flies; no part of any result. ``auto``: threads where compiled code flies, else processes.
    address : str, optional
        Of a dask or ray cluster, ``tcp://host:8786``; by default one of this machine for the time of the run.
    only : str or sequence of str
        Fly a part, ``"scenario=jam_a,run=0-99"``, of several texts all that any names; the folder is in part until the rest is.
    summarised : callable, optional
        Called at the end of a whole run with what ``fddbench.summary`` and ``fddbench.alarms`` give.

    Raises
    ------
    fddbench.errors.FddbenchError
        A mistake in the campaign, or a folder of another campaign.
    """
    own = campaign if isinstance(campaign, Campaign) else read(campaign)
    where = Path("results") / own.name if folder is None else Path(folder)
    words = [only] if isinstance(only, str) else only
    report = run_campaign(
        own,
        where,
        engine=Engine(name=engine, jobs=jobs, address=address),
        fresh=fresh,
        backend=_with_code(backend, compiled_as),
        wanted=selected(planned(own), words) if words else None,
        retry_failed=retry_failed,
        progress=progress,
        notice=notice,
    )
    if not report.interrupted:
        (summarised or _unheard)(*leave_summary(where))
    return report


def _unheard(*_: pd.DataFrame) -> None:
    """Nobody asked for the tables."""


def _with_code(backend: str, compiled_as: str | None) -> str:
    """Back end with the language in which detectors fly."""
    if compiled_as not in (None, "c"):
        raise FddbenchError(f"detectors fly as C or as they are; got compiled_as={compiled_as!r}, known: 'c'")
    return backend if compiled_as is None else f"{backend}+{compiled_as}"
