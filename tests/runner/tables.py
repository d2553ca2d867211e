"""What two folders of results have in common when nothing was lost: one hash of both tables, sorted, every bit of them."""

import hashlib
from pathlib import Path

import pandas as pd

import fddbench


def digest(folder: Path | str) -> str:
    """Hash of the rows and of the events in a folder, whatever order they were flown in."""
    found = hashlib.sha256()
    for table in (fddbench.load(folder), fddbench.load_events(folder)):
        found.update(_bits(table).encode())
    return found.hexdigest()


def _bits(table: pd.DataFrame) -> str:
    """One line a row, floats with all their bits, in alphabetical order."""
    lines = (
        ",".join(value.hex() if isinstance(value, float) else str(value) for value in row)
        for row in table.astype(object).itertuples(index=False)
    )
    return "\n".join([",".join(table.columns), *sorted(lines)])
