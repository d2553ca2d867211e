"""A folder that grew holds the table of the larger campaign flown at once, and its old files keep their bytes."""

import shutil

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

import fddbench
from fddbench.cli import main
from fddbench.errors import FddbenchError, ResultsError
from fddbench.results.manifest import shards

BASE = {
    "name": "small",
    "benchmark": "yaw_rate",
    "seed": 5,
    "duration_s": 1.0,
    "detectors": ["voting_monitor"],
    "dispersions": {
        "grid": {"v_cas_kt": [220, 280], "altitude_ft": [10000]},
        "monte_carlo": {"runs": 2, "mass_kg": {"uniform": [180000, 220000]}},
    },
    "scenarios": [
        {"name": "healthy", "manoeuvre": "cruise"},
        {
            "name": "jam",
            "manoeuvre": "cruise",
            "faults": [{"kind": "jam", "sites": ["r1"], "onset_s": 0.2, "end_s": 0.8, "amplitude_percent": 5}],
        },
    ],
}
DRAWN = {
    "name": "drawn",
    "manoeuvre": "cruise",
    "faults": [{"kind": "jam", "sites": ["r2"], "onset_s": 0.2, "amplitude_percent": {"uniform": [2, 5]}}],
}
MORE = {
    "runs": lambda c: c["dispersions"]["monte_carlo"].update(runs=5),
    "grid": lambda c: c["dispersions"]["grid"].update(v_cas_kt=[200, 220, 250, 280], altitude_ft=[5000, 10000]),
    "scenario": lambda c: c["scenarios"].insert(1, DRAWN),
    "detector": lambda c: c["detectors"].insert(0, "sliding_mode_published"),
}


def _written(path, changes):
    content = yaml.safe_load(yaml.safe_dump(BASE))
    for change in changes:
        MORE[change](content)
    path.write_text(yaml.safe_dump(content))
    return path


def _fly(tmp_path, name, changes):
    out = tmp_path / name
    fddbench.run(_written(tmp_path / f"{name}.yaml", changes), out, jobs=1, backend="numpy")
    return out


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    return _fly(tmp_path_factory.mktemp("base"), "base", [])


def _same(one, other):
    for read in (fddbench.load, fddbench.load_events):
        here, there = read(one), read(other)
        assert here.equals(there)
        assert list(here.columns) == list(there.columns)
        assert here.attrs == there.attrs


@pytest.mark.parametrize("changes", [["runs"], ["grid"], ["scenario"], ["detector"], list(MORE)], ids="+".join)
def test_grown_is_flown_at_once(flown, tmp_path, changes):
    out = shutil.copytree(flown, tmp_path / "out")
    before = {path: path.read_bytes() for path in sorted(out.rglob("*.parquet")) if path.parent != out}
    report = fddbench.extend(out, _written(tmp_path / "more.yaml", changes), jobs=1, backend="numpy")
    assert report.flights > 0
    assert {path: path.read_bytes() for path in before} == before
    _same(out, _fly(tmp_path, "whole", changes))
    assert fddbench.verify(out, refly=10, seed=1).sound
    assert fddbench.extend(out, tmp_path / "more.yaml", jobs=1).flights == 0  # all is there
    assert fddbench.summary(out).equals(fddbench.summary(tmp_path / "whole"))


