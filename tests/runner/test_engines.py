"""Whoever flies, the table is the same; who cannot fly says why, and nobody waits for ever."""

import os
import signal
import time
from dataclasses import replace
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest
from tests.runner.jammed import jammed
from tests.runner.plugins import PLAIN, failing, write
from tests.runner.tables import digest

import fddbench
from fddbench.campaign.load import read_campaign
from fddbench.cli import main
from fddbench.errors import FddbenchError
from fddbench.results.manifest import shards
from fddbench.results.shards import file_sha256
from fddbench.runner import engines, sending
from fddbench.runner.engines import Engine
from fddbench.runner.run import run_campaign
from fddbench.runner.work import Work


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    path = tmp_path_factory.mktemp("engines") / "engines.yaml"
    path.write_text(jammed("engines"))
    fddbench.run(path, path.parent / "clean", jobs=1)
    return path


@pytest.fixture(scope="module")
def clean(campaign):
    return fddbench.load(campaign.parent / "clean")


def test_threads_are_one_process(campaign, clean, tmp_path):
    fddbench.run(campaign, tmp_path / "out", engine="threads")
    assert fddbench.load(tmp_path / "out").equals(clean)


def test_what_an_engine_cannot_do_is_refused_before_anything_is_written(campaign, tmp_path, monkeypatch, capsys):
    out = tmp_path / "out"
    plain = write(tmp_path, {"plain": PLAIN})
    with pytest.raises(
        FddbenchError, match="--engine threads: plain flies outside of compiled code here.*take auto or loky"
    ):
        fddbench.run(plain, out, engine="threads")
    with pytest.raises(FddbenchError, match="no engine is called 'slurm'; there are auto, threads, loky, dask, ray"):
        fddbench.run(campaign, out, engine="slurm")
    assert main(["run", str(campaign), "--out", str(out), "--engine", "loky", "--dask-address", "tcp://a:1"]) == 2
    assert "give --engine dask or ray with it" in capsys.readouterr().err
    monkeypatch.setattr(engines, "find_spec", lambda name: None)
    with pytest.raises(FddbenchError, match=r"pip install 'fddbench\[ray\]'"):
        fddbench.run(campaign, out, engine="ray")
    assert not out.exists()


@pytest.fixture
def work(campaign, tmp_path):
    out = tmp_path / "out"
    fddbench.run(campaign, out, jobs=1, only="run=0")
    return Work(folder=str(out), fingerprint=shards(out)[0].fingerprint, backend="auto")


def test_a_worker_that_does_not_see_the_folder_asks_for_the_campaign_and_sends_its_shards(work, tmp_path):
    out, cases = Path(work.folder), ((1, 39), (41, 39))
    with sending.errand(work) as own:
        seen = sending.fly_anywhere(own, cases)
        assert file_sha256(out / seen.rows) == seen.rows_sha256
        blind = replace(own, token="another")
        assert sending.fly_anywhere(blind, cases) == sending.Unseen(cases)
        before = (out / seen.rows).read_bytes()
        (out / seen.rows).unlink()
        sent = sending.fly_anywhere(sending.carried_by(blind), cases)
        assert not (out / seen.rows).exists()
        assert sending.keep(out, sent) == seen
        assert (out / seen.rows).read_bytes() == before
        damaged = replace(sent, files=tuple((name, data[:-1] + b"?") for name, data in sent.files))
        with pytest.raises(FddbenchError, match="was damaged on its way"):
            sending.keep(out, damaged)
        assert (out / ".token").exists()
    assert not (out / ".token").exists()


def test_a_worker_that_is_another_program_says_so(work):
    with sending.errand(replace(work, fingerprint="0" * 64)) as own:
        answer = sending.fly_anywhere(own, ((1, 1),))
    assert isinstance(answer, FddbenchError)
    assert "is another program than its parent" in str(answer)


def test_a_token_that_a_killed_run_left_is_no_hindrance(campaign, clean, work):
    (Path(work.folder) / ".token").write_text("old")
    fddbench.run(campaign, work.folder, jobs=1)
    assert fddbench.load(work.folder).equals(clean)


def test_an_answer_of_a_task_that_ended_in_an_error():
    """Whatever dask says of a future that did not finish becomes an exception, which joblib raises."""
    from types import SimpleNamespace

    from fddbench.runner.dask_engine import _error_of

    own = ValueError("mine")
    assert _error_of(SimpleNamespace(status="error"), (ValueError, own, None)) is own
    assert _error_of(SimpleNamespace(status="cancelled"), own) is own
    assert str(_error_of(SimpleNamespace(status="lost"), None)) == "a task of dask is lost"


