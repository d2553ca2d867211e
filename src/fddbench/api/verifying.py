"""Whether a folder of results is what it says: everything in it looked at, and some flights flown again."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pyarrow as pa

from fddbench.errors import FddbenchError
from fddbench.results.folder import provenance_of
from fddbench.results.inspection import wrong_with
from fddbench.results.kept import kept_of
from fddbench.results.manifest import shards
from fddbench.results.stages import Numbering
from fddbench.results.table import read_rows
from fddbench.runner.assembling import assemble
from fddbench.runner.fingerprint import frozen, other_program
from fddbench.runner.flight import Flyer
from fddbench.runner.rehearsal import rehearsed
from fddbench.runner.rows import rows_and_events

__all__ = ["Verified", "verify"]

_AT_ONCE = 256


@dataclass(kw_only=True)
class Verified:
    """What was found.

    Attributes
    ----------
    wrong : list of str
        What is damaged, missing or foreign, in words.
    flights, rows : int
        Flown again, and how many rows these have.
    different : list of str
        Rows that came out otherwise: flight, detector and the columns.
    other_program : str
        What differs between this program and the one that flew the results; "" for nothing.
    """

    wrong: list[str] = field(default_factory=list)
    flights: int = 0
    rows: int = 0
    different: list[str] = field(default_factory=list)
    other_program: str = ""

    @property
    def sound(self) -> bool:
        """Whether nothing is wrong and nothing came out otherwise."""
        return not self.wrong and not self.different


def verify(
    folder: str | Path, *, refly: int = 0, seed: int | None = None, notice: Callable[[str], None] | None = None
) -> Verified:
    """Look at everything in a folder of results, and fly some of its flights again to the same bits.

    Parameters
    ----------
    folder : str or Path
        Folder of results, one's own or somebody else's; it is not written to. Flying again runs its plug-ins.
    refly : int
        How many flights, drawn at random from those it holds (of ``keep: sample`` from those whose rows it keeps); all of them
        where there are fewer.
    seed : int, optional
        Of that draw; another one every time by default.

    Raises
    ------
    FddbenchError
        It is no folder of results, or its campaign cannot be read by this program.
    """
    path = Path(folder)
    if refly < 0:
        raise FddbenchError(f"refly = {refly}: how many flights, 0 or more")
    found = Verified(wrong=list(wrong_with(path)))
    if not refly or found.wrong:
        return found
    campaign = frozen(path)
    found.other_program = other_program(path, campaign)
    numbering = Numbering(provenance_of(path))
    held = np.flatnonzero(numbering.held(shards(path)).all(axis=0))
    flyer = rehearsed(Flyer(assemble(campaign)), notice)
    there, keeps = read_rows(path), kept_of(path)
    if keeps is not None and not keeps.failures:  # of the other runs there is nothing to compare with
        held = held[flyer.assembly.plan.locate(held).run < keeps.runs]
    chosen = np.sort(np.random.default_rng(seed).choice(held, min(refly, len(held)), replace=False))
    for first in range(0, len(chosen), _AT_ONCE):
        some = chosen[first : first + _AT_ONCE]
        again, events = rows_and_events(flyer, some)
        again = again if keeps is None else keeps.thinned(again, events)[0]
        names = flyer.assembly.plan.names(some)
        kept = pa.Table.from_pandas(there[there["case"].isin(list(names))], preserve_index=False)
        found.different += _different(kept, again)
        found.flights, found.rows = found.flights + len(some), found.rows + len(again)
    return found


def _different(kept: pa.Table, again: pa.Table) -> list[str]:
    """Rows that are not the same bits, in words."""
    address = ("scenario", "point", "level", "run", "detector")
    ours = {tuple(row[name] for name in address): row for row in again.to_pylist()}
    told = []
    for row in kept.to_pylist():
        other = ours.pop(tuple(row[name] for name in address), None)
        where = f"{row['case']}, {row['detector']}"
        if other is None:
            told.append(f"{where}: not flown by this campaign")
            continue
        columns = [name for name in other if not _same(row.get(name), other[name])]
        if columns:
            values = ", ".join(f"{name} {row.get(name)!r} there, {other[name]!r} here" for name in columns[:3])
            told.append(f"{where}: {values}{f' and {len(columns) - 3} columns more' if len(columns) > 3 else ''}")
    return told + [f"{'/'.join(map(str, key[:4]))}, {key[4]}: not in the folder" for key in ours]


def _same(one: object, other: object) -> bool:
    """Whether two cells are the same, floats to the last bit."""
    if isinstance(one, float) and isinstance(other, float):
        return one.hex() == other.hex()
    return one == other