@pytest.mark.slow
def test_growing_in_steps_is_growing_at_once(flown, tmp_path, capsys):
    out = shutil.copytree(flown, tmp_path / "out")
    steps = (["--runs", "5"], ["--detector", "sliding_mode_published"])
    for step in steps:
        assert main(["extend", str(out), *step, "--quiet", "--jobs", "1", "--backend", "numpy"]) == 0
    _written(tmp_path / "more.yaml", ["runs", "grid", "scenario"])
    content = yaml.safe_load((tmp_path / "more.yaml").read_text())
    content["detectors"].append("sliding_mode_published")
    (tmp_path / "more.yaml").write_text(yaml.safe_dump(content))
    assert main(["extend", str(out), str(tmp_path / "more.yaml"), "--quiet", "--backend", "numpy"]) == 0
    fddbench.run(tmp_path / "more.yaml", tmp_path / "whole", jobs=1, backend="numpy")
    _same(out, tmp_path / "whole")
    assert len({shard.fingerprint for shard in shards(out)}) == 4
    capsys.readouterr()
    assert main(["replay", str(out), "drawn/3/0/4"]) == 0
    assert main(["worst", str(out)]) == 0
    assert main(["scores", str(out)]) == 0
    assert main(["report", str(out)]) == 0


def test_a_scenario_of_another_campaign_alone(flown, tmp_path):
    out = shutil.copytree(flown, tmp_path / "out")
    more = _written(tmp_path / "more.yaml", ["runs", "scenario"])
    fddbench.extend(out, more, scenarios=["drawn"], jobs=1, backend="numpy")
    assert fddbench.load(out)["run"].max() == 1
    assert set(fddbench.load(out)["scenario"]) == {"healthy", "jam", "drawn"}
    with pytest.raises(FddbenchError, match="has no scenario 'drawm'. Did you mean 'drawn'"):
        fddbench.extend(out, more, scenarios=["drawm"])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda c: c.update(seed=6), "the seed was 5 and is 6"),
        (lambda c: c.update(duration_s=2.0), "duration_s was 1.0 and is 2.0"),
        (lambda c: c.update(wind="light"), "the choices were"),
        (lambda c: c["dispersions"]["grid"].update(v_cas_kt=[220]), "the grid of v_cas_kt has 280.0 no more"),
        (lambda c: c["dispersions"]["monte_carlo"].update(runs=1), "had 2 runs and has 1"),
        (
            lambda c: c["dispersions"]["monte_carlo"].update(mass_kg={"uniform": [190000, 200000]}),
            "draws something else",
        ),
        (lambda c: c["scenarios"].pop(), "the scenario jam is gone"),
        (lambda c: c["scenarios"][1]["faults"][0].update(amplitude_percent=6), "the scenario jam is another one"),
        (lambda c: c.update(detectors=["sliding_mode_published"]), "the detector voting_monitor is gone"),
    ],
)
def test_what_would_change_an_old_row_is_refused_in_words(flown, tmp_path, change, said):
    out = shutil.copytree(flown, tmp_path / "out")
    before = {path: path.read_bytes() for path in sorted(out.rglob("*")) if path.is_file()}
    content = yaml.safe_load(yaml.safe_dump(BASE))
    change(content)
    (tmp_path / "more.yaml").write_text(yaml.safe_dump(content))
    with pytest.raises(FddbenchError, match=said):
        fddbench.extend(out, tmp_path / "more.yaml")
    assert {path: path.read_bytes() for path in before} == before


def test_what_cannot_be_extended(flown, tmp_path, capsys):
    assert main(["extend", str(flown)]) == 2
    assert "nothing to extend by" in capsys.readouterr().err
    assert main(["extend", str(flown), "--runs", "1"]) == 2
    assert "had 2 runs and has 1" in capsys.readouterr().err
    assert main(["extend", str(flown), "--detector", "voting_monitr"]) == 2
    assert "voting_monitor" in capsys.readouterr().err
    assert main(["extend", str(tmp_path), "--runs", "5"]) == 2
    assert "no folder of results" in capsys.readouterr().err
    assert main(["extend", str(flown), "--scenario", "jam"]) == 2
    assert "name its file too" in capsys.readouterr().err


