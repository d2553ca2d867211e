"""A workflow that judges what campaigns require at every push."""

import shlex
from pathlib import Path

from fddbench import __version__
from fddbench.campaign.finding import document_of
from fddbench.errors import FddbenchError

__all__ = ["write_workflow"]

_WORKFLOW = Path(".github/workflows/fddbench.yml")
_TEMPLATE = Path(__file__).parents[1] / "starters" / "workflow.yml.txt"


def write_workflow(folder: Path) -> Path:
    """Write a workflow of GitHub for the campaigns in a repository that require something.

    Parameters
    ----------
    folder : Path
        Root of the repository; its campaigns lie there or in ``campaigns/``.

    Returns
    -------
    Path
        The workflow, ``.github/workflows/fddbench.yml``.

    Raises
    ------
    FddbenchError
        There is no such campaign, the file is there already, or it cannot be written; then nothing is written.
    """
    paths = [path.relative_to(folder) for path in _campaigns(folder)]
    if not paths:
        raise FddbenchError(
            f"no campaign in {folder} or {folder / 'campaigns'} has requirements: to judge; write some into one, such as "
            "[{of: right_share, at_least: 0.95}]"
        )
    target = folder / _WORKFLOW
    if target.exists():
        raise FddbenchError(f"{target} is there already and is left alone; remove it to have it written anew")
    text = _TEMPLATE.read_text(encoding="utf-8").replace("VERSION", __version__)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(
            text.replace("CAMPAIGNS", " ".join(shlex.quote(path.as_posix()) for path in paths)), encoding="utf-8"
        )
    except OSError as error:
        raise FddbenchError(f"cannot write {target}: {error.strerror}; name another folder") from error
    return target


def _campaigns(folder: Path) -> list[Path]:
    """Files that are campaigns with requirements, as far as one sees without reading them as such."""
    found = []
    for path in sorted([*folder.glob("*.yaml"), *folder.glob("campaigns/*.yaml")]):
        try:
            document = document_of(path)
        except FddbenchError:
            continue  # no campaign, or a broken one: `fddbench check` says what is wrong
        if document.get("benchmark") is not None and document.items("requirements"):
            found.append(path)
    return found
