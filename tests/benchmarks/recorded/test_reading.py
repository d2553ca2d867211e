"""Contract: what is wrong with a log is told with its place and its cure; what is right comes in to the last bit."""

import numpy as np
import pandas as pd
import pytest
from tests.benchmarks.recorded import ulog

from fddbench.benchmarks.recorded.mapping import TimeOf
from fddbench.benchmarks.recorded.reading import open_log
from fddbench.errors import FddbenchError

GOOD = "# a header\n# of two lines\ntime_s, r_deg_s,note\n0,1.5,a\n0.01,0.1,b\n0.02,-1e-3,\n"

WRONG = {
    "text": ("time_s,r_deg_s\n0,1\n1,abc\n2,3\n", r"x.csv:3: r_deg_s is 'abc', it must be a number; .*1 of 3 rows"),
    "comma": ('time_s,r_deg_s\n0,"1,5"\n1,2\n', r"x.csv:2: r_deg_s is '1,5'.*written with a point"),
    "empty_cell": (
        "# h\ntime_s,r_deg_s\n0,1\n1,\n2,3\n",
        r"x.csv:4: r_deg_s is empty or not-a-number; .*missing: skip",
    ),
    "infinite": ("time_s,r_deg_s\n0,1\n1,inf\n2,3\n", r"x.csv:3: r_deg_s is infinite; remove the row"),
    "backwards": ("time_s,r_deg_s\n0,1\n2,2\n1,3\n", r"x.csv:4: time_s = 1 s lies before .* 2; sort the rows"),
    "twice": ("time_s,r_deg_s\n0,1\n1,2\n1,3\n", r"x.csv:4: time_s = 1 s is there twice; leave each time once"),
    "no_time": ("time_s,r_deg_s\n0,1\n,2\n1,3\n", r"x.csv:3: time_s is empty or not-a-number; remove the row"),
    "column": ("time_s,r_deg\n0,1\n1,2\n", r"x.csv: no column r_deg_s. Did you mean 'r_deg'\? It has time_s, r_deg"),
    "time_column": (
        "t,r_deg_s\n0,1\n1,2\n",
        r"x.csv: no column time_s \(the time; the mapping names another with `time",
    ),
    "no_rows": ("time_s,r_deg_s\n", r"x.csv: no rows; a log needs two or more"),
    "one_row": ("time_s,r_deg_s\n0,1\n", r"x.csv:2: r_deg_s has 1 usable rows; a channel needs two or more"),
    "empty": ("", r"x.csv: empty; a log has a line of names"),
    "semicolons": ("time_s;r_deg_s\n0;1\n", r"x.csv:1: columns are separated by commas here"),
    "same_names": ("time_s,r_deg_s,r_deg_s\n0,1,2\n1,2,3\n", r"x.csv: the column r_deg_s is there twice; rename one"),
    "binary": (b"\x00\xff\xfe\x01", r"x.csv: cannot be read as csv: UnicodeDecodeError"),
}


@pytest.mark.parametrize("which", WRONG)
def test_a_wrong_table_is_refused_with_place_and_cure(tmp_path, which):
    content, message = WRONG[which]
    path = tmp_path / "x.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(FddbenchError, match=message):
        open_log(path, TimeOf()).series("r_deg_s", "refuse")


def test_a_table_comes_in_to_the_last_bit_as_csv_and_parquet(tmp_path):
    values = np.random.default_rng(3).normal(size=50)
    table = pd.DataFrame({"stamp_ms": np.arange(50) * 20, "a": values})
    table.to_csv(tmp_path / "a.csv", index=False)
    table.to_parquet(tmp_path / "a.parquet")
    for name in ("a.csv", "a.parquet"):
        found = open_log(tmp_path / name, TimeOf(column="stamp_ms", unit="ms")).series("a", "refuse")
        assert found.values.tobytes() == values.tobytes()
        np.testing.assert_allclose(found.time_s, np.arange(50) * 0.02, atol=1e-12)


def test_a_header_is_left_out_and_rows_without_a_value_can_be_skipped(tmp_path):
    (tmp_path / "x.csv").write_text(GOOD)
    assert open_log(tmp_path / "x.csv", TimeOf()).series("r_deg_s", "refuse").values.tolist() == [1.5, 0.1, -1e-3]
    (tmp_path / "y.csv").write_text("time_s,a\n0,1\n1,\n2,nan\n3,4\n")
    found = open_log(tmp_path / "y.csv", TimeOf()).series("a", "skip")
    assert (found.time_s.tolist(), found.values.tolist(), found.skipped) == ([0.0, 3.0], [1.0, 4.0], 2)
    assert found.place(1).endswith("y.csv:5")


@pytest.fixture
def px4(tmp_path):
    """A log of two topics, one of them with two instances of other times."""
    pytest.importorskip("pyulog")
    first = [(1_000_000 + 10_000 * k, 0.5 * k, -0.25, float(k)) for k in range(5)]
    second = [[(1_000_000 + 20_000 * k + 5_000 * j, 0.125 * k + j) for k in range(4)] for j in range(2)]
    topics = {
        "vehicle_angular_velocity": ([("float[3]", "xyz")], [first]),
        "sensor_gyro": ([("float", "z")], second),
    }
    return ulog.write(tmp_path / "flight.ulg", 1_000_000, topics)


def test_channels_of_a_px4_log_are_topics_instances_and_fields(px4):
    log = open_log(px4, TimeOf())
    assert "sensor_gyro[1].z" in log.columns
    assert log.series("vehicle_angular_velocity.xyz[2]", "refuse").values.tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]
    other = log.series("sensor_gyro[1].z", "refuse")
    np.testing.assert_allclose(other.time_s, [0.005, 0.025, 0.045, 0.065])
    assert other.values.tolist() == [1.0, 1.125, 1.25, 1.375]
    for column, message in {
        "sensor_gyr.z": "no channel sensor_gyr.z. Did you mean 'sensor_gyro.z'. It has the topics sensor_gyro",
        "sensor_gyro.q": "sensor_gyro has z",
        "sensor_gyro[7].z": "sensor_gyro has the instances 0, 1",
        "z": "a channel of a ULog is called topic.field",
    }.items():
        with pytest.raises(FddbenchError, match=message.replace("[7]", r"\[7\]")):
            log.series(column, "refuse")


def test_what_is_no_px4_log_is_refused(px4, monkeypatch):
    broken = px4.parent / "no.ulg"
    broken.write_bytes(b"nothing of the kind")
    with pytest.raises(FddbenchError, match="no ULog: it does not begin as one"):
        open_log(broken, TimeOf())
    broken.write_bytes(px4.read_bytes()[:18])
    with pytest.raises(FddbenchError, match="no.ulg"):
        open_log(broken, TimeOf()).series("sensor_gyro.z", "refuse")
    monkeypatch.setitem(__import__("sys").modules, "pyulog", None)
    with pytest.raises(FddbenchError, match=r"logs of PX4 need pyulog: pip install 'fddbench\[ulog\]'"):
        open_log(px4, TimeOf())