def test_cut_off_between_its_two_files_it_goes_on(flown, tmp_path):
    out = shutil.copytree(flown, tmp_path / "out")
    old = (out / "campaign.yaml").read_bytes()
    fddbench.extend(out, runs=5, jobs=1, backend="numpy")
    (out / "campaign.yaml").write_bytes(old)  # as a crash between provenance.json and campaign.yaml leaves it
    with pytest.raises(ResultsError, match=r"campaign\.yaml is not the file of these results"):
        fddbench.signals(out, "healthy")
    fddbench.extend(out, runs=5, jobs=1, backend="numpy")
    _same(out, _fly(tmp_path, "whole", ["runs"]))


def test_cut_off_it_does_not_grow_into_another_campaign(flown, tmp_path):
    out = shutil.copytree(flown, tmp_path / "out")
    old = (out / "campaign.yaml").read_bytes()
    fddbench.extend(out, _written(tmp_path / "one.yaml", ["grid"]), jobs=1, backend="numpy")
    (out / "campaign.yaml").write_bytes(old)
    provenance = (out / "provenance.json").read_bytes()
    other = yaml.safe_load(yaml.safe_dump(BASE))
    other["dispersions"]["grid"]["v_cas_kt"] = [220, 280, 300]  # where the rows that are there have their old points
    (tmp_path / "other.yaml").write_text(yaml.safe_dump(other))
    with pytest.raises(ResultsError, match="ask for the one that was begun first"):
        fddbench.extend(out, tmp_path / "other.yaml", jobs=1, backend="numpy")
    assert (out / "provenance.json").read_bytes() == provenance


def test_a_latin_hypercube_cannot_have_more_runs(tmp_path):
    content = yaml.safe_load(yaml.safe_dump(BASE))
    content["dispersions"]["monte_carlo"]["sampling"] = "lhs"
    (tmp_path / "lhs.yaml").write_text(yaml.safe_dump(content))
    fddbench.run(tmp_path / "lhs.yaml", tmp_path / "out", jobs=1, backend="numpy")
    with pytest.raises(FddbenchError, match="Latin hypercube"):
        fddbench.extend(tmp_path / "out", runs=5)


@settings(max_examples=4)
@given(st.sets(st.sampled_from(sorted(MORE)), min_size=1), st.sets(st.sampled_from(sorted(MORE)), min_size=1))
def test_merged_is_flown_at_once(tmp_path_factory, mine, theirs):
    """Two campaigns that grew apart, and what neither flew of the union."""
    tmp_path = tmp_path_factory.mktemp("merged")
    parts = [_fly(tmp_path, name, sorted(changes)) for name, changes in (("a", mine), ("b", theirs))]
    out = tmp_path / "out"
    found = fddbench.merge(parts, out)
    assert found.partial == _incomplete(mine, theirs)
    fddbench.run(out / "campaign.yaml", out, jobs=1, backend="numpy")
    whole = _fly(tmp_path, "whole", sorted(mine | theirs))
    rows, expected = (
        fddbench.load(each).sort_values(["case", "detector"]).reset_index(drop=True) for each in (out, whole)
    )
    assert rows.equals(expected[rows.columns])


def _incomplete(mine, theirs):
    return not (mine <= theirs or theirs <= mine)


def test_what_is_not_merged(flown, tmp_path, capsys):
    assert main(["merge", str(flown), "--output", str(tmp_path / "o")]) == 2
    assert "two different folders" in capsys.readouterr().err
    assert main(["merge", str(flown), str(tmp_path), "--output", str(tmp_path / "o")]) == 2
    assert "no folder of results" in capsys.readouterr().err
    other = tmp_path / "other"
    content = yaml.safe_load(yaml.safe_dump(BASE)) | {"seed": 6}
    (tmp_path / "other.yaml").write_text(yaml.safe_dump(content))
    fddbench.run(tmp_path / "other.yaml", other, jobs=1, backend="numpy")
    assert main(["merge", str(flown), str(other), "--output", str(tmp_path / "o")]) == 2
    assert "the seed was 6 and is 5" in capsys.readouterr().err
    assert not (tmp_path / "o").exists()
    assert main(["merge", str(flown), str(other), "--output", str(other)]) == 2
