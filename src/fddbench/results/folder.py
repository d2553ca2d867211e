"""A folder of results: opened for one campaign and one program, refused to any other."""

import json
from collections.abc import Mapping
from difflib import unified_diff
from hashlib import sha256
from pathlib import Path
from typing import Any

from fddbench.errors import ResultsError
from fddbench.results import manifest, ours, trust
from fddbench.results.fingerprint import Fingerprint, differences
from fddbench.results.ours import RESERVED
from fddbench.results.schema import SCHEMA_VERSION
from fddbench.results.shards import file_sha256, write_bytes

__all__ = ["RESERVED", "changed_files", "claim", "grow", "provenance_of", "put_back", "refuse_foreign"]

_PROVENANCE = "provenance.json"
_YAML = "campaign.yaml"
_MOST_LINES = 12


def claim(folder: Path, *, files: Mapping[str, bytes], provenance: Mapping[str, Any], fresh: bool) -> bool:
    """Make a folder this campaign's and program's; True when it already was and the work continues.

    Parameters
    ----------
    folder : Path
        Where the results go; it is there.
    files : mapping of str to bytes
        Frozen campaign, designs and what they stand on, by their names in the folder.
    provenance : mapping
        Written once, at the beginning; the fingerprint in it decides whose folder it is.
    fresh : bool
        Throw away what an earlier run left.

    Raises
    ------
    ResultsError
        The folder holds results of another campaign or program (the difference is told) or files that are not fddbench's.
    """
    refuse_foreign(folder, fresh=fresh)
    trust.remember(trust.code_digest(provenance["files"]))  # who flies it here has chosen its code
    if (folder / _PROVENANCE).is_file() and not fresh:
        there = _read(folder)
        _require_same(folder, there, provenance, files)
        _put_back(folder, there, files)
        return True
    ours.clear(folder, _carried(folder) or ())
    # in this order: what has no provenance is not ours, and what has one has a manifest
    manifest.keep(folder, ())
    _write(folder, provenance)
    _put_back(folder, provenance, files)
    return False


def grow(folder: Path, *, files: Mapping[str, bytes], provenance: Mapping[str, Any]) -> None:
    """Make a folder one of a campaign that has more flights or detectors; what it holds stays.

    Parameters
    ----------
    folder : Path
        Folder of results, locked.
    files : mapping of str to bytes
        Frozen files of the campaign of today; those that were there keep their content, but for campaign.yaml.
    provenance : mapping
        Of today, with the fingerprints and stages of before.
    """
    trust.remember(trust.code_digest(provenance["files"]))
    for name, content in files.items():
        if name != _YAML and file_sha256(folder / name) != provenance["files"].get(name):
            write_bytes(folder / name, content)
    # a crash between these two leaves the campaign of the stage before, which whoever extends again knows
    _write(folder, provenance)
    write_bytes(folder / _YAML, files[_YAML])


