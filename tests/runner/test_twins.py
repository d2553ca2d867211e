"""What faults do to the aircraft: the columns are those of recorded flights beside their healthy twins, whatever the cuts."""

import json

import numpy as np
import pandas as pd
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

import fddbench
from fddbench.blocks import llvm
from fddbench.campaign.load import read_campaign
from fddbench.errors import FddbenchError
from fddbench.interfaces import Consequence
from fddbench.metrics.consequences import Consequences
from fddbench.runner.assembling import assemble
from fddbench.runner.beside import beside
from fddbench.runner.chunks import cut
from fddbench.runner.flight import Flyer
from fddbench.runner.rows import rows_and_events
from fddbench.runner.twins import Kept, Pairs

ALL = Consequences(
    [
        Consequence(name="peak_a_deg", signal="a", how="peak", about="a"),
        Consequence(name="error_b_m", signal="b", how="error", about="b"),
        Consequence(name="rise_a_percent", signal="a", how="rise", about="a"),
    ],
    ["a", "b"],
)


@settings(max_examples=60)
@given(st.data())
def test_what_is_kept_of_a_twin_is_that_of_its_samples(data):
    n_time, n_twins, n = data.draw(st.integers(1, 12)), data.draw(st.integers(1, 3)), data.draw(st.integers(1, 4))
    rng = np.random.default_rng(data.draw(st.integers(0, 99)))
    a, b = rng.normal(size=(2, n_time, n_twins))
    end = np.array([data.draw(st.integers(0, n_time - 1)) for _ in range(n)], dtype=float)
    begin = np.array([data.draw(st.integers(0, int(last))) for last in end], dtype=float)
    twin = np.array([data.draw(st.integers(0, n_twins - 1)) for _ in range(n)])
    pairs = Pairs(which=np.arange(n), twin=twin, begin=begin, end=end, cases=np.arange(n_twins))
    kept, width = Kept(ALL, pairs), data.draw(st.integers(1, 12))
    for first in range(0, n_time, width):
        kept.feed(first, {"a": a[first : first + width], "b": b[first : first + width]})
    x = ALL.states.unpack(kept.rows(n, np.ones(n, dtype=bool)))
    for i in range(n):
        lasting = a[int(begin[i]) : int(end[i]) + 1, twin[i]]
        assert x.peaks[0][i] == np.abs(lasting).max()
        assert x.ends[0][i] == b[int(end[i]), twin[i]]
        assert x.sums[0].total[i] - x.sums[0].before[i] == pytest.approx(lasting.sum(), abs=1e-12)


def test_the_block_keeps_what_a_recording_shows():
    rng = np.random.default_rng(4)
    a, b = rng.normal(size=(2, 20, 4))
    k0, last, departed = np.array([5.0, 0.0, np.inf, 8.0]), np.full(4, 17.0), np.array([np.inf, np.inf, np.inf, 12.0])
    x = ALL.states.spread(ALL.start(), 4)
    for k in range(20):
        x = ALL.step(x, {"a": a[k], "b": b[k]}, k0=k0, last=last, sample=float(k), alive=k < departed)
    for i, (begin, end) in enumerate([(5, 17), (0, 17), (0, 17), (8, 11)]):
        assert x.peaks[0][i] == np.abs(a[begin : end + 1, i]).max()
        assert x.ends[0][i] == b[end, i]
        assert x.sums[0].total[i] - x.sums[0].before[i] == pytest.approx(a[begin : end + 1, i].sum(), abs=1e-12)


def test_a_loop_that_announces_what_it_does_not_show_is_told():
    with pytest.raises(FddbenchError, match=r"signals out of \['a'\], got \['c'\]"):
        Consequences([Consequence(name="peak_c_deg", signal="c", how="peak", about="c")], ["a"])


JAM = {"kind": "jam", "sites": ["r1", "r2"], "onset_s": 1.0, "amplitude_deg_s": 4.0}
SCENARIOS = [
    {"name": "healthy", "manoeuvre": "cruise"},
    {"name": "jam", "manoeuvre": "cruise", "faults": [JAM]},
    {"name": "nothing", "manoeuvre": "cruise", "faults": [{**JAM, "amplitude_deg_s": 0.0}]},
    {"name": "drawn", "manoeuvre": "cruise", "faults": [{**JAM, "onset_s": {"uniform": [0.5, 2.5]}}]},
    {
        "name": "turn", "manoeuvre": "turn_coordination_2", "duration_s": 2.5,
        "faults": [{**JAM, "kind": "nrz", "sites": ["r1", "r3"]}],
    },
]  # fmt: skip


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    content = {
        "name": "twins", "benchmark": "yaw_rate", "wind": "light", "seed": 9, "duration_s": 3.0,
        "detectors": ["voting_monitor"], "scenarios": SCENARIOS,
        "dispersions": {"monte_carlo": {"runs": 2, "mass_kg": {"uniform": [180000, 220000]}}},
    }  # fmt: skip
    path = tmp_path_factory.mktemp("twins") / "twins.yaml"
    path.write_text(yaml.safe_dump(json.loads(json.dumps(content))))  # without aliases
    return path


