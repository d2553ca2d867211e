"""Contract: a detector that cannot be compiled sees one flight at a time, and no row depends on anything but its flight."""

import os
import shutil
import signal
import sys

import numpy as np
import pytest
from tests.runner import plugins
from tests.runner.plugins import CROSSTALK, MONITOR, PLAIN, SIDE_BY_SIDE, failing, write
from tests.runner.test_same_bits import bits

from fddbench import load
from fddbench.campaign.load import read_campaign
from fddbench.cli import main
from fddbench.designs.one_flight import flights_of
from fddbench.errors import CampaignError, DesignError, raise_interrupt
from fddbench.runner.assembling import assemble
from fddbench.runner.firsts import first_samples
from fddbench.runner.flight import Flyer
from fddbench.runner.rehearsal import rehearse
from fddbench.runner.rows import rows_and_events
from fddbench.runner.run import run_campaign
from fddbench.runner.supervised.processes import FlightProcess
from fddbench.testing import check_detector

ALL = {"plain": PLAIN, "side": SIDE_BY_SIDE, "monitor": MONITOR, "always": failing("raise ValueError('no')")}
MORE = ("voting_monitor", "cusum_example")


def assembled(folder, *bodies, more=()):
    """Assembly with one plug-in, or several."""
    return assemble(read_campaign(write(folder, {f"mine{i}": body for i, body in enumerate(bodies)}, more=more)))


def rows_of(assembly, backend="auto", cases=None):
    """Rows of all cases, or of some, as dictionaries."""
    chosen = np.arange(assembly.plan.n_cases) if cases is None else np.array(cases)
    return rows_and_events(Flyer(assembly, backend), chosen)[0].to_pylist()


@pytest.fixture(scope="module")
def reference(tmp_path_factory):
    folder = tmp_path_factory.mktemp("reference")
    campaign, told = read_campaign(write(folder, ALL, more=MORE)), []
    run_campaign(campaign, folder / "out", jobs=1, notice=told.append)
    return campaign, load(folder / "out"), told


@pytest.mark.parametrize(
    "options",
    [
        {"jobs": 2},
        {"jobs": 1, "chunk": 1},
        {"jobs": 1, "chunk": 7, "backend": "numpy"},
        {"jobs": 2, "chunk": 3, "backend": "numpy"},
        {"jobs": 1, "chunk": 64, "backend": "numpy"},
    ],
)
@pytest.mark.slow
def test_jobs_chunks_and_backends_change_no_row_of_an_opaque_detector(reference, tmp_path, options):
    run_campaign(reference[0], tmp_path / "out", **options)
    assert bits(load(tmp_path / "out")) == bits(reference[1])


def test_the_order_of_detectors_changes_no_row(reference, tmp_path):
    names = list(reversed([*ALL, *MORE]))
    path = write(tmp_path, ALL, text=plugins.TEXT.replace("NAMES", ", ".join(names)))
    run_campaign(read_campaign(path), tmp_path / "out", jobs=1)
    rows = load(tmp_path / "out")
    for name in names:
        mine, other = (frame[frame["detector"] == name].reset_index(drop=True) for frame in (rows, reference[1]))
        assert bits(mine) == bits(other)


def test_the_reference_has_what_it_claims(reference):
    _, rows, _ = reference
    found = {name: set(mine) for name, mine in rows.groupby("detector")["status"]}
    assert found == {name: {"error" if name == "always" else "ok"} for name in (*ALL, *MORE)}
    assert (rows[(rows["detector"] == "plain") & (rows["scenario"] == "jam")]["n_declared"] == 1).all()
    monitor = rows[rows["detector"] == "monitor"]
    assert set(monitor["n_declared"]) == {0}
    assert (monitor[monitor["scenario"] == "pair"]["margin_faulty"] > 1.0).all()


def test_ordinary_python_decides_as_the_same_detector_compiled(reference):
    _, rows, _ = reference
    scored = [name for name in rows.columns if name not in ("detector",)]
    plain, compiled = (rows[rows["detector"] == name][scored] for name in ("plain", "cusum_example"))
    assert bits(plain) == bits(compiled)


def test_the_user_is_told_once_what_flies_in_python(reference):
    told = "\n".join(reference[2])
    assert "plain cannot be compiled and flies in Python, one flight at a time: it has no `states`" in told
    assert "side cannot be compiled and flies in Python, many flights side by side: " in told
    assert told.count("always is given up: on each of the first 8 flights ValueError: no (always.py:") == 1
    assert "voting_monitor" not in told


