"""What belongs together: the fingerprint of a campaign and of the program that flies it, by parts that have names."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from hashlib import sha256
from typing import Any

__all__ = ["Fingerprint", "differences"]

_MOST = 6
"""Names of one sort that a message shows."""


@dataclass(frozen=True, kw_only=True)
class Fingerprint:
    """Everything that decides rows, as the folder of results keeps it.

    Attributes
    ----------
    campaign_sha256 : str
        Of what the campaign means.
    files : mapping of str to str
        Sha256 of the designs and of the files that plug-ins stand on, by their names in the folder of results.
    schema_version : str
        Of the tables.
    fddbench : str
        Version of this package.
    libraries : mapping of str to str
        Versions of what else decides bits: numpy, llvmlite, packages that plug-ins come from or import.
    source : mapping of str to str
        Sha256 of source: the rooms of this package, and foreign packages.
    """

    campaign_sha256: str
    files: Mapping[str, str]
    schema_version: str
    fddbench: str
    libraries: Mapping[str, str]
    source: Mapping[str, str]

    @property
    def sha256(self) -> str:
        """Name of the fingerprint: every shard carries it."""
        return sha256(json.dumps(self.parts(), sort_keys=True).encode()).hexdigest()

    def parts(self) -> dict[str, Any]:
        """Plain data, as it stands in provenance.json."""
        return {name: dict(value) if isinstance(value, Mapping) else value for name, value in vars(self).items()}

    @classmethod
    def of(cls, provenance: Mapping[str, Any]) -> "Fingerprint":
        """Fingerprint that stands in a provenance.

        Raises
        ------
        KeyError, TypeError, ValueError
            Its parts are not there, or are something else.
        """
        return cls(
            campaign_sha256=str(provenance["campaign_sha256"]),
            files=dict(provenance["files"]),
            schema_version=str(provenance["schema_version"]),
            fddbench=str(provenance["fddbench"]),
            libraries=dict(provenance["libraries"]),
            source=dict(provenance["source"]),
        )


def differences(there: Fingerprint, here: Fingerprint) -> tuple[str, ...]:
    """What differs, in words, what is nearest to the reader first; nothing for equal fingerprints.

    Examples
    --------
    >>> a = Fingerprint(campaign_sha256="", files={}, schema_version="1", fddbench="0.1.0", libraries={}, source={})
    >>> differences(a, Fingerprint(**{**a.parts(), "libraries": {"numpy": "2.4.1"}, "source": {"fddbench/voting": "a"}}))
    ('numpy: none there, 2.4.1 here', 'other source code of fddbench/voting')
    """
    told = [*_files(there.files, here.files)]
    if there.campaign_sha256 != here.campaign_sha256 and not told:  # the files are a part of the campaign
        told = ["the campaign says something else"]
    return (*told, *_program(there, here))


def _program(there: Fingerprint, here: Fingerprint) -> Iterator[str]:
    """Differences of what flies the campaign."""
    if there.fddbench != here.fddbench:
        yield f"the program: fddbench {there.fddbench} there, {here.fddbench} here"
    if there.schema_version != here.schema_version:
        yield f"the tables: schema version {there.schema_version} there, {here.schema_version} here"
    for name in _changed(there.libraries, here.libraries):
        yield f"{name}: {there.libraries.get(name, 'none')} there, {here.libraries.get(name, 'none')} here"
    changed = _changed(there.source, here.source)
    if changed:
        yield f"other source code of {_listed(changed)}"


def _files(there: Mapping[str, str], here: Mapping[str, str]) -> Iterator[str]:
    changed = _changed(there, here)
    for say, names in (
        ("is not the same", [name for name in changed if name in there and name in here]),
        ("is there and not here", [name for name in changed if name not in here]),
        ("is here and not there", [name for name in changed if name not in there]),
    ):
        if names:
            yield f"the file{'s' if len(names) > 1 else ''} {_listed(names)} {say if len(names) == 1 else _plural(say)}"


def _plural(say: str) -> str:
    return say.replace("is ", "are ", 1)


def _listed(names: list[str]) -> str:
    return ", ".join(names[:_MOST]) + (f" and {len(names) - _MOST} more" if len(names) > _MOST else "")


def _changed(there: Mapping[str, str], here: Mapping[str, str]) -> list[str]:
    return sorted(name for name in {*there, *here} if there.get(name) != here.get(name))
