"""Single flights: their signals again, and the score of declarations of one's own."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from fddbench.campaign.load import read_campaign
from fddbench.campaign.meaning import Campaign
from fddbench.errors import FddbenchError
from fddbench.interfaces import Floats, Recording
from fddbench.runner.assembling import assemble
from fddbench.runner.declared import declared_rows
from fddbench.runner.fingerprint import frozen
from fddbench.runner.replay import replay_campaign

__all__ = ["score", "signals"]


def signals(source: Campaign | str | Path, scenario: str, cases: Sequence[int] | None = None) -> Recording:
    """Signals of flights of one scenario, flown again bit for bit.

    Parameters
    ----------
    source : Campaign, str or Path
        A campaign, its file or name, or a folder of results.
    scenario : str
        Name of the scenario.
    cases : sequence of int, optional
        Case numbers as in the rows; all of the scenario by default.

    Returns
    -------
    Recording
        Measured and true signals by name with unit, (n_time, n_cases), and what every detector shows.

    Raises
    ------
    FddbenchError
        There is no such scenario, or none of the flights can be flown.
    """
    campaign = _campaign(source)
    names = [entry.name for entry in campaign.scenarios]
    if scenario not in names:
        raise FddbenchError(f"campaign {campaign.name!r} has no scenario {scenario!r}; known: {', '.join(names)}")
    chosen = None if cases is None else {scenario: np.asarray(cases, dtype=np.int64)}
    for recording in replay_campaign(campaign, chosen, scenarios=[scenario]):
        return recording
    raise FddbenchError(f"none of these flights of {scenario!r} can be flown: they are infeasible")


def score(
    source: Campaign | str | Path,
    cases: Sequence[int],
    declared: Floats,
    *,
    alarm: Floats | None = None,
    residual: Floats | None = None,
    name: str = "own",
) -> pd.DataFrame:
    """Rows of one's own declarations, scored as those of a detector.

    Parameters
    ----------
    source : Campaign, str or Path
        A campaign, its file or name, or a folder of results.
    cases : sequence of int
        Case numbers of flights of one length.
    declared : (n_time, n_sites, n_cases) array
        1 where a site is declared at a sample, else 0; sites in the order of the benchmark.
    alarm, residual : (n_time, n_cases) arrays, optional
        Alarm (any site declared), and residual over threshold [-] (0).
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
    assembly = assemble(_campaign(source))
    table = declared_rows(
        assembly, np.asarray(cases, dtype=np.int64), declared, alarm=alarm, residual=residual, name=name
    )
    frame: pd.DataFrame = table.to_pandas(types_mapper=pd.ArrowDtype)
    return frame


def _campaign(source: Campaign | str | Path) -> Campaign:
    """Campaign itself, of a folder of results, or of a file."""
    if isinstance(source, Campaign):
        return source
    path = Path(source)
    if (path / "provenance.json").is_file():
        return frozen(path)
    return read_campaign(path)
