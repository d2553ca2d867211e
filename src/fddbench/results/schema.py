"""The one table's schema: every column, its type and what it says; null means none, NaN never."""

from collections.abc import Sequence

import pyarrow as pa

__all__ = ["EVENTS", "SCHEMA_VERSION", "STATUSES", "rows_schema"]

SCHEMA_VERSION = "1"
STATUSES = ("ok", "infeasible", "diverged", "error", "nonfinite", "memory", "timeout", "crashed")


def _column(name: str, kind: pa.DataType, about: str, *, nullable: bool = True) -> pa.Field:
    return pa.field(name, kind, nullable=nullable, metadata={"about": about})


_WHO = [
    _column("case", pa.int64(), "position in the case table; the same flight for every detector", nullable=False),
    _column("scenario", pa.string(), "name of the scenario", nullable=False),
    _column("manoeuvre", pa.string(), "what the aircraft flies", nullable=False),
    _column("fault", pa.string(), "kinds of the faults joined by +; null: healthy flight"),
    _column("run", pa.int64(), "number of the dispersed flight within its scenario", nullable=False),
    _column("detector", pa.string(), "name of the design", nullable=False),
    _column("status", pa.string(), "ok or why there is no score: " + ", ".join(STATUSES[1:]), nullable=False),
    _column("reason", pa.string(), "what stands behind a status other than ok"),
    _column("flight_s", pa.float64(), "length of the flight that was scored [s]"),
]
_SCORES = [
    _column("n_faulty", pa.int64(), "faulty sites", nullable=False),
    _column("faulty_sites", pa.string(), "their names joined by +; null: none"),
    _column("onset_s", pa.float64(), "first faulty sample [s]; null: healthy flight"),
    _column("n_declared", pa.int64(), "sites declared at the end of scoring"),
    _column("declared_sites", pa.string(), "their names joined by +; null: none"),
    _column("first_alarm_time_s", pa.float64(), "from the onset to the first sample with n > 0 [s]; null: none"),
    _column("detection_time_s", pa.float64(), "from the onset to the first sample with n = n_faulty [s]; null: none"),
    _column("detection_time_limit_s", pa.float64(), "requirement [s]"),
    _column("normalized_detection_time", pa.float64(), "detection time over its limit [-]; null: none"),
    _column("detected", pa.bool_(), "a first alarm exists"),
    _column("classified", pa.bool_(), "n at the end = n_faulty"),
    _column("isolated", pa.bool_(), "declared sites at the end = faulty sites"),
    _column("false_isolation", pa.bool_(), "a healthy site is declared at the end"),
    _column("over_declared", pa.bool_(), "n > n_faulty at any faulty sample"),
    _column("missed", pa.bool_(), "no detection, or one beyond the limit; null: censored"),
    _column("censored", pa.bool_(), "the flight ended before the limit without detection"),
    _column("false_alarm", pa.bool_(), "n > 0 before the onset, in a healthy flight at any sample"),
    _column("margin_healthy", pa.float64(), "largest residual over threshold before the onset [-]"),
    _column("margin_faulty", pa.float64(), "largest residual over threshold from the onset on [-]; null: healthy"),
]

EVENTS = pa.schema(
    [
        *[field for field in _WHO if field.name not in ("manoeuvre", "fault", "flight_s")],
        _column("event", pa.int64(), "number of the fault in its scenario, from 1", nullable=False),
        _column("fault", pa.string(), "kind of the fault", nullable=False),
        _column("sites", pa.string(), "its sites joined by +", nullable=False),
        _column("onset_s", pa.float64(), "its first faulty sample [s]", nullable=False),
        _column("end_s", pa.float64(), "its first healthy sample again [s]; null: never"),
        _column("first_alarm_time_s", pa.float64(), "from its onset to the first own site declared [s]; null: none"),
        _column("detection_time_s", pa.float64(), "from its onset to all own sites declared [s]; null: none"),
        _column("detection_time_limit_s", pa.float64(), "requirement [s]"),
        _column("normalized_detection_time", pa.float64(), "detection time over its limit [-]; null: none"),
        _column("detected", pa.bool_(), "a first alarm on own sites exists"),
        _column("missed", pa.bool_(), "no detection, or one beyond the limit; null: censored"),
        _column("censored", pa.bool_(), "fault or flight ended before the limit without detection"),
        _column("false_alarm", pa.bool_(), "an own site declared before this fault began"),
    ],
    metadata={"fddbench_schema": SCHEMA_VERSION},
)


def rows_schema(parameters: Sequence[str]) -> pa.Schema:
    """Schema of the rows of a benchmark with these parameters (columns ``p_<name>``)."""
    own = [_column(f"p_{name}", pa.float64(), "true value of the parameter", nullable=False) for name in parameters]
    return pa.schema([*_WHO, *_SCORES, *own], metadata={"fddbench_schema": SCHEMA_VERSION})
