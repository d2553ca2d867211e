"""The one table's schema: every column, its type and what it says; null means none, NaN never."""

from collections.abc import Sequence

import pyarrow as pa

from fddbench.interfaces import Consequence
from fddbench.units import unit_of_name

__all__ = ["CASE", "EVENTS", "FAILED", "OUTCOMES", "SCHEMA_VERSION", "STATUSES", "Explained", "rows_schema"]

SCHEMA_VERSION = "2"
STATUSES = ("ok", "infeasible", "error", "nonfinite", "memory", "timeout", "crashed")
FAILED = frozenset(STATUSES[2:])
"""Statuses of rows that should have been scored."""
OUTCOMES = ("false_alarm", "wrong_site", "right", "late", "missed", "undecided")
"""Of a faulty flight, the first that holds; a healthy one is quiet or false_alarm."""


class Explained(dict[str, str]):
    """What columns say, by name. pandas copies the attributes of a table deeply at every step; these are shared."""

    def __deepcopy__(self, memo: object) -> "Explained":
        return self


def _column(name: str, kind: pa.DataType, about: str, *, nullable: bool = True) -> pa.Field:
    return pa.field(name, kind, nullable=nullable, metadata={"about": about})


CASE = _column("case", pa.string(), "name of the flight, scenario/point/level/run, made of these when rows are read")
"""Column that no file holds."""

_WHO = [
    _column("scenario", pa.string(), "name of the scenario", nullable=False),
    _column("manoeuvre", pa.string(), "what the aircraft flies", nullable=False),
    _column("fault", pa.string(), "kinds of the faults joined by +; null: healthy flight"),
    _column("point", pa.int64(), "number of the grid and sequence values, the same in every scenario", nullable=False),
    _column("level", pa.int64(), "number of the values that the scenario sweeps; 0 without a sweep", nullable=False),
    _column(
        "run", pa.int64(), "number of the Monte-Carlo draws, the same air and noise in every scenario", nullable=False
    ),
    _column("detector", pa.string(), "name of the design", nullable=False),
    _column("status", pa.string(), "ok or why there is no score: " + ", ".join(STATUSES[1:]), nullable=False),
    _column("reason", pa.string(), "what stands behind a status other than ok"),
    _column("flight_s", pa.float64(), "last sample that was scored [s]"),
    _column(
        "departed_s", pa.float64(), "sample at which the flight left the limits of its model [s]; null: it did not"
    ),
]
_OUTCOME = (
    "faulty flight, the first that holds: false_alarm (an alarm before the onset), wrong_site (a site declared that has not "
    "been faulty), right (found in time), late (found), missed (not found, and the limit, the fault or the aircraft is gone), "
    "undecided; healthy flight: quiet or false_alarm"
)
_BIAS = "mean of estimate minus what the fault really adds, from 1 s after the detection to the end of the fault"
_RMS = "root of the mean square of the same difference"
_SCORES = [
    _column("outcome", pa.string(), _OUTCOME),
    _column("n_faulty", pa.int64(), "faulty sites", nullable=False),
    _column("faulty_sites", pa.string(), "their names joined by +, in site order; null: none"),
    _column("onset_s", pa.float64(), "first faulty sample [s]; null: healthy flight"),
    _column("watched", pa.bool_(), "the detector watches all faulty sites; null: healthy flight"),
    _column("n_declared", pa.int64(), "sites declared at the end; 0 for a detector that only detects"),
    _column("declared_sites", pa.string(), "their names joined by +, in site order; null: none"),
    _column("false_alarm_time_s", pa.float64(), "from the start to the first alarm before the onset [s]; null: none"),
    _column("alarm_time_s", pa.float64(), "from the onset to the first alarm raised since [s]; null: none"),
    _column("detection_time_s", pa.float64(), "from the onset to when the last fault was found [s]; null: not found"),
    _column(
        "wrong_site_time_s", pa.float64(), "from the onset to the first site declared that has not been faulty [s]"
    ),
    _column("detection_time_limit_s", pa.float64(), "requirement, counted from the onset [s]; null: healthy flight"),
    _column("normalized_detection_time", pa.float64(), "detection time over its limit [-]; null: not found"),
    _column("isolated", pa.bool_(), "declared sites at the end = faulty sites; null: healthy, or only detects"),
    _column("over_declared", pa.bool_(), "more sites declared than have been faulty, at any sample since the onset"),
    _column("changes", pa.int64(), "how often the declaration (or the alarm) changed since the onset; 1 is clean"),
    _column(
        "estimate_bias",
        pa.float64(),
        f"{_BIAS}, in the unit of the site; null: no estimate, not found, or faults in two units",
    ),
    _column("estimate_rms", pa.float64(), f"{_RMS}; null: no estimate, or not found"),
    _column("margin_healthy", pa.float64(), "largest residual over threshold before the onset [-]"),
    _column("margin_faulty", pa.float64(), "largest residual over threshold from the onset on [-]; null: healthy"),
]