@pytest.fixture(scope="module")
def assembly(path):
    return assemble(read_campaign(path))


def rows_of(assembly, backend="auto", chunk=100):
    flyer, n = Flyer(assembly, backend), assembly.plan.n_cases
    parts = [rows_and_events(flyer, part)[0] for part in np.array_split(np.arange(n), -(-n // chunk))]
    return pd.concat([part.to_pandas() for part in parts], ignore_index=True)


@pytest.fixture(scope="module")
def rows(assembly):
    return rows_of(assembly)


def test_columns_are_those_of_recorded_flights_beside_the_healthy_ones(assembly, rows):
    """Runs share air and noise, so the twin of a run in cruise is that of the healthy scenario."""
    names = [f"truth:{name}" for name in ("phi_true_deg", "beta_true_deg", "psi_deg", "y_m")]
    cases = np.flatnonzero(rows["manoeuvre"] == "cruise")
    recorded = Flyer(assembly).fly(assembly.batch(cases), names).recorded
    phi, beta, psi, y = (recorded[name][:, 0] for name in names)
    healthy = {run: i for i, run in enumerate(rows["run"][:2])}
    for i, row in rows.iloc[cases].iterrows():
        if row["scenario"] == "healthy":
            assert row["peak_bank_deg"] == np.abs(phi[:, i]).max()
            assert pd.isna(row["heading_error_deg"])
            assert pd.isna(row["healthy_peak_bank_deg"])
            continue
        twin, begin, end = healthy[row["run"]], round(row["onset_s"] / 0.01), round(row["flight_s"] / 0.01)
        counts = slice(begin, end + 1)
        assert row["peak_bank_deg"] == np.abs(phi[counts, i]).max()
        assert row["healthy_peak_sideslip_deg"] == np.abs(beta[counts, twin]).max()
        assert row["heading_error_deg"] == psi[end, i] - psi[end, twin]
        assert row["track_error_m"] == y[end, i] - y[end, twin]


def test_a_flight_that_departs_stands_beside_its_twin_up_to_there(assembly):
    cases = assembly.plan.numbers(["jam/0/0/0", "jam/0/0/1", "jam/0/0/1"])
    flyer, batch = Flyer(assembly), assembly.batch(cases)
    twin = assembly.batch(assembly.plan.numbers(["healthy/0/0/0", "healthy/0/0/1"]))
    psi = Flyer(assembly).fly(twin, ["truth:psi_deg"]).recorded["truth:psi_deg"][:, 0]
    kept = assembly.consequences.states.unpack(beside(flyer, batch, np.array([280.0, 90.0, 251.0])))
    assert kept.ends[0][[0, 2]].tolist() == [psi[279, 0], psi[250, 1]]
    assert np.isnan(kept.ends[0][1])  # gone before the onset


def test_a_fault_of_size_zero_does_nothing_to_the_aircraft(rows):
    nothing = rows[rows["scenario"] == "nothing"]
    assert (nothing["heading_error_deg"] == 0.0).all()
    assert (nothing["track_error_m"] == 0.0).all()
    assert (nothing["peak_bank_deg"] == nothing["healthy_peak_bank_deg"]).all()


@pytest.mark.parametrize("chunk", [1, 4])
def test_cuts_change_no_number(assembly, rows, chunk):
    pd.testing.assert_frame_equal(rows_of(assembly, chunk=chunk), rows)


@pytest.mark.skipif(not llvm.available(), reason="needs llvmlite")
def test_plain_numpy_gives_the_same_numbers(assembly, rows):
    pd.testing.assert_frame_equal(rows_of(assembly, "numpy"), rows)


def test_flights_that_share_a_twin_fly_together(assembly, path, tmp_path):
    chunks = cut(assembly.plan, np.arange(assembly.plan.n_cases), size=4, jobs=1)
    at = [assembly.plan.locate(chunk) for chunk in chunks]
    assert any(set(each.run.tolist()) == {0} and len(each.run) == 4 for each in at)
    fddbench.run(path, tmp_path / "results", jobs=1)
    explained = fddbench.load(tmp_path / "results").attrs["columns"]
    assert explained["heading_error_deg"].startswith("heading at the last scored sample minus that of the healthy twin")
    assert "[m]" in explained["track_error_m"]
