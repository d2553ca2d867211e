"""A campaign that nobody wrote: made of others, read from a folder of its own."""

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from fddbench.campaign.load import read_campaign
from fddbench.campaign.meaning import Campaign
from fddbench.campaign.reading.canonical import canonical_text
from fddbench.errors import FddbenchError

__all__ = ["aside", "campaign_in"]


@contextmanager
def aside(what: str) -> Iterator[Path]:
    """Folder for a campaign that nobody has seen; what is refused meanwhile speaks of `what`, not of places in that folder.

    Parameters
    ----------
    what : str
        What the campaign is called, "the larger campaign".

    Raises
    ------
    FddbenchError
        Whatever was refused.
    """
    with TemporaryDirectory() as name:
        try:
            yield Path(name)
        except FddbenchError as error:
            # lines of a design are those of its author
            text = re.sub(re.escape(f"{name}/campaign.yaml") + r"(:\d+:\d+)?", what, str(error))
            text = text.replace(f"{name}/", f"{what}, ")
            if text == str(error):
                raise
            raise FddbenchError(text) from None


def campaign_in(folder: Path, content: Mapping[str, Any], files: Mapping[str, bytes]) -> Campaign:
    """Campaign of a document and the files that it stands on, by their names beside it, written into an empty folder.

    Raises
    ------
    CampaignError
        It cannot be read.
    """
    for name, text in {**files, "campaign.yaml": canonical_text(content).encode()}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(text)
    return read_campaign(folder / "campaign.yaml")
