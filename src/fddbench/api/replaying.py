"""One flight again: its signals as a table, as a file, as a picture."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from fddbench.api.flights import campaign_of, signals
from fddbench.errors import FddbenchError
from fddbench.interfaces import Recording

if TYPE_CHECKING:
    from fddbench.campaign.meaning import Campaign

__all__ = ["FORMATS", "replay", "require_format", "shown_in", "table_of", "write_table"]


def replay(source: "Campaign | str | Path", case: str, detectors: Sequence[str] = ()) -> Recording:
    """Recording of one flight, flown again bit for bit.

    Parameters
    ----------
    source : Campaign, str or Path
        A campaign, its file or name, or a folder of results.
    case : str
        Its name as in the column ``case``, ``"jam_a/3/0/17"``.
    detectors : sequence of str
        What to show of detectors: these alone; all by default.

    Raises
    ------
    FddbenchError
        There is no such flight or detector, or it cannot be flown.
    """
    found = signals(source, case)
    unknown = [name for name in detectors if name not in found.detectors]
    if unknown:
        raise FddbenchError(
            f"no detector of this campaign is called {unknown[0]!r}; known: {', '.join(found.detectors)}"
        )
    if not detectors:
        return found
    kept: dict[str, Mapping[str, Any]] = {name: found.detectors[name] for name in detectors}
    declared = {name: found.declared[name] for name in detectors}
    return Recording(
        scenario=found.scenario, cases=found.cases, time_s=found.time_s, onset_s=found.onset_s, signals=found.signals,
        detectors=kept, declared=declared, errors={name: found.errors[name] for name in detectors if name in found.errors},
    )  # fmt: skip


def table_of(recording: Recording, position: int = 0) -> pd.DataFrame:
    """Signals of one flight of a recording, a row a sample: time, signals, and ``DETECTOR.NAME`` of what detectors show.

    ``DETECTOR.declared_SITE`` is 1 where a site is declared. After the end of a flight that departed all but time is null.

    >>> table_of(signals("smoke", "jam_b/0/0/3")).columns[:2].tolist()
    ['time_s', 'phi_deg']
    """
    columns = {"time_s": recording.time_s} | {name: rows[:, position] for name, rows in recording.signals.items()}
    for detector, shown in recording.detectors.items():
        columns |= {f"{detector}.{name}": rows[:, position] for name, rows in shown.items()}
        declared = recording.declared.get(detector, {})
        columns |= {f"{detector}.declared_{site}": rows[:, position] for site, rows in declared.items()}
    table = pd.DataFrame(columns)
    return table.astype("float64[pyarrow]").where(table.notna())


def _csv(table: pd.DataFrame, path: Path, about: str) -> None:
    del about
    table.to_csv(path, index=False)


def _parquet(table: pd.DataFrame, path: Path, about: str) -> None:
    import pyarrow as pa
    from pyarrow import parquet

    own = pa.Table.from_pandas(table, preserve_index=False)
    parquet.write_table(own.replace_schema_metadata({"about": about}), path)


def _mat(table: pd.DataFrame, path: Path, about: str) -> None:
    """For MATLAB: ``flight`` is a struct of columns; a dot of a name becomes two underscores, and NaN stands for null."""
    from scipy.io import savemat

    columns = {name.replace(".", "__"): values for name, values in _floats(table).items()}
    long = [name for name in columns if len(name) > _MATLAB_NAME]
    if long:
        raise FddbenchError(
            f"MATLAB allows names of {_MATLAB_NAME} characters, {long[0]} has {len(long[0])}; give the design a shorter "
            "name, choose another --detector, or write .csv, .parquet or .h5"
        )
    savemat(path, {"flight": columns, "about": about}, long_field_names=True)


def _h5(table: pd.DataFrame, path: Path, about: str) -> None:
    """A data set a column, NaN for null, and ``about`` as an attribute."""
    try:
        import h5py
    except ImportError as error:
        raise FddbenchError(
            ".h5 needs h5py: pip install 'fddbench[h5]'; or write .csv, .parquet or .mat instead"
        ) from error
    with h5py.File(path, "w") as file:
        file.attrs["about"] = about
        for name, values in _floats(table).items():
            file.create_dataset(name, data=values)


_MATLAB_NAME = 63
FORMATS: Mapping[str, Callable[[pd.DataFrame, Path, str], None]] = {
    ".csv": _csv, ".parquet": _parquet, ".mat": _mat, ".h5": _h5,
}  # fmt: skip
"""What a flight can be written as, by the end of the file's name."""


def _floats(table: pd.DataFrame) -> dict[str, Any]:
    return {str(name): table[name].to_numpy(dtype=np.float64, na_value=np.nan) for name in table.columns}


def write_table(recording: Recording, path: Path) -> None:
    """Write the signals of the first flight of a recording; the end of the file's name says as what.

    Raises
    ------
    FddbenchError
        Another ending, or the file cannot be written.
    """
    require_format(path)
    about = f"flight {recording.cases[0]}, flown again by fddbench"
    try:
        FORMATS[path.suffix](table_of(recording), path, about)
    except OSError as error:
        raise FddbenchError(f"cannot write {path}: {error.strerror or error}; name another file with --to") from error


def require_format(path: Path) -> None:
    """Refuse a file whose name does not end as one of `FORMATS`."""
    if path.suffix not in FORMATS:
        raise FddbenchError(f"{path}: cannot tell the format from the name; let it end in {', '.join(FORMATS)}")


def shown_in(source: "Campaign | str | Path") -> tuple[str, ...]:
    """Signals that the pictures of a campaign's benchmark show."""
    return campaign_of(source).shown
