"""Parts of one campaign that were flown by one program, put together shard by shard: their files are copied as they are."""

from collections.abc import Iterator, Sequence
from hashlib import sha256
from pathlib import Path

from fddbench.errors import ResultsError
from fddbench.results import manifest
from fddbench.results.manifest import Shard
from fddbench.results.shards import write_bytes

__all__ = ["joinable", "joined"]


def joinable(parts: Sequence[Path], fingerprint: str) -> bool:
    """Whether the shards of some folders are all of one campaign and program, and none has a row that another has."""
    numbers = dict[tuple[str, ...], set[int]]()
    for shard in (shard for path in parts for shard in manifest.shards(path)):
        taken = numbers.setdefault(shard.detectors, set())
        if shard.fingerprint != fingerprint or taken & shard.numbers:
            return False
        taken |= shard.numbers
    # rows of all detectors and rows of some: who tells which are there twice reads them
    return len(numbers) < 2


def joined(folder: Path, parts: Sequence[Path]) -> Iterator[Shard]:
    """Copy the shards of some folders into a folder, one by one; each as it is to be listed there.

    Raises
    ------
    ResultsError
        A file was changed since it was found sound.
    """
    for path in parts:
        for shard in manifest.shards(path):
            for name, written in shard.files:
                data = (path / name).read_bytes()
                if sha256(data).hexdigest() != written:
                    raise ResultsError(f"{path / name} was changed meanwhile; merge again into another folder")
                write_bytes(folder / name, data)
            yield shard
