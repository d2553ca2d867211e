"""What a campaign found, as a short text to keep beside it."""

from pathlib import Path

import pandas as pd

from fddbench.api.tables import alarms, load
from fddbench.campaign.meaning import Campaign
from fddbench.campaign.rules.model import CampaignFile
from fddbench.errors import ResultsError
from fddbench.reporting.finding import finding_text
from fddbench.reporting.labels import of_a_fault
from fddbench.results.folder import provenance_of
from fddbench.results.kept import kept_of
from fddbench.results.whole import require_whole
from fddbench.runner.fingerprint import frozen

__all__ = ["finding", "swept_columns", "voted_only"]


def finding(folder: str | Path) -> str:
    """At most ten lines of Markdown: what the campaign asks, and what its rows answer.

    Every number is counted from the rows by the same rules for every campaign (`fddbench.reporting.finding`).

    Parameters
    ----------
    folder : str or Path
        Folder of results.

    Raises
    ------
    ResultsError
        No folder of results, a damaged one, or one that lacks flights.
    """
    path = Path(folder)
    require_whole(path)
    if kept_of(path) is not None:
        raise ResultsError(
            f"{path} keeps a part of its rows, and a finding is written of all; fly it with --set keep=all into another folder"
        )
    campaign, rows = frozen(path), load(path)
    swept = swept_columns(rows, campaign)
    provenance = provenance_of(path)
    return finding_text(
        rows,
        alarms(path),
        title=campaign.name,
        question=_question(campaign),
        swept=swept,
        in_sample=campaign.in_sample,
        apart=voted_only(campaign),
        footer=(
            f"<!-- seed {campaign.seed}, campaign {campaign.sha256[:16]}, fddbench {provenance['fddbench']}; written by "
            f"`fddbench finding` -->"
        ),
    )


def swept_columns(rows: pd.DataFrame, campaign: Campaign | CampaignFile) -> list[str]:
    """Columns of the rows that hold what the grid or a sweep of a fault varies, of those that differ."""
    return [str(name) for name in rows.columns if _swept(str(name), campaign) and rows[name].nunique() > 1]


def _swept(name: str, campaign: Campaign | CampaignFile) -> bool:
    """Whether a column holds what the grid or a sweep of a fault varies."""
    return name.removeprefix("p_") in campaign.dispersions.grid or of_a_fault(name)


def _question(campaign: Campaign) -> str:
    """What a campaign asks: its `about` to the last question mark, or the whole of it."""
    text = " ".join(campaign.about.split())
    return text[: text.rindex("?") + 1] if "?" in text else text


def voted_only(campaign: Campaign) -> tuple[str, ...]:
    """Detectors whose kind says that it sees the voted signal alone."""
    return tuple(d.name for d in campaign.designs if getattr(d.kind.member, "sees", "sensors") == "voted")
