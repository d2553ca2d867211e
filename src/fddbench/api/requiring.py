"""What a campaign requires of its detectors, judged by the flights of a folder of results."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path

import pandas as pd
import pyarrow as pa

from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import Plan, PlannedScenario
from fddbench.campaign.plan import plan as planned
from fddbench.campaign.rules.model import RequirementEntry
from fddbench.campaign.rules.required import chosen, name_of
from fddbench.errors import FddbenchError
from fddbench.metrics.judging import judged
from fddbench.metrics.requirements import JUDGEMENTS, NEEDS, OF_FAULTS, Judgement, PlannedFlights, Requirement
from fddbench.reporting.requirements import to_junit
from fddbench.results.manifest import shards
from fddbench.results.shards import write_bytes
from fddbench.results.table import read_rows
from fddbench.runner.fingerprint import frozen

__all__ = ["judgements", "requirements", "stated", "write_junit"]


def requirements(folder: str | Path) -> pd.DataFrame:
    """One line per requirement of the campaign and detector: pass, fail or undecided, the value and its interval.

    The columns are those of `fddbench.metrics.requirements.JUDGEMENTS`; ``fddbench.columns("requirements")`` says what they
    mean. A folder that lacks flights is judged by its first runs that are whole; the verdict holds at any look.

    Parameters
    ----------
    folder : str or Path
        Folder of results.

    Raises
    ------
    ResultsError
        No folder of results, or a damaged one.

    Examples
    --------
    >>> requirements("results/smoke")[["name", "detector", "verdict"]]  # doctest: +SKIP
    """
    lines = [asdict(one) | {"scenarios": ", ".join(one.scenarios)} for one in judgements(folder)]
    found: pd.DataFrame = pa.Table.from_pylist(lines, schema=JUDGEMENTS).to_pandas(types_mapper=pd.ArrowDtype)
    return found


def judgements(
    folder: str | Path, campaign: Campaign | None = None, rows: pd.DataFrame | None = None
) -> list[Judgement]:
    """The same as records, in the order of the campaign; empty where it requires nothing.

    Parameters
    ----------
    campaign : Campaign, optional
        That of the folder, by those who have read it; what it requires may differ from what is frozen there.
    rows : DataFrame, optional
        Rows of the folder, by those who have read them; columns that they lack are read.

    Raises
    ------
    ResultsError
        As `requirements`.
    """
    own = frozen(Path(folder)) if campaign is None else campaign
    if not own.requirements:
        return []
    case_table = planned(own)
    columns = dict.fromkeys(
        each.per if each.per == "scenario" else f"p_{each.per}" for each in own.requirements if each.per
    )
    names = [*dict.fromkeys((*NEEDS, *columns))]
    if rows is None or not set(names) <= set(rows.columns):
        there = bool(shards(Path(folder)))
        rows = read_rows(Path(folder), names, fair=True) if there else pd.DataFrame(columns=names)
    by_detector = {str(name): part for name, part in rows[names].groupby("detector", sort=False)}
    return [one for entry in own.requirements for one in _of_entry(entry, own, case_table, by_detector)]


def stated(folder: str | Path) -> list[tuple[str, tuple[str, ...], tuple[str, ...]]]:
    """What the campaign of a folder requires, as measures of a comparison: (measure, scenarios, detectors).

    Raises
    ------
    FddbenchError
        It requires nothing.
    """
    own = frozen(Path(folder))
    if not own.requirements:
        raise FddbenchError(
            f"the campaign of {folder} requires nothing; name a measure, or write requirements: into it"
        )
    faulty = {each.name: bool(each.faults) for each in own.scenarios}
    designs = [design.name for design in own.designs]
    return [
        (
            _COMPARED[entry.of],
            chosen(entry.scenarios, [name for name in faulty if faulty[name] or entry.of not in OF_FAULTS]),
            chosen(entry.detectors, designs),
        )
        for entry in own.requirements
    ]


_COMPARED = {
    "right_share": "right",
    "wrong_site_share": "wrong_site",
    "normalized_detection_time": "detection_time",
    "false_alarm_share": "false_alarm",
    "false_alarms_per_hour": "false_alarm",
}
"""Measure of a comparison that is nearest to what is required."""


def write_junit(found: Sequence[Judgement], campaign: str, path: Path) -> Path:
    """Write judgements as JUnit XML; gives the file.

    Raises
    ------
    FddbenchError
        The file cannot be written there.
    """
    try:
        write_bytes(path, to_junit(found, campaign))
    except (FileExistsError, IsADirectoryError, NotADirectoryError, PermissionError) as error:
        raise FddbenchError(f"cannot write {path}: {error.strerror}; name another file with --junit") from error
    return path


def _of_entry(
    entry: RequirementEntry, campaign: Campaign, case_table: Plan, rows: dict[str, pd.DataFrame]
) -> Iterator[Judgement]:
    known = [one for one in case_table.scenarios if one.faults or entry.of not in OF_FAULTS]
    limit = entry.at_most if entry.share is None and entry.at_least is None else entry.share or entry.at_least
    assert limit is not None
    required = Requirement(
        name=name_of(entry),
        of=entry.of,
        limit=limit,
        within=entry.at_most if entry.share is not None else None,
        scenarios=chosen(entry.scenarios, [one.name for one in known]),
        confidence=entry.confidence,
    )
    flights = {one.name: _planned(one, campaign) for one in known}
    by = "" if entry.per is None else "scenario" if entry.per == "scenario" else f"p_{entry.per}"
    for detector in chosen(entry.detectors, [design.name for design in campaign.designs]):
        own = rows.get(detector, pd.DataFrame(columns=[*NEEDS, *([by] if by else [])]))
        yield from judged(required, own, flights, detector=detector, by=by, in_sample=detector in campaign.in_sample)


def _planned(scenario: PlannedScenario, campaign: Campaign) -> PlannedFlights:
    """Flights that are judged: where a campaign does not keep all rows, those of the runs that it keeps whole."""
    until_s = max(scenario.durations_s)
    if scenario.latest_onset_s is not None:
        until_s = min(until_s, scenario.latest_onset_s)
    runs = scenario.n_runs if campaign.keep == "all" else min(scenario.n_runs, campaign.kept_runs)
    return PlannedFlights(points=scenario.n_points, levels=scenario.n_levels, runs=runs, healthy_h=until_s / 3600.0)