def put_back(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write the frozen files of a folder that are missing or not as they were."""
    _put_back(folder, _read(folder), files)


def refuse_foreign(folder: Path, *, fresh: bool = False) -> None:
    """Do nothing to a folder that is missing, empty or of results; see `fddbench.results.ours.refuse_foreign`.

    Raises
    ------
    ResultsError
        Writing into it could harm what is not fddbench's.
    """
    ours.refuse_foreign(folder, _carried(folder), fresh=fresh)


def provenance_of(folder: Path) -> dict[str, Any]:
    """What is known of how the results came to be.

    Raises
    ------
    ResultsError
        The folder is missing or is not one of results, or its provenance is not as it was written.
    """
    found, path = _read(folder), folder / _PROVENANCE
    if found["schema_version"] != SCHEMA_VERSION:
        raise ResultsError(
            f"{path} is of schema version {found['schema_version']}, this fddbench reads {SCHEMA_VERSION}; read it with "
            f"fddbench {found['fddbench']}, or fly the campaign anew with --fresh"
        )
    if Fingerprint.of(found).sha256 not in found["fingerprints"]:
        raise ResultsError(
            f"{path} is not as it was written: its parts do not make its fingerprint. Put it back, or fly the campaign anew "
            "with --fresh"
        )
    return found


def changed_files(folder: Path) -> list[str]:
    """Frozen files that are missing or not as they were written."""
    return [name for name, digest in _frozen(_read(folder)).items() if file_sha256(folder / name) != digest]


def _frozen(provenance: Mapping[str, Any]) -> dict[str, str]:
    """Sha256 by name of everything that is frozen in a folder."""
    return {_YAML: provenance["campaign_yaml_sha256"], **provenance["files"]}


def _read(folder: Path) -> dict[str, Any]:
    """Provenance as it stands there."""
    path = folder / _PROVENANCE
    if not path.is_file():
        raise ResultsError(
            f"{folder} is no folder of results: it has no provenance.json; name one that `fddbench run` wrote"
        )
    try:
        found = json.loads(path.read_bytes())
        Fingerprint.of(found)
        sound = isinstance(found["fingerprints"], list) and isinstance(found["designs_sha256"], dict)
        sound = sound and all(isinstance(n, int) and n >= 0 for n in dict(found["flights"]).values())
        sound = sound and isinstance(found["campaign_yaml_sha256"], str)
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        reason = f"{error} is missing; an older fddbench wrote it?" if isinstance(error, KeyError) else str(error)
        raise ResultsError(
            f"{path} cannot be read ({reason}); put it back, or fly the campaign anew with --fresh"
        ) from error
    if not sound:
        raise ResultsError(f"{path} is no provenance of fddbench; put it back, or fly the campaign anew with --fresh")
    return dict(found)


def _carried(folder: Path) -> list[str] | None:
    """Names of the frozen files of a folder, whichever fddbench wrote it; None when they are not known."""
    try:
        found = json.loads((folder / _PROVENANCE).read_bytes())
        return [_YAML, *dict(found["files"])] if "campaign_sha256" in found else None
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None


def _write(folder: Path, provenance: Mapping[str, Any]) -> None:
    write_bytes(folder / _PROVENANCE, json.dumps(dict(provenance), indent=2).encode())


def _put_back(folder: Path, there: Mapping[str, Any], files: Mapping[str, bytes]) -> None:
    """Write the frozen files that are missing or not as they were, and a campaign that says the same in other words."""
    for name, content in files.items():
        listed, digest = _frozen(there).get(name), sha256(content).hexdigest()
        if file_sha256(folder / name) != listed or (name == _YAML and digest != listed):
            write_bytes(folder / name, content)
            if digest != listed and name == _YAML:  # about, report and requirements decide no row
                _write(folder, dict(there) | {"campaign_yaml_sha256": digest})


def _require_same(folder: Path, there: Mapping[str, Any], here: Mapping[str, Any], files: Mapping[str, bytes]) -> None:
    """Refuse to mix what does not belong together.

    Raises
    ------
    ResultsError
        The campaign or the program is another one.
    """
    was, now = Fingerprint.of(there), Fingerprint.of(here)
    told = [f"  {line}" for line in differences(was, now)]
    if was.campaign_sha256 != now.campaign_sha256:
        told += _diff(folder, files)
    if not told and {was.sha256, now.sha256} <= set(there["fingerprints"]):
        return
    told = told or ["  the list of fingerprints in provenance.json is not as it was written"]
    whose = "another campaign" if was.campaign_sha256 != now.campaign_sha256 else "another program"
    raise ResultsError(
        f"{folder} holds results of {whose}:\n" + "\n".join(told) + "\n"
        "They do not belong together. Name another folder with --out, or replace the results with --fresh."
    )


def _diff(folder: Path, files: Mapping[str, bytes]) -> list[str]:
    """Lines of the first text that differs, the campaign first."""
    for name, content in sorted(files.items(), key=lambda item: item[0] != _YAML):
        path = folder / name
        before = path.read_bytes().decode("utf-8", "replace").splitlines() if path.is_file() else []
        after = content.decode("utf-8", "replace").splitlines()
        lines = [
            f"  {line}" for line in unified_diff(before, after, "there", "here", n=0, lineterm="") if line[:3] != "@@ "
        ]
        if lines and name.endswith((".yaml", ".py")):
            return lines[:_MOST_LINES]
    return []
