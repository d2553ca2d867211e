"""Where a campaign lies: as given, or shipped under that bare name; and its document."""

from pathlib import Path

from fddbench import gallery
from fddbench.campaign.reading.document import Document, refuse
from fddbench.campaign.reading.yaml_nodes import read_yaml
from fddbench.campaign.rules.wording import shown
from fddbench.errors import CampaignError, FddbenchError, Mistake, did_you_mean

__all__ = ["document_of", "find_campaign"]


def find_campaign(path: Path) -> Path:
    """File of a campaign: as given, or a shipped one of that bare name.

    Raises
    ------
    CampaignError
        There is none.
    """
    if path.is_file():
        return path
    try:
        shipped = {file.stem: file for file in gallery.folder("campaigns").glob("*.yaml")}
    except FddbenchError:
        shipped = {}
    bare = path.name.removesuffix(".yaml")
    if path.parent == Path() and bare in shipped:
        return shipped[bare]
    what = _folder(path) if path.is_dir() else "no such file."
    hint = "" if path.is_dir() else did_you_mean(bare, shipped)
    names = f"{len(shipped)} campaigns are shipped (`fddbench list campaigns`)"
    raise CampaignError((Mistake(str(path), " ".join(filter(None, [what, hint, "" if path.is_dir() else names]))),))


def _folder(path: Path) -> str:
    """What to give instead of a folder."""
    if (path / "campaign.yaml").is_file():
        return "is a folder; give the campaign.yaml in it"
    return "is a folder, with no results of `fddbench run` and no campaign.yaml in it; give the file of a campaign"


def document_of(path: Path) -> Document:
    """Document of a campaign file.

    Raises
    ------
    CampaignError
        It is empty, or no mapping of keys.
    """
    document = read_yaml(path)
    if document.data is None:
        refuse(
            [
                document.mistake(
                    (), "the file is empty; a campaign starts with name, benchmark, seed, scenarios, detectors"
                )
            ]
        )
    if not isinstance(document.data, dict):
        message = f"a campaign is a mapping of keys (name, benchmark, seed, …), got {shown(document.data)}"
        refuse([document.mistake((), message)])
    return document