EVENTS = pa.schema(
    [
        *[field for field in _WHO if field.name not in ("manoeuvre", "fault", "flight_s", "departed_s")],
        _column("event", pa.int64(), "number of the fault in its scenario, from 1", nullable=False),
        _column("fault", pa.string(), "kind of the fault", nullable=False),
        _column("sites", pa.string(), "its sites joined by +", nullable=False),
        _column("onset_s", pa.float64(), "its first faulty sample [s]", nullable=False),
        _column("end_s", pa.float64(), "its first healthy sample again [s]; null: never"),
        _column(
            "outcome", pa.string(), "right, late, missed, undecided by its own onset, end and limit, or declared_before"
        ),
        _column("detection_time_s", pa.float64(), "from its onset to when it was found [s]; null: not found"),
        _column("detection_time_limit_s", pa.float64(), "requirement, counted from its onset [s]"),
        _column("normalized_detection_time", pa.float64(), "detection time over its limit [-]; null: not found"),
        _column("estimate_bias", pa.float64(), f"{_BIAS}; null: no estimate, or not found"),
        _column("estimate_rms", pa.float64(), f"{_RMS}; null: no estimate, or not found"),
    ],
    metadata={"fddbench_schema": SCHEMA_VERSION},
)


def rows_schema(
    parameters: Sequence[str],
    varied: Sequence[str] = (),
    gains: Sequence[str] = (),
    consequences: Sequence[Consequence] = (),
) -> pa.Schema:
    """Schema of the rows of a benchmark with these parameters (columns ``p_<name>``) and consequences of faults.

    `varied` are the columns of what differs between the faults of flights, ``f1_amplitude_percent``; `gains` those of gains of
    detectors that are swept, ``gain_threshold_deg_s``, and of factors on gains, ``factor_thresholds``.
    """
    faults = [_column(name, pa.float64(), _of_fault(name)) for name in varied]
    own = [_column(f"p_{name}", pa.float64(), "true value of the parameter", nullable=False) for name in parameters]
    swept = [_column(name, pa.float64(), _of_gain(name)) for name in gains]
    lasting = [field for each in consequences for field in _of_consequence(each)]
    return pa.schema([*_WHO, *_SCORES, *lasting, *swept, *faults, *own], metadata={"fddbench_schema": SCHEMA_VERSION})


def _of_consequence(each: Consequence) -> list[pa.Field]:
    unit = f"[{unit_of_name(each.name) or '-'}]"
    twin = "the healthy twin, the flight of the same point, run and manoeuvre without faults and detectors"
    none = "null: healthy flight, or no twin"
    if each.how == "error":
        about = f"{each.about} at the last scored sample minus that of {twin} {unit}; {none}"
    elif each.how == "rise":
        about = f"mean {each.about} from the onset on over that of {twin}, minus one {unit}; {none}"
    else:
        about = f"largest absolute {each.about} from the onset on {unit}; of a healthy flight from its start"
        same = _column(f"healthy_{each.name}", pa.float64(), f"the same of {twin}; {none}")
        return [_column(each.name, pa.float64(), about), same]
    return [_column(each.name, pa.float64(), about)]


def _of_gain(column: str) -> str:
    what, _, key = column.partition("_")
    value = f"factor on {key} [-]" if what == "factor" else key
    return f"{value} of this detector, a gain that the campaign sweeps; null: as its design says"


def _of_fault(column: str) -> str:
    number, _, key = column.removeprefix("f").partition("_")
    return f"{key} of fault {number} as it was flown; null: this scenario does not vary it"
