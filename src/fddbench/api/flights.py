"""Single flights: their signals again, and the score of declarations of one's own."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from fddbench.campaign.addresses import Address
from fddbench.campaign.load import read_campaign
from fddbench.campaign.meaning import Campaign
from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats, Recording
from fddbench.results.table import named
from fddbench.runner.assembling import assemble
from fddbench.runner.declared import declared_rows
from fddbench.runner.fingerprint import frozen
from fddbench.runner.replay import replay_campaign

__all__ = ["campaign_of", "score", "signals"]


def signals(source: Campaign | str | Path, scenario: str, cases: Sequence[Address] | None = None) -> Recording:
    """Signals of flights of one scenario, flown again bit for bit.

    Parameters
    ----------
    source : Campaign, str or Path
        A campaign, its file or name, or a folder of results.
    scenario : str
        Name of the scenario.
    cases : sequence, optional
        Names as in the column ``case``, ``"jam_a/3/0/17"``, or (point, level, run); all of the scenario by default.

    Returns
    -------
    Recording
        Measured and true signals by name with unit, (n_time, n_cases), and what every detector shows.

    Raises
    ------
    FddbenchError
        There is no such scenario or case, or none of the flights can be flown.
    """
    campaign = campaign_of(source)
    names = [entry.name for entry in campaign.scenarios]
    if scenario not in names:
        raise FddbenchError(f"campaign {campaign.name!r} has no scenario {scenario!r}; known: {', '.join(names)}")
    chosen = None if cases is None else {scenario: list(cases)}
    for recording in replay_campaign(campaign, chosen, scenarios=[scenario]):
        return recording
    raise FddbenchError(f"none of these flights of {scenario!r} can be flown: they are infeasible")


def score(
    source: Campaign | str | Path,
    cases: Sequence[str],
    declared: Floats | None,
    *,
    alarm: Floats | None = None,
    residual: Floats | None = None,
    estimate: Floats | None = None,
    estimates: str = "sites",
    watches: Sequence[str] | None = None,
    name: str = "own",
) -> pd.DataFrame:
    """Rows of one's own declarations, scored as those of a detector.

    Parameters
    ----------
    source : Campaign, str or Path
        A campaign, its file or name, or a folder of results.
    cases : sequence of str
        Names of flights of one length, ``"jam_a/3/0/17"``.
    declared : (n_time, n_sites, n_cases) array or None
        1 where a site is declared at a sample, else 0; sites in the order of the benchmark. None: something that only
        detects, scored by its alarm.
    alarm, residual : (n_time, n_cases) arrays, optional
        Alarm (any site declared), and residual over threshold [-] (0).
    estimate : (n_time, n_sites, n_cases) or (n_time, n_cases) array, optional
        Size of the fault on each site, or with `estimates` the error of a voted signal, in its unit.
    estimates : str
        "sites", or the name of the voted signal.
    watches : sequence of str, optional
        Sites that are watched; all by default.
    name : str
        What the detector is called in the rows.

    Returns
    -------
    DataFrame
        As `load` gives them.

    Raises
    ------
    FddbenchError
        Arrays of another shape than the flights have.
    """
    assembly = assemble(campaign_of(source))
    table = declared_rows(
        assembly, assembly.plan.numbers(cases), declared, alarm=alarm, residual=residual, estimate=estimate,
        estimates=estimates, watches=watches, name=name,
    )  # fmt: skip
    frame: pd.DataFrame = named(table).to_pandas(types_mapper=pd.ArrowDtype)
    return frame


def campaign_of(source: Campaign | str | Path) -> Campaign:
    """Campaign itself, of a folder of results, or of a file."""
    if isinstance(source, Campaign):
        return source
    path = Path(source)
    if (path / "provenance.json").is_file():
        return frozen(path)
    return read_campaign(path)
