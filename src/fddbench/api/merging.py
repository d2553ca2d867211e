"""Several folders of results as one: parts of a campaign that flew on several machines, or that grew apart."""

from collections.abc import Sequence
from os.path import realpath
from pathlib import Path
from typing import Any

import yaml

from fddbench.api.aside import aside, campaign_in
from fddbench.api.tables import leave_summary
from fddbench.campaign.meaning import Campaign
from fddbench.errors import FddbenchError
from fddbench.results.folder import changed_files, provenance_of
from fddbench.results.whole import Holdings, holdings
from fddbench.runner.fingerprint import frozen
from fddbench.runner.merging import merge_into
from fddbench.runner.shares import is_planned, share_folders

__all__ = ["merge"]


def merge(folders: Sequence[str | Path], output: str | Path) -> Holdings:
    """Write the results of several folders into a new one, and say what it holds of its campaign.

    The folders hold parts of one campaign, or campaigns that differ in their runs, grid values, scenarios and detectors alone.
    The campaign of the new folder has all of these; flights that nobody flew are missing in it until it is run. Rows that two
    folders hold must be the same, bit for bit.

    Parameters
    ----------
    folders : sequence of str or Path
        Two or more folders of results, or one that was planned in shards, which stands for those that were flown; they are
        not written to.
    output : str or Path
        New folder.

    Raises
    ------
    FddbenchError
        A folder is none of results, they do not belong together (the message says why), or `output` holds something.
    """
    given = [Path(each) for each in folders]
    planned = [path for path in given if is_planned(path)]
    paths = [part for path in given for part in (share_folders(path) if path in planned else [path])]
    if planned and not paths:
        raise FddbenchError(f"no shard of {planned[0]} was flown; fddbench shard 1 {planned[0]}")
    places = {realpath(path) for path in paths}  # unlike resolve, it takes links in a circle
    if not planned and len(places) < 2:
        raise FddbenchError("two different folders of results at least; one alone is merged already")
    out = Path(output)
    if realpath(out) in places:
        raise FddbenchError(f"{out} is one of the folders to merge; name a new one with --output")
    read: dict[tuple[str, str], Campaign] = {}
    parts: dict[Path, Campaign] = {}
    for path in paths:  # shards have all the same campaign, which is read once
        provenance = provenance_of(path)
        key = (str(provenance["fingerprints"]), provenance["campaign_yaml_sha256"])
        if key not in read or changed_files(path):
            read[key] = frozen(path)
        parts[path] = read[key]
    with aside("the campaign of all") as written:
        merge_into(out, parts, _whole(list(parts.values()), written))
    leave_summary(out)
    return holdings(out)


def _whole(campaigns: Sequence[Campaign], written: Path) -> Campaign:
    """Campaign that has what any of them has; what they contradict each other in is found by `merge_into`."""
    content: dict[str, Any] = yaml.safe_load(campaigns[0].text)
    files: dict[str, bytes] = {}
    for campaign in campaigns:
        files = {**campaign.files(), **files}
        other = yaml.safe_load(campaign.text)
        for key, name in (("scenarios", "name"), ("detectors", "design")):
            known = {_name(entry, name) for entry in content[key]}
            content[key] = [*content[key], *(entry for entry in other[key] if _name(entry, name) not in known)]
        _widen(content.get("dispersions") or {}, other.get("dispersions") or {})
        _more_runs(content["scenarios"], other["scenarios"])
    return campaign_in(written, content, files)


def _name(entry: Any, key: str) -> str:
    return entry if isinstance(entry, str) else str(entry[key])


def _widen(mine: dict[str, Any], other: dict[str, Any]) -> None:
    """Grid values and runs that either has, and the longer sequence."""
    for name, values in (other.get("grid") or {}).items():
        own = (mine.get("grid") or {}).get(name)
        if own is not None:
            mine["grid"][name] = sorted({*own, *values})
    for name, values in (other.get("sequence") or {}).items():
        if len(values) > len((mine.get("sequence") or {}).get(name, values)):
            mine["sequence"][name] = values
    drawn, others = mine.get("monte_carlo"), other.get("monte_carlo")
    if drawn and others:
        drawn["runs"] = max(drawn["runs"], others["runs"])


def _more_runs(mine: list[dict[str, Any]], other: list[dict[str, Any]]) -> None:
    """Runs of scenarios that have their own."""
    theirs = {entry["name"]: entry.get("runs") for entry in other}
    for entry in mine:
        if entry.get("runs") and theirs.get(entry["name"]):
            entry["runs"] = max(entry["runs"], theirs[entry["name"]])
