"""Maps of detectability of synthetic campaigns whose thresholds are known."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest

from fddbench.errors import FddbenchError
from fddbench.interfaces import Detectability
from fddbench.metrics.detectable import DETECTABLE, summarize_detectable
from fddbench.results.schema import rows_schema
from fddbench.results.table import named

MAP = Detectability(
    site="fin", size="loss_percent", axes=("v_m_s", "altitude_m"), times="trim_deg", hatch_below=2.0
)  # fmt: skip
PARAMETERS = ("v_m_s", "altitude_m", "trim_deg")


def frame(n=400, threshold_deg=lambda v: 0.5, **changes):
    """Rows of two detectors; a loss is found if loss times trim is above the threshold; the trim falls with speed."""
    rows = []
    for run in range(n):
        rng = np.random.default_rng(run)
        v, altitude, loss = rng.uniform(100, 200), rng.uniform(0, 1000), rng.uniform(5, 50)
        trim = -4.0 + 3.0 * (v - 100.0) / 100.0
        found = loss / 100.0 * -trim > threshold_deg(v)
        who = {"scenario": "loss", "manoeuvre": "level", "fault": "effectiveness", "point": 0, "level": 0, "run": run}
        who |= {
            "status": "ok",
            "flight_s": 30.0,
            "n_faulty": 1,
            "faulty_sites": "fin",
            "onset_s": 10.0,
            "watched": True,
        }
        who |= {"p_v_m_s": v, "p_altitude_m": altitude, "p_trim_deg": trim, "f1_loss_percent": loss}
        time = {"detection_time_s": 2.0 if found else None, "detection_time_limit_s": 10.0}
        own = who | time | {"outcome": "right" if found else "missed", "detector": "good"} | changes
        blind = who | {"outcome": "missed", "detector": "blind", "detection_time_limit_s": 10.0}
        rows += [own, blind]
    table = pa.Table.from_pylist(rows, schema=rows_schema(PARAMETERS, ["f1_loss_percent"]))
    return named(table).to_pandas(types_mapper=pd.ArrowDtype)


def of(maps, detector):
    mine = maps[maps["detector"] == detector]
    return mine[mine["x_low"].isna()].iloc[0], mine[mine["x_low"].notna()]


def test_every_cell_finds_its_own_threshold():
    maps = summarize_detectable(frame(threshold_deg=lambda v: 0.25 if v < 150 else 0.5), [MAP])
    assert list(maps.columns) == DETECTABLE.names
    whole, cells = of(maps, "good")
    for line in cells.to_dict("records"):
        expected = 0.5 if line["x_low"] > 149 else 0.25
        if line["relation"] == "about" and (line["x_high"] < 151 or line["x_low"] > 149):
            assert line["smallest"] == pytest.approx(expected, abs=0.3)
            assert line["large_found_percent"] >= 90.0
    assert cells["flights"].sum() == whole["flights"] == 400
    assert cells["found"].sum() == whole["found"]
    small = cells["small"].to_numpy(dtype=bool)
    np.testing.assert_array_equal(small, cells["times_median"].to_numpy(dtype=float) < 2.0)
    assert 0 < small.sum() < len(small)


def test_a_blind_detector_finds_nothing_and_few_flights_say_nothing():
    whole, cells = of(summarize_detectable(frame(60), [MAP]), "blind")
    assert (whole["relation"], whole["found"], whole["large_found_percent"]) == ("above", 0, 0.0)
    _, cells = of(summarize_detectable(frame(25), [MAP]), "good")
    assert cells["smallest"].isna().all()
    assert cells["relation"].isna().all()
    assert cells["flights"].sum() == 25


def test_found_late_is_not_found_and_undecided_flights_do_not_count():
    late = frame(100, detection_time_s=10.01, outcome="late")
    assert of(summarize_detectable(late, [MAP]), "good")[0]["found"] == 0
    exactly = frame(100, detection_time_s=10.0, outcome="right")
    assert of(summarize_detectable(exactly, [MAP]), "good")[0]["found"] == 100
    early_alarm = frame(100, detection_time_s=1.0, outcome="false_alarm", false_alarm_time_s=1.0)
    assert of(summarize_detectable(early_alarm, [MAP]), "good")[0]["found"] == 100
    undecided = frame(100, detection_time_s=None, outcome="undecided")
    assert of(summarize_detectable(undecided, [MAP]), "good")[0]["flights"] == 0


@pytest.mark.parametrize(
    "changes",
    [
        {"status": "error"},
        {"faulty_sites": "rudder"},
        {"f1_loss_percent": None},
        {"watched": False},
        {"p_trim_deg": np.nan},
    ],
)
def test_what_is_not_on_the_map(changes):
    assert "good" not in set(summarize_detectable(frame(50, **changes), [MAP])["detector"])


def test_sizes_alone_and_other_maps():
    rows = frame(100)
    alone = replace(MAP, times="", hatch_below=0.0)
    line, cells = of(summarize_detectable(rows, [alone]), "good")
    assert 5.0 < line["smallest"] < 50.0  # percent, not multiplied
    assert not cells["small"].any()
    assert pd.isna(line["times"])
    assert summarize_detectable(rows, [replace(MAP, size="amplitude_deg")]).empty
    assert summarize_detectable(rows, []).empty
    with pytest.raises(FddbenchError, match=r"map of detectability of fin needs \['mach'\]"):
        summarize_detectable(rows, [replace(MAP, times="mach")])


def test_few_flights_that_are_drawn_are_no_grid():
    for n in (2, 8, 12):
        _, cells = of(summarize_detectable(frame(n), [MAP]), "good")
        assert cells["flights"].tolist() == [n]


def test_a_grid_has_a_cell_for_each_of_its_values():
    rows = frame(200)
    rows["point"] = rows["run"].to_numpy(dtype=int) % 3
    rows["p_v_m_s"] = np.array([110.0, 120.0, 150.0])[rows["point"]]
    rows["p_altitude_m"] = 5.0
    _, cells = of(summarize_detectable(rows, [MAP]), "good")
    ends = [(line["x_low"], line["x_high"]) for line in cells.to_dict("records")]
    assert ends == [(105.0, 115.0), (115.0, 135.0), (135.0, 165.0)]
    assert cells["flights"].tolist() == [67, 67, 66]