def test_what_a_detector_of_one_flight_sees(tmp_path):
    assembly = assembled(tmp_path, PLAIN)
    measured = first_samples(assembly, 1, 3)[0]
    flights = list(flights_of(measured))
    assert len(flights) == 3
    for i, own in enumerate(flights):
        assert type(own.r_voted_deg_s) is float
        assert own.r_voted_deg_s == measured.r_voted_deg_s[i]
        assert own.r_deg_s.shape == (3,)
        np.testing.assert_array_equal(own.r_deg_s, measured.r_deg_s[:, i])
        with pytest.raises(ValueError, match="read-only"):
            own.r_deg_s[0] = 1.0
    assert not np.shares_memory(flights[0].r_deg_s, measured.r_deg_s)


# --- what is refused ---


@pytest.mark.parametrize("backend", ["auto", "numpy"])
def test_a_detector_whose_rows_depend_on_their_company_is_refused(tmp_path, backend):
    assembly = assembled(tmp_path, CROSSTALK, more=["voting_monitor"])
    with pytest.raises(DesignError, match=r"mine0 depends on its company: in case healthy/\d+/\d+/\d+ at sample \d+ its "
                       r"declaration of r1 is 1 beside 14 other flights and 0 alone"):  # fmt: skip
        rehearse(Flyer(assembly, backend))


MEMORIES = {
    "in itself": ("", "self.last = getattr(self, 'last', 0.0) + 1.0", "self.last"),
    "in its module": ("SEEN = []\n", "SEEN.append(1)", "float(len(SEEN))"),
    "in one state of all flights": ("STATE = [0.0]\n", "state[0] += 1.0", "state[0]"),
    "random numbers": ("", "", "random.random()"),
    "a clock": ("", "", "time.perf_counter()"),
    "what is to come": (
        "SEEN = {}\n",
        "own = SEEN.setdefault(measured.mass_kg, []); own.append(measured.r_deg_s[0])",
        "own[-1] + len(own)",
    ),
}


@pytest.mark.parametrize("where", MEMORIES)
def test_a_detector_that_keeps_something_outside_its_state_is_refused(tmp_path, where):
    head, keeps, residual = MEMORIES[where]
    body = f"""
{head}
class Mine(Base):
    def start(self):
        return {"STATE" if "STATE" in head else "[0.0]"}

    def step(self, state, measured):
        {keeps or "pass"}
        return state, Verdict([0, 0, 0], {residual})
"""
    assembly = assembled(tmp_path, body)
    with pytest.raises(
        DesignError, match=r"mine0 gives another verdict when a flight is flown again: in case healthy/0/0/0 at sample"
    ):
        rehearse(Flyer(assembly))
    with pytest.raises(AssertionError, match="gives another verdict when a flight is flown again"):
        check_detector_in(tmp_path)


def check_detector_in(folder):
    check_detector("mine0", campaign=folder / "opaque.yaml")