def test_nobody_at_an_address(campaign, tmp_path):
    pytest.importorskip("distributed")
    monkey = pytest.MonkeyPatch()
    monkey.setattr("fddbench.runner.dask_engine._PATIENCE_S", 0.2)
    with pytest.raises(FddbenchError, match="no dask scheduler answers at 'tcp://127.0.0.1:9'"):
        fddbench.run(campaign, tmp_path / "out", engine="dask", address="tcp://127.0.0.1:9")
    monkey.undo()


@pytest.mark.slow
@pytest.mark.parametrize("chunk", [1, 7, 64, 1000])
@pytest.mark.parametrize("name", ["auto", "threads", "loky", "dask"])
def test_every_engine_with_chunks_of_any_size_is_one_process(campaign, tmp_path, name, chunk):
    """Seen to fail where the random numbers of a flight are made of its place in the chunk instead of its number."""
    if name == "dask":
        pytest.importorskip("distributed")
    engine = Engine(name=name, jobs=1 if name == "auto" else 2)
    run_campaign(read_campaign(campaign), tmp_path / "out", engine=engine, chunk=chunk)
    assert digest(tmp_path / "out") == digest(campaign.parent / "clean")
    assert len(shards(tmp_path / "out")) >= 80 / chunk
    assert not (tmp_path / "out" / ".token").exists()


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 3])
def test_shards_of_slurm_merged_are_one_process(campaign, tmp_path, count):
    """Seen to fail where `Shares.cases` leaves out the last flight of a shard: the table is partial."""
    assert main(["plan", str(campaign), "--shards", str(count), "--out", str(tmp_path / "planned")]) == 0
    for k in range(count, 0, -1):
        assert main(["shard", str(k), str(tmp_path / "planned"), "--quiet"]) == 0
    assert main(["merge", str(tmp_path / "planned"), "--output", str(tmp_path / "out")]) == 0
    assert digest(tmp_path / "out") == digest(campaign.parent / "clean")


@pytest.mark.slow
def test_killed_workers_of_dask_lose_nothing(tmp_path):
    """Without the nanny's new workers, or the pool's new attempt, flights are missing."""
    pytest.importorskip("distributed")
    path = tmp_path / "engines.yaml"
    path.write_text(jammed("engines", runs=6000, duration_s=6.0))
    psutil, killed = pytest.importorskip("psutil"), []

    def kill(progress):
        if progress.flown and not killed:
            below = psutil.Process().children(recursive=True)
            workers = [each for each in below if "spawn_main" in " ".join(each.cmdline())]
            killed.append(workers[0].pid)
            os.kill(workers[0].pid, signal.SIGKILL)

    fddbench.run(path, tmp_path / "dask", engine="dask", progress=kill)
    fddbench.run(path, tmp_path / "clean")
    assert killed
    assert fddbench.load(tmp_path / "dask").equals(fddbench.load(tmp_path / "clean"))


@pytest.mark.slow
def test_workers_of_dask_that_lack_a_package_are_named(campaign, tmp_path, monkeypatch):
    """Without the question beforehand dask starts such workers anew for ever."""
    pytest.importorskip("distributed")
    (tmp_path / "only_here.py").write_text("def fly(own, cases):\n    return None\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr("fddbench.runner.dask_engine.fly_anywhere", import_module("only_here").fly)
    (tmp_path / "only_here.py").unlink()
    begun = time.monotonic()
    with pytest.raises(FddbenchError, match="1 of 1 workers of dask cannot fly .*No module named 'only_here'"):
        fddbench.run(campaign, tmp_path / "out", engine="dask", jobs=1)
    assert time.monotonic() - begun < 10


@pytest.mark.slow
def test_a_task_that_kills_its_worker_again_and_again_ends_the_run_under_dask(campaign, tmp_path, monkeypatch):
    """With joblib's own backend this waits for ever."""
    pytest.importorskip("distributed")
    monkeypatch.setattr("fddbench.runner.pool.fly_anywhere", lambda own, cases: os._exit(1))
    monkeypatch.setattr("fddbench.runner.pool._ATTEMPTS", 1)
    with pytest.raises(FddbenchError, match="workers died 1 times in a row"):
        fddbench.run(campaign, tmp_path / "out", engine="dask", jobs=1)


@pytest.mark.slow
def test_a_poisoned_flight_under_dask_is_a_row(tmp_path):
    """79 good rows of 80; without the supervised processes of detectors the worker dies with the flight."""
    pytest.importorskip("distributed")
    if find_spec("fddbench.runner.supervised") is None:
        pytest.skip("detectors of ordinary Python fly in the worker itself")
    poison = failing("import os; os._exit(3)", "measured.mass_kg > 218000")
    path = write(tmp_path, {"poison": poison}, text=jammed("engines", detectors="NAMES"))
    fddbench.run(path, tmp_path / "out", engine="dask")
    rows = fddbench.load(tmp_path / "out")
    heavy = rows["p_mass_kg"] > 218000
    assert set(rows.loc[heavy, "status"]) == {"crashed"}
    assert set(rows.loc[~heavy, "status"]) == {"ok"}
