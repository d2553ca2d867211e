"""Reads what a folder counts of all its rows, where it does not keep all."""

from pathlib import Path

import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc

from fddbench.results.folder import provenance_of
from fddbench.results.shards import open_table, read_columns
from fddbench.results.stages import Numbering
from fddbench.results.table import as_of_today, files, without_rows
from fddbench.results.tallies import TALLIES, added

__all__ = ["read_tallies"]


def read_tallies(folder: Path) -> pd.DataFrame:
    """Tally of all rows of a folder, scenarios and detectors in the order of its campaign; columns of `TALLIES`.

    Raises
    ------
    ResultsError
        As `fddbench.results.table.load`.
    """
    provenance, found = provenance_of(folder), list[pa.Table]()
    numbering = Numbering(provenance)
    for path, sha256, fingerprint in files(folder, "tallies"):
        file = open_table(path, sha256, schema=TALLIES, fingerprint=fingerprint)
        table = read_columns(path, file, TALLIES.names).cast(TALLIES)
        found.append(as_of_today(table, TALLIES.names, numbering.points_of(fingerprint)).cast(TALLIES))
    if not found:
        raise without_rows(folder)
    whole = added(found)
    order = {"scenario": list(provenance["flights"]), "detector": list(provenance["designs_sha256"])}
    for name, names in order.items():
        place = pc.index_in(whole[name], value_set=pa.array(names, pa.string()))
        whole = whole.append_column(f"{name}_place", place)
    keys = ["scenario_place", "point", "level", "detector_place"]
    ordered = whole.sort_by([(name, "ascending") for name in [*keys, "status", "outcome", "detection_time_s"]])
    frame: pd.DataFrame = ordered.select(TALLIES.names).to_pandas(types_mapper=pd.ArrowDtype)
    return frame