def test_a_refused_detector_leaves_results_alone(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    write(tmp_path, {"mine": PLAIN})
    assert main(["run", "opaque.yaml", "--quiet", "--jobs", "1", "--out", "out"]) == 0
    before = load("out")
    write(tmp_path, {"mine": CROSSTALK})
    assert main(["run", "opaque.yaml", "--quiet", "--jobs", "1", "--out", "out", "--fresh"]) == 2
    assert "fddbench: mine depends on its company" in capsys.readouterr().err
    assert load("out").equals(before)


@pytest.mark.parametrize("body", [PLAIN, SIDE_BY_SIDE, MONITOR])
def test_sound_detectors_pass(tmp_path, body):
    assembled(tmp_path, body)
    check_detector_in(tmp_path)


@pytest.mark.skipif(sys.platform != "linux", reason="kills a process")
def test_a_process_that_is_killed_from_outside_accuses_nobody(tmp_path, monkeypatch):
    """Without the new attempts in `_sound_company` it is said to keep something outside its state, or there is a traceback."""
    seen, killed, known = [], [], FlightProcess.step

    def step(self, message):
        if self.shape.n_cases > 1 and self not in seen:
            seen.append(self)  # 1st and 3rd: heard together, and heard together once more
            if len(seen) in (1, 3):
                killed.append(self.number)
                os.kill(self.number, signal.SIGKILL)
        return known(self, message)

    monkeypatch.setattr(FlightProcess, "step", step)
    assert rehearse(Flyer(assembled(tmp_path, PLAIN))) == {}
    assert len(killed) == 2


BUGS = {
    "misspelt signal": ("measured.r_deg_s)", "measured.rr_deg_s)", "no attribute 'rr_deg_s'. Measured are phi_deg, "),
    "no state": ("return state, ", "return ", "a step gives (state, Verdict), got Verdict"),
    "forgotten state": ("return state, ", "return None, ", "'NoneType' object is not subscriptable"),
    "too few sites": ('state["declared"],', 'state["declared"][:2],', "declared as a list of 3 real numbers, one a"),
    "one number": ('state["declared"],', "1.0,", "declared as a list of 3 real numbers, one a watched site, got float"),
    "residual of every site": ("worst / 2.0", "measured.r_deg_s", "residual as one real number, got ndarray of shape (3,)"),
    "complex": ("worst / 2.0", "worst + 1j", "residual as one real number, got complex"),
    "other signals": ('{"worst_deg_s"', '{"wurst"', "recorded announces ['worst_deg_s'], the verdict shows ['wurst']"),
}  # fmt: skip


@pytest.mark.parametrize("bug", BUGS)
def test_bugs_of_ordinary_python_are_told_before_anything_is_flown(tmp_path, bug):
    old, new, message = BUGS[bug]
    assert old in PLAIN
    with pytest.raises(CampaignError) as told:
        assembled(tmp_path, PLAIN.replace(old, new, 1 if bug != "forgotten state" else -1))
    assert message in str(told.value)
    assert "mine0.py:" in str(told.value)
    assert "It sees one flight at a time" in str(told.value)


def test_rows_code_without_batched_is_told_how_to_get_rows(tmp_path):
    with pytest.raises(CampaignError, match="say `batched = True` in it"):
        assembled(
            tmp_path,
            SIDE_BY_SIDE.replace(", batched", "")
            .replace("), True, (", "), (")
            .replace("axis=0)) - 0.1", "axis=0)[:1]) - 0.1"),
        )


# --- what is a row ---

WRONG = [
    ("raise SystemExit(3)", "SystemExit: 3"),
    ("raise GeneratorExit", "GeneratorExit"),
    ("raise KeyboardInterrupt", "KeyboardInterrupt"),
    ("raise MemoryError", "MemoryError"),
    ("self.step(state, measured)", "RecursionError: maximum recursion depth"),
    ("raise type('Odd', (BaseException,), {'__str__': lambda self: 1 / 0})", "Odd: (its text cannot be made)"),
    ("return state + 1, Verdict([0, 0, 1j], 0.0)", "needs declared as one real number, got complex"),
    ("return state + 1, Verdict(np.zeros(3, dtype=object), 0.0)", "of shape (3,) and dtype object"),
    ("return state + 1, Verdict([0, 0, 0], None)", "needs residual as one real number, got NoneType"),
    ("return state + 1, Verdict([0, 0, 0], 10**400)", "OverflowError"),
    ("return state + 1, Verdict([[0, 0, 0]], 0.0)", "declared as a list of 3 real numbers"),
    ("return state + 1, Verdict([0, 0, 0], [0.0])", "residual as one real number, got list of shape (1,)"),
    ("return state + 1", "a step gives (state, Verdict), got int"),
]


@pytest.mark.parametrize(("wrong", "reason"), WRONG)
def test_what_goes_wrong_in_flight_is_a_row_of_that_flight(tmp_path, wrong, reason):
    assembly = assembled(tmp_path, failing(wrong, "measured.mass_kg > 200e3"), PLAIN)
    for backend in ("auto", "numpy"):
        rows = rows_of(assembly, backend)
        for row in rows:
            heavy = row["p_mass_kg"] > 200e3 and row["detector"] == "mine0"
            assert row["status"] == ("error" if heavy else "ok")
            assert not heavy or reason in row["reason"]
        assert {row["status"] for row in rows if row["detector"] == "mine0"} == {"error", "ok"}
    assert rehearse(Flyer(assembly)) == {}


def test_a_verdict_of_neither_0_nor_1_is_nonfinite(tmp_path):
    assembly = assembled(tmp_path, failing("return state, Verdict([0, 0.5, 0], 0.0)"))
    assert {row["status"] for row in rows_of(assembly)} == {"nonfinite"}


@pytest.mark.parametrize(("kind", "odd"), [("complex", "x.sums[0] * 1j"), ("object", "x.sums[0].astype(object)")])
def test_rows_of_odd_numbers_are_an_error(tmp_path, kind, odd):
    body = SIDE_BY_SIDE.replace("worst / 2.0", f"({odd} if (worst > 1.0).any() else worst)")
    rows = rows_of(assembled(tmp_path, body), "numpy")
    assert {row["reason"] for row in rows if row["status"] == "error"} == {
        f"a verdict needs real numbers; residual is {kind}"[:200] + ("128" if kind == "complex" else "")
    }


def test_ctrl_c_of_the_user_is_no_error_of_a_detector():
    def interrupted():
        try:
            os.kill(os.getpid(), signal.SIGINT)
            for _ in range(10**7):
                pass
        except BaseException as error:
            raise_interrupt(error)

    with pytest.raises(KeyboardInterrupt):
        interrupted()


# --- what is given up ---


def test_a_detector_that_fails_always_is_given_up(reference):
    _, rows, _ = reference
    mine = rows[rows["detector"] == "always"].sort_values("case")["reason"].tolist()
    line = mine[0].removeprefix("ValueError: no ")
    assert line.startswith("(always.py:")
    assert (
        mine == [f"ValueError: no {line}"] * 8 + [f"given up: on each of the first 8 flights ValueError: no {line}"] * 7
    )


@pytest.mark.parametrize(
    ("wrong", "condition"),
    [
        ("raise ValueError('no')", "measured.mass_kg > 200e3"),
        ("return (1 / 0 if measured.mass_kg > 200e3 else\n                    int('x')), None", "True"),
    ],
)
def test_a_detector_that_fails_sometimes_or_otherwise_is_not(tmp_path, wrong, condition):
    assembly = assembled(tmp_path, failing(wrong, condition))
    assert rehearse(Flyer(assembly)) == {}


def test_the_texts_of_the_same_error_may_differ(tmp_path):
    assembly = assembled(tmp_path, failing("raise ValueError(f'{measured.mass_kg}')"))
    given = rehearse(Flyer(assembly))["mine0"]
    assert len({reason for _, reason in given.reasons}) > 1


def test_giving_up_takes_no_flights(tmp_path):
    """Eight flights of 21 samples instead of 15 of 300: the detector is stepped no further."""
    counts = tmp_path / "steps"
    body = failing("raise ValueError('no')").replace(
        "        if state > 20",
        f"        with open({str(counts)!r}, 'a') as f:\n            f.write('.')\n        if state > 20",
    )
    campaign = read_campaign(write(tmp_path, {"mine": body}))
    counts.write_text("")
    run_campaign(campaign, tmp_path / "out", jobs=1)
    assert counts.read_text().count(".") <= 8 * 22 + 2 * 3


def test_a_plug_in_that_is_mended_flies_again(tmp_path):
    path = write(tmp_path, {"mine": failing("raise ValueError('no')")})
    run_campaign(read_campaign(path), tmp_path / "out", jobs=1)
    shutil.rmtree(tmp_path / "out")
    run_campaign(read_campaign(write(tmp_path, {"mine": failing("pass")})), tmp_path / "out", jobs=1)
    assert set(load(tmp_path / "out")["status"]) == {"ok"}


# --- what check says ---


def test_check_says_what_flies_in_python_and_what_it_costs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    slow = PLAIN.replace("        worst = ", "        time.sleep(2e-3)\n        worst = ")
    write(tmp_path, {"slow": slow, "side": SIDE_BY_SIDE}, more=["voting_monitor"])
    assert main(["check", "opaque.yaml"]) == 0
    said = " ".join(capsys.readouterr().out.split())
    found = said.split("slow is opaque and flies in Python, one flight at a time, ")[1].split()
    per_sample_ms, seconds = float(found[0]), float(found[found.index("sample:") + 1])
    assert 2.0 <= per_sample_ms < 20.0
    # 10 flights of 301 samples and 5 of 201, by two workers
    assert seconds == pytest.approx(per_sample_ms * 1e-3 * 4015 / 2, rel=0.1, abs=1.0)
    assert "side is opaque and flies in Python, many flights side by side, " in said
    assert "voting_monitor is opaque" not in said
