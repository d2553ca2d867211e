"""What faults do to the aircraft on the page: each flight once, sizes without sign, the healthy twins beside peaks."""

import pandas as pd

from fddbench.interfaces import Consequence
from fddbench.reporting.consequences import consequence_heads, consequence_lines

ANNOUNCED = (
    Consequence(name="peak_bank_deg", signal="phi_true_deg", how="peak", about="bank angle"),
    Consequence(name="track_error_m", signal="y_m", how="error", about="lateral position"),
)


def rows():
    flights = {
        "scenario": ["healthy", "jam", "jam", "jam"], "manoeuvre": "cruise", "point": 0, "level": 0, "run": [0, 0, 1, 2],
        "n_faulty": [0, 1, 1, 1], "status": "ok", "peak_bank_deg": [0.1, 2.0, 3.0, 40.0],
        "healthy_peak_bank_deg": [None, 0.1, 0.2, 0.3], "track_error_m": [None, -500.0, 100.0, None],
    }  # fmt: skip
    one = pd.DataFrame(flights)
    return pd.concat([one.assign(detector="a"), one.assign(detector="b")]).convert_dtypes(dtype_backend="pyarrow")


def test_a_line_a_faulty_scenario_each_flight_once():
    (line,) = consequence_lines(rows(), ANNOUNCED)
    assert [cell.text for cell in line] == ["jam", "3", "3", "300"]
    assert [cell.small for cell in line] == ["cruise", "", "max 40, healthy 0.2", "max 500"]
    assert consequence_heads(ANNOUNCED) == ("scenario", "flights", "peak bank [deg]", "track error [m]")


def test_nothing_is_said_where_nothing_is_known():
    assert consequence_lines(rows().drop(columns="peak_bank_deg"), ANNOUNCED) == []
    assert consequence_lines(rows(), ()) == []
    assert consequence_lines(rows().iloc[:1], ANNOUNCED) == []
