"""More of a campaign that was flown: runs, grid values, scenarios, detectors; what is there keeps its bytes."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pandas as pd
import yaml

from fddbench.api.aside import aside, campaign_in
from fddbench.api.tables import leave_summary
from fddbench.campaign.meaning import Campaign
from fddbench.designs.design import Design, read_design
from fddbench.designs.finding import find_design
from fddbench.errors import FddbenchError, did_you_mean
from fddbench.runner.engines import Engine
from fddbench.runner.fingerprint import frozen, frozen_before
from fddbench.runner.growing import grow_to
from fddbench.runner.run import Progress, RunReport, run_campaign
from fddbench.runner.supervised.trial import read_safely

__all__ = ["extend"]


def extend(
    folder: str | Path,
    campaign: str | Path | None = None,
    *,
    runs: int | None = None,
    detectors: Sequence[str] = (),
    scenarios: Sequence[str] = (),
    jobs: int = 2,
    backend: str = "auto",
    engine: str = "auto",
    address: str | None = None,
    progress: Callable[[Progress], None] | None = None,
    notice: Callable[[str], None] | None = None,
    summarised: Callable[[pd.DataFrame, pd.DataFrame], None] | None = None,
) -> RunReport:
    """Fly what a larger campaign has more than a folder of results holds; its table is then that of the larger campaign.

    Rows that are there keep their bytes; numbers of points are those of the larger campaign when rows are read. An extension
    that was interrupted goes on when it is asked for again, or when the larger campaign is run on the folder.

    Parameters
    ----------
    folder : str or Path
        Folder of results.
    campaign : str or Path, optional
        Campaign file that says more than the one that was flown; by default that one.
    runs : int, optional
        Monte-Carlo runs that there are to be in all.
    detectors : sequence of str
        More detectors: names of designs in ``detectors/`` here or shipped, or paths of design files.
    scenarios : sequence of str
        Only these scenarios of `campaign`, beside those that were flown.
    jobs, backend, engine, address, progress, notice, summarised
        See `fddbench.run`.

    Raises
    ------
    FddbenchError
        Nothing to extend by, or rows that are there would not be rows of the larger campaign; the message says why.
    """
    path = Path(folder)
    if scenarios and campaign is None:
        raise FddbenchError("scenarios are those of a campaign: name its file too")
    if campaign is None and runs is None and not detectors:
        raise FddbenchError("nothing to extend by: give runs, detectors, or a campaign that says more")
    by = Engine(name=engine, jobs=jobs, address=address)
    old = frozen_before(path)
    with aside("the larger campaign") as written:
        grow_to(path, old, _larger(old, campaign, runs, detectors, scenarios, written))
    report = run_campaign(frozen(path), path, engine=by, backend=backend, progress=progress, notice=notice)
    if not report.interrupted:
        tables = leave_summary(path)
        if summarised is not None:
            summarised(*tables)
    return report


def _larger(
    old: Campaign,
    campaign: str | Path | None,
    runs: int | None,
    detectors: Sequence[str],
    scenarios: Sequence[str],
    written: Path,
) -> Campaign:
    """The campaign that the folder is to hold, written with everything it stands on into a folder of its own."""
    given = None if campaign is None else read_safely(Path(campaign))
    base = old if given is None or scenarios else given
    content: dict[str, Any] = yaml.safe_load(base.text)
    files = base.files()
    if given is not None and scenarios:
        content["scenarios"] = [*content["scenarios"], *_scenarios(given, scenarios)]
        files = {**given.beside, **files}
    if runs is not None:
        drawn = (content.get("dispersions") or {}).get("monte_carlo")
        if drawn is None:
            raise FddbenchError(
                f"campaign {base.name!r} draws nothing (it has no monte_carlo), so it has no runs to add"
            )
        drawn["runs"] = runs
    for design in map(_design, detectors):
        if design.base not in (entry if isinstance(entry, str) else entry["design"] for entry in content["detectors"]):
            content["detectors"] = [*content["detectors"], design.base]
        files[f"detectors/{design.base}.yaml"] = design.text.encode()
        files |= {f"detectors/{name}": text for name, text in design.files.items()}
    return campaign_in(written, content, files)


def _scenarios(given: Campaign, wanted: Sequence[str]) -> list[dict[str, Any]]:
    entries = {entry["name"]: entry for entry in yaml.safe_load(given.text)["scenarios"]}
    for name in wanted:
        if name not in entries:
            hint = did_you_mean(name, entries)
            parts = [f"{given.path} has no scenario {name!r}.", hint, f"It has: {', '.join(entries)}"]
            raise FddbenchError(" ".join(filter(None, parts)))
    return [entries[name] for name in wanted]


def _design(name: str) -> Design:
    path = Path(name)
    if path.suffix != ".yaml":
        return read_design(find_design(name, Path()))
    if not path.is_file():
        raise FddbenchError(f"no file {path}; name a design, or the file of one")
    return read_design(path)
