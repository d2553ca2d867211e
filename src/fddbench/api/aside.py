"""A campaign that nobody wrote: made of others, read from a folder of its own."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fddbench.campaign.load import read_campaign
from fddbench.campaign.meaning import Campaign
from fddbench.campaign.reading.canonical import canonical_text
from fddbench.errors import CampaignError, FddbenchError

__all__ = ["campaign_aside"]


def campaign_aside(content: Mapping[str, Any], files: Mapping[str, bytes], aside: Path, what: str) -> Campaign:
    """Campaign of a document and the files that it stands on, written into an empty folder and read there.

    Parameters
    ----------
    content : mapping
        The document.
    files : mapping of str to bytes
        Designs and plug-ins by their names beside it.
    aside : Path
        Where to.
    what : str
        What it is called where it is wrong: its places are those of a file that nobody has seen.

    Raises
    ------
    FddbenchError
        It cannot be read.
    """
    for name, text in {**files, "campaign.yaml": canonical_text(content).encode()}.items():
        (aside / name).parent.mkdir(parents=True, exist_ok=True)
        (aside / name).write_bytes(text)
    try:
        return read_campaign(aside / "campaign.yaml")
    except CampaignError as error:
        raise FddbenchError(str(error).replace(f"{aside}/", f"{what}, ")) from error
