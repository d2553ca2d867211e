"""What a run does with a folder that it goes on with: what is damaged is no longer listed, so that it is flown again."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fddbench.errors import ResultsError
from fddbench.results import manifest, ours
from fddbench.results.manifest import Shard
from fddbench.results.shards import file_sha256
from fddbench.results.stages import Numbering

__all__ = ["mend"]


def mend(folder: Path, *, provenance: Mapping[str, Any]) -> tuple[tuple[Shard, ...], tuple[str, ...]]:
    """Keep what is sound on the list of a folder: the shards of it, and in words what was lost.

    No table is deleted; the flights of one that is not listed any more are flown again, to the same rows.

    Parameters
    ----------
    folder : Path
        Folder of results, claimed by the run.
    provenance : mapping
        Of the folder: what shards may carry, and its case table.

    Raises
    ------
    ResultsError
        There is no list, or it has sound shards of another campaign or program.
    """
    ours.sweep(folder)
    found = manifest.survey(folder)
    if any(shard.fingerprint not in provenance["fingerprints"] for shard in found.shards):
        raise ResultsError(
            f"{folder} lists shards of another campaign or program; name another folder with --out, or replace the "
            "results with --fresh"
        )
    lost, kept, numbering = list(found.wrong), list[Shard](), Numbering(provenance)
    for shard in found.shards:
        reason = _wrong(folder, shard, numbering)
        if reason:
            lost.append(reason)
        else:
            kept.append(shard)
    manifest.keep(folder, kept)
    return tuple(kept), tuple(lost)


def _wrong(folder: Path, shard: Shard, numbering: Numbering) -> str:
    """What is wrong with a shard, "" for nothing."""
    for name, sha256 in shard.files:
        if file_sha256(folder / name) != sha256:
            return f"{name} is damaged or gone"
    try:
        numbering.numbers(shard)
    except ResultsError:
        return f"{shard.rows} holds flights beyond the case table"
    return ""
