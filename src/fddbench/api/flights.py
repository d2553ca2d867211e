"""Single flights: their signals again, and the score of declarations of one's own."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from fddbench.campaign.addresses import Address
from fddbench.campaign.meaning import Campaign
from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats, Recording
from fddbench.results.table import named
from fddbench.runner.assembling import assemble
from fddbench.runner.declared import declared_rows
from fddbench.runner.fingerprint import frozen
from fddbench.runner.replay import replay_campaign
from fddbench.runner.supervised.trial import read_safely

__all__ = ["campaign_of", "score", "signals"]


def signals(
    source: Campaign | str | Path, which: str | Sequence[str], cases: Sequence[Address] | None = None
) -> Recording:
    """Signals of flights of one scenario, flown again bit for bit.

    Parameters
    ----------
    source : Campaign, str or Path
        A campaign, its file or name, or a folder of results.
    which : str or sequence of str
        Names of flights as in the column ``case``, ``"jam_a/3/0/17"``, all of one scenario; or the name of a scenario.
    cases : sequence, optional
        With the name of a scenario: which of its flights, by their names or as (point, level, run); all by default.

    Returns
    -------
    Recording
        Measured and true signals by name with unit, (n_time, n_cases), and what every detector shows and declares.

    Raises
    ------
    FddbenchError
        There is no such scenario or case, or none of the flights can be flown.

    Examples
    --------
    >>> signals("smoke", "jam_b/0/0/3").signals["r_deg_s_1"].shape
    (1201, 1)
    """
    campaign = campaign_of(source)
    names = [entry.name for entry in campaign.scenarios]
    scenario, chosen = _chosen(which, cases)
    if scenario not in names:
        raise FddbenchError(f"campaign {campaign.name!r} has no scenario {scenario!r}; known: {', '.join(names)}")
    for recording in replay_campaign(campaign, chosen, scenarios=[scenario]):
        return recording
    raise FddbenchError(f"none of these flights of {scenario!r} can be flown: they are infeasible")


def _chosen(
    which: str | Sequence[str], cases: Sequence[Address] | None
) -> tuple[str, dict[str, Sequence[Address]] | None]:
    """Scenario, and which of its flights; None for all."""
    if isinstance(which, str) and "/" not in which:
        return which, None if cases is None else {which: list(cases)}
    flights = [which] if isinstance(which, str) else list(which)
    if cases is not None or not flights or not all(isinstance(name, str) and "/" in name for name in flights):
        raise FddbenchError(
            f"name flights as in the column case, 'jam_a/3/0/17', or a scenario and its cases; got {which!r}"
        )
    scenarios = list(dict.fromkeys(name.split("/")[0] for name in flights))
    if len(scenarios) > 1:
        raise FddbenchError(
            f"flights of one scenario at a time, for they have one length; these are of {', '.join(scenarios)}"
        )
    return scenarios[0], {scenarios[0]: flights}


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
    return read_safely(path)
