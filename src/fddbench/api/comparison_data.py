"""Gathers what the page of several folders of results shows."""

from collections.abc import Sequence
from pathlib import Path

from fddbench.api.as_written import campaign_as_written, in_sample_as_written, voted_as_written
from fddbench.api.comparing import compare
from fddbench.api.findings import voted_only
from fddbench.campaign.meaning import Campaign
from fddbench.campaign.rules.model import CampaignFile
from fddbench.errors import FddbenchError, UntrustedError
from fddbench.metrics.alarms import summarize_alarms
from fddbench.reporting.page.answer import answer
from fddbench.reporting.page.columns import NEEDS, Columns
from fddbench.reporting.page.comparison import ComparedFolder, Comparison
from fddbench.reporting.page.ranking import ranking, second_beside_best
from fddbench.reporting.page.ranks import rank_lines
from fddbench.results.kept import kept_of
from fddbench.results.table import read_rows
from fddbench.results.whole import holdings
from fddbench.runner.fingerprint import frozen

__all__ = ["comparison_data"]


def comparison_data(folders: Sequence[Path]) -> Comparison:
    """Each folder by itself, and every other one beside the first on the flights that both hold.

    Raises
    ------
    FddbenchError
        One is no folder of results, or is damaged.
    """
    own = [_folder(path) for path in folders]
    tables, reasons = [], []
    for path in folders[1:]:
        try:
            tables.append((path.as_posix(), compare(folders[0], path)))
        except FddbenchError as error:
            reasons.append(str(error))
    return Comparison(folders=own, tables=tables, reasons=reasons)


def _folder(path: Path) -> ComparedFolder:
    campaign, own, voted = _campaign(path)
    found, kept, rows = holdings(path), kept_of(path), read_rows(path, list(NEEDS), fair=True)
    columns = Columns(rows)
    short = "; ".join(filter(None, [found.sentence if found.partial else "", f"only {kept.first}" if kept else ""]))
    ranks = ranking(columns, summarize_alarms(rows, in_sample=own), in_sample=own, voted=voted)
    return ComparedFolder(
        folder=path.as_posix(), campaign=campaign.name, about=campaign.about, partial=short,
        answer=answer(ranks, second_beside_best(columns, ranks)), ranks=rank_lines(ranks),
    )  # fmt: skip


def _campaign(path: Path) -> tuple[Campaign | CampaignFile, tuple[str, ...], tuple[str, ...]]:
    """The campaign, detectors that were tuned on its flights, and those that see the voted signal; nobody else's code runs."""
    try:
        campaign = frozen(path)
    except UntrustedError:
        return campaign_as_written(path), in_sample_as_written(path), voted_as_written(path)
    return campaign, campaign.in_sample, voted_only(campaign)
