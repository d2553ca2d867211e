"""Where designs lie: beside a campaign, beside its folder, and as shipped."""

from pathlib import Path

from fddbench import gallery
from fddbench.errors import FddbenchError, did_you_mean

__all__ = ["find_design", "known_designs"]


def _folders(campaign_folder: Path) -> list[Path]:
    beside = [campaign_folder / "detectors", campaign_folder / ".." / "detectors"]
    try:
        # one's own detectors on a shipped campaign lie where one works
        here = [Path("detectors")] if campaign_folder.resolve() == gallery.folder("campaigns").resolve() else []
        return [*here, *beside, gallery.folder("detectors")]
    except FddbenchError:
        return beside


def known_designs(campaign_folder: Path) -> list[str]:
    """Names of all designs that a campaign in a folder can name, in alphabetical order."""
    return sorted({path.stem for folder in _folders(campaign_folder) for path in folder.glob("*.yaml")})


def find_design(name: str, campaign_folder: Path) -> Path:
    """File of a design: in ``detectors/`` beside the campaign, then beside its folder, then as shipped.

    Raises
    ------
    FddbenchError
        There is none; the message names the nearest known one and all that are not shipped.
    """
    for folder in _folders(campaign_folder):
        path = folder / f"{name}.yaml"
        if path.is_file() and path.resolve().is_relative_to(folder.resolve()):
            return path
    known = known_designs(campaign_folder)
    parts = [
        f"no design is called {name!r}.",
        did_you_mean(name, known),
        f"Known: {_in_words(known)}.",
        f"Designs are files: put yours at {_folders(campaign_folder)[0] / name}.yaml",
    ]
    raise FddbenchError(" ".join(filter(None, parts)))


def _in_words(known: list[str]) -> str:
    """Names of one's own, and where to read those that are shipped, in a line that can be read."""
    try:
        shipped = {path.stem for path in gallery.folder("detectors").glob("*.yaml")}
    except FddbenchError:
        shipped = set()
    named = [name for name in known if name not in shipped]
    if shipped:
        named.append(f"{len(shipped)} shipped designs (`fddbench list designs`)")
    return ", ".join(named) or "none"
