"""Detectors in the loop as compiled C: the same rows, and code that was not written here in a process of its own."""

import json
import os
import re
import subprocess
import sys
import time

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import yaml
from tests.runner.living import below

import fddbench
from fddbench import gallery
from fddbench.campaign.load import read_campaign
from fddbench.designs.thresholds import thresholds_of
from fddbench.errors import CampaignError, FddbenchError
from fddbench.exported.child import Child
from fddbench.exported.child_main import main_text
from fddbench.exported.code import sources
from fddbench.exported.compiling import built, compiler
from fddbench.exported.flown_c import FlownC
from fddbench.exported.interface import interface_of
from fddbench.exported.upset import flown_with_upsets
from fddbench.runner.assembling import assemble
from fddbench.runner.vectors import flown_samples

FAST = ["dispersions.monte_carlo.runs=1", "duration_s=11.0"]


def rows_of(folder):
    """All rows, flights in order."""
    return table_of(folder, "rows", ("scenario", "point", "level", "run", "detector"))


def events_of(folder):
    """All faults, flights in order."""
    return table_of(folder, "events", ("scenario", "point", "level", "run", "detector", "fault"))


def table_of(folder, part, names):
    shards = [pq.read_table(path) for path in sorted((folder / part).glob("*.parquet"))]
    if not shards:  # nobody writes events where no flight has several faults
        return pa.table({})
    rows = pa.concat_tables(shards)
    keys = [(name, "ascending") for name in names]
    return rows.sort_by(keys).replace_schema_metadata(None).combine_chunks()


def flown(where, campaign, *overrides, **how):
    fddbench.run(read_campaign(campaign, overrides), where, jobs=1, notice=lambda _: None, **how)
    return rows_of(where)


def shipped(name):
    return gallery.folder("campaigns") / f"{name}.yaml"


SHORT = {
    "yaw_rate_table8": ["dispersions.monte_carlo.runs=1", "requirements=[]"],
    "jet_engine_monte_carlo": ["dispersions.monte_carlo.runs=1", "requirements=[]"],
    "b747_monte_carlo": ["dispersions.monte_carlo.runs=1"],
}
"""All detectors and scenarios of the long campaigns, one run of each."""


@pytest.mark.slow
@pytest.mark.parametrize("campaign", ["smoke", *SHORT])
def test_rows_are_equal_bit_for_bit(campaign, tmp_path):
    """Smoke is flown whole, of the others one run of each scenario."""
    path, overrides = shipped(campaign), list(SHORT.get(campaign, []))
    if overrides:
        scenarios = read_campaign(path, overrides).scenarios
        overrides += [f"scenarios.{n}.runs=1" for n, each in enumerate(scenarios) if each.entry.runs]
    wanted = flown(tmp_path / "engine", path, *overrides)
    found = flown(tmp_path / "c", path, *overrides, compiled_as="c")
    assert found.equals(wanted)
    assert events_of(tmp_path / "c").equals(events_of(tmp_path / "engine"))
    said = json.loads((tmp_path / "c" / "provenance.json").read_text())["flown_as_c"]
    assert set(said) == set(wanted["detector"].to_pylist())
    assert all(each.endswith("-ffp-contract=off -fno-tree-slp-vectorize") for each in said.values())


SANITIZERS = "-g -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "flags"),
    [
        ("gcc", "-O0"),
        ("gcc", "-O3 -march=native"),
        ("clang", "-O0"),
        ("clang", "-O3 -march=native"),
        ("gcc", SANITIZERS),
    ],
)
def test_the_whole_smoke_campaign_has_equal_rows_with_every_compiler(command, flags, tmp_path, monkeypatch):
    """Address and undefined-behaviour sanitizers end the code where they find something, so its rows would be errors."""
    wanted = flown(tmp_path / "engine", shipped("smoke"))
    monkeypatch.setenv("CC", command)
    monkeypatch.setenv("CFLAGS", flags)
    compiler.cache_clear()
    try:
        assert flown(tmp_path / "c", shipped("smoke"), compiled_as="c").equals(wanted)
    finally:
        compiler.cache_clear()
    said = json.loads((tmp_path / "c" / "provenance.json").read_text())["flown_as_c"]
    assert len(said) == 2
    assert all(flags in each for each in said.values())


@pytest.mark.slow
def test_sanitizers_end_the_code_that_leaves_an_array(tmp_path, monkeypatch):
    monkeypatch.setenv("CFLAGS", SANITIZERS)
    compiler.cache_clear()
    beyond = "    if (in->r_deg_s[0U] > 5.0) { x->held_samples = in->r_deg_s[(uint32_t)in->r_deg_s[0U]]; }\n"
    call = "    voting_monitor(in, x, &s);"
    try:
        campaign = own_files(tmp_path, lambda text: text.replace(call, beyond + call))
        rows = flown(tmp_path / "results", campaign, *FAST).to_pandas()
    finally:
        compiler.cache_clear()
    assert set(rows[rows.status != "ok"].detector) == {"supplied"}
    assert set(rows[rows.status != "ok"].reason) == {"crashed: it ended its process with exit code 1"}


@pytest.mark.slow
@pytest.mark.parametrize("design", ["voting_monitor", "sliding_mode_published"])
def test_inputs_that_are_no_numbers_do_what_the_header_says(design):
    """The C of a flight with one bad sample has the bits of the interpreter, and the effect that the header tells."""
    assembly = assemble(read_campaign(shipped("smoke")))
    own, bus = assembly.detectors[design], assembly.loop.bus
    interface = interface_of(own, bus, name=design)
    signals = flown_samples(assembly, own.every, 400)
    vectors, upsets = flown_with_upsets(interface, signals)
    files = sources(interface, own.detector) | {"flown.c": main_text(interface.name)}
    sanitized = compiler("", ("-fsanitize=undefined,float-cast-overflow", "-fno-sanitize-recover=all"))
    code = FlownC(interface, Child(built(files, sanitized)))
    width, at = len(upsets) + 1, len(vectors) // 2
    state, given = np.repeat(code.start[:, np.newaxis], width, axis=1), []
    for k in range(len(vectors)):
        seen = {m.source: np.repeat(signals[m.source][k][:, np.newaxis], width, axis=1) for m in interface.inputs}
        for column, each in enumerate(upsets, start=1):
            if k == at:
                seen[each.signal][:, column] = {"not-a-number": np.nan, "infinity": np.inf, "1e308": 1e308}[each.kind]
        state, out = code.step(state, seen)
        given.append(np.concatenate([out[m.source] for m in interface.outputs]))
    code.child.close()
    outputs = np.array(given)
    assert np.array_equal(outputs[:, :, 0], vectors.outputs)
    assert len(upsets) == 3 * len(interface.inputs)
    for column, each in enumerate(upsets, start=1):
        finite = bool(np.isfinite(state[:, column]).all())
        apart = np.flatnonzero((outputs[:, :, column] != vectors.outputs).any(axis=1))
        assert finite == each.finite, each
        assert not len(apart) or apart[0] >= at, each
        if each.recovers is not None:
            assert each.recovers == (apart[-1] + 1 - at if len(apart) else 0), each
        else:
            assert not finite or apart[-1] == len(vectors) - 1, each


def own_files(folder, source):
    """A campaign of a design whose code is somebody else's, made of the exported files and a change of the source."""
    (folder / "detectors").mkdir(exist_ok=True)
    fddbench.export("voting_monitor", folder / "detectors" / "supplier", force=True)
    code = folder / "detectors" / "supplier" / "voting_monitor.c"
    code.write_text(source(code.read_text()))
    design = (gallery.folder("detectors") / "voting_monitor.yaml").read_text()
    (folder / "detectors" / "supplied.yaml").write_text(
        re.sub("^kind:", "code: supplier\nkind:", design, flags=re.MULTILINE)
    )
    data = yaml.safe_load(shipped("smoke").read_text())
    data |= {"name": "own", "detectors": ["supplied", "voting_monitor"]}
    data["scenarios"] = [each for each in data["scenarios"] if each["name"] in {"healthy", "runaway_a"}]
    (folder / "own.yaml").write_text(yaml.safe_dump(data))
    return folder / "own.yaml"


@pytest.mark.slow
def test_foreign_code_flies_in_place_of_the_design(tmp_path):
    rows = flown(tmp_path / "results", own_files(tmp_path, lambda text: text), *FAST).to_pandas()
    own, theirs = (
        rows[rows.detector == name].drop(columns="detector").reset_index(drop=True)
        for name in ("voting_monitor", "supplied")
    )
    assert own.equals(theirs)
    assert (tmp_path / "results" / "detectors" / "supplier" / "voting_monitor.c").is_file()


POISON = {
    "volatile int *p = 0; *p = 1;": ("crashed", "crashed: its process died of SIGSEGV"),
    "exit(3);": ("crashed", "crashed: it ended its process with exit code 3"),
    "for (;;) { x->held_samples += 0.0; }": ("timeout", "timeout: no answer in 1 s"),
    "for (;;) { (void)usleep(100000); for (int k = 3; k < 20; k++) { (void)!write(k, in, 8); } }": (
        "timeout",
        "timeout: no answer in 1 s",
    ),
    "for (int k = 3; k < 300; k++) { (void)!write(k, in, 24); }": (
        "crashed",
        "crashed: it wrote to files that are not its own",
    ),
    "for (int k = 0; k < 300; k++) { (void)close(k); } for (;;) { x->held_samples += 0.0; }": (
        "crashed",
        "crashed: it closed files that are not its own",
    ),
    "for (;;) { char *p = malloc(8000000U); if (p == NULL) { abort(); } (void)memset(p, 1, 8000000U); }": (
        "memory",
        "memory: it needs more than 64 MB",
    ),
    "volatile char *p = malloc(2000000000U); *p = 1; x->held_samples += *p;": (
        "memory",
        "memory: it needs more than 64 MB",
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("harm", POISON)
def test_foreign_code_that_does_harm_takes_only_its_own_rows(tmp_path, harm):
    """Without its limits the leak took the memory of the machine, and all four were rows of status `error`."""
    call, poison = "    voting_monitor(in, x, &s);", f"    if (in->r_deg_s[0U] > 5.0) {{ {harm} }}\n"
    head = "#define _DEFAULT_SOURCE\n#include <stdlib.h>\n#include <string.h>\n#include <unistd.h>\n"
    campaign = own_files(tmp_path, lambda text: head + text.replace(call, poison + call))
    design = tmp_path / "detectors" / "supplied.yaml"
    design.write_text(design.read_text() + "limits: {step_s: 1, memory_mb: 64}\n")
    rows = flown(tmp_path / "results", campaign, *FAST).to_pandas()
    failed = rows[rows.status != "ok"]
    assert set(failed.detector) == {"supplied"}
    assert list(zip(failed.status, failed.reason, strict=True)) == [POISON[harm]]


@pytest.mark.slow
def test_code_that_leaks_goes_on_in_a_new_process(tmp_path):
    """It was refused as one that depends on its company: all flights share what is left."""
    leak = "    { char *p = malloc(100000U); if (p == NULL) { abort(); } (void)memset(p, 1, 100000U); }\n"
    call, head = "    voting_monitor(in, x, &s);", "#include <stdlib.h>\n#include <string.h>\n"
    campaign = own_files(tmp_path, lambda text: head + text.replace(call, leak + call))
    design = tmp_path / "detectors" / "supplied.yaml"
    design.write_text(design.read_text() + "limits: {memory_mb: 64}\n")
    rows = flown(tmp_path / "results", campaign, *FAST, "dispersions.monte_carlo.runs=12").to_pandas()
    assert set(rows.status) == {"ok"}


@pytest.mark.slow
def test_flights_that_end_in_different_ways_are_no_reason_to_give_up(tmp_path):
    """Eight that all crash, but not alike, were eight of the same; the others were never flown."""
    ends = "    if (in->r_deg_s[0U] > 5.0) { if ((int32_t)(in->r_deg_s[1U] * 1.0e6) % 2 == 0) { exit(3); } abort(); }\n"
    call = "    voting_monitor(in, x, &s);"
    campaign = own_files(tmp_path, lambda text: "#include <stdlib.h>\n" + text.replace(call, ends + call))
    rows = flown(
        tmp_path / "results", campaign, *FAST, "dispersions.monte_carlo.runs=12", only="scenario=runaway_a"
    ).to_pandas()
    said = rows[rows.detector == "supplied"].reason
    assert set(said) == {"crashed: it ended its process with exit code 3", "crashed: its process died of SIGABRT"}


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_what_code_has_begun_ends_with_it(tmp_path, monkeypatch):
    """It left a shell and a sleep for every flight."""
    begins = '    if (in->r_deg_s[0U] > 5.0) { x->held_samples += system("sleep 777"); }\n'
    call = "    voting_monitor(in, x, &s);"
    campaign = own_files(tmp_path, lambda text: "#include <stdlib.h>\n" + text.replace(call, begins + call))
    design = tmp_path / "detectors" / "supplied.yaml"
    design.write_text(design.read_text() + "limits: {step_s: 1}\n")
    monkeypatch.setenv("FDDBENCH_MARK", str(tmp_path))
    rows = flown(tmp_path / "results", campaign, *FAST).to_pandas()
    assert set(rows.status) == {"ok", "timeout"}
    assert [line for line in below(f"FDDBENCH_MARK={tmp_path}").values() if "sleep" in line] == []


NO_FOLDERS = ("../a/supplier", "./supplier", "/tmp", "supplier/../supplier")


@pytest.mark.parametrize("name", NO_FOLDERS)
def test_code_lies_in_a_folder_beside_its_design(tmp_path, name):
    """Names that led out of the folder were written out of the folder of results; others could not be read again."""
    campaign = own_files(tmp_path, lambda text: text)
    design = tmp_path / "detectors" / "supplied.yaml"
    design.write_text(design.read_text().replace("code: supplier", f"code: {name}"))
    with pytest.raises(CampaignError, match="is no name of a folder beside the design"):
        read_campaign(campaign)


STRAYS = ('#include "/etc/hosts"', "#  include </etc/hosts>", '#include "../supplied.yaml"', '#include "gone.h"')


@pytest.mark.parametrize("line", STRAYS)
def test_what_code_includes_travels_with_it(tmp_path, line):
    """An absolute path was no part of the hash: the program of yesterday flew when it had changed."""
    campaign = own_files(tmp_path, lambda text: f"{line}\n{text}")
    with pytest.raises(CampaignError, match=r"voting_monitor\.c:1 includes .*, which is no file of this folder"):
        read_campaign(campaign)


def test_numbers_of_a_design_that_flies_c_are_neither_swept_nor_tuned(tmp_path):
    """Variants of other names had the same rows, and a tuned threshold never reached the C."""
    campaign = own_files(tmp_path, lambda text: text)
    swept = "detectors=[{design: supplied, sweep: {flag_threshold_deg_s: [0.1, 5.0]}}]"
    with pytest.raises(CampaignError, match="'supplied' flies the C of supplier, whose numbers are in the C"):
        read_campaign(campaign, [swept])
    design = next(each for each in read_campaign(campaign).designs if each.name == "supplied")
    with pytest.raises(FddbenchError, match="supplied flies the C of supplier, whose thresholds are in the C"):
        thresholds_of(design)


@pytest.mark.slow
def test_code_that_was_ended_from_outside_goes_on(tmp_path, monkeypatch):
    """It gets all its state anew with every request: nobody's row is lost to a signal that came from elsewhere."""
    left, step = [3], Child.step

    def ended_twice(self, state, inputs):
        if left[0] > 1:
            left[0] -= 1
            self._process.kill()
        return step(self, state, inputs)

    campaign = own_files(tmp_path, lambda text: text)
    wanted = flown(tmp_path / "results", campaign, *FAST)
    monkeypatch.setattr(Child, "step", ended_twice)
    assert flown(tmp_path / "again", campaign, *FAST).equals(wanted)
    assert left == [1]


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_code_that_hangs_ends_with_who_began_it(tmp_path):
    """Seen to fail without the timer of its main: it ran on."""
    call, loop = "    voting_monitor(in, x, &s);", "    for (;;) { x->held_samples += 0.0; }"
    campaign, name = own_files(tmp_path, lambda text: text.replace(call, loop)), "FDDBENCH_MARK"
    command = [sys.executable, "-m", "fddbench", "run", campaign, "--out", tmp_path / "results", "--quiet"]
    run = subprocess.Popen(command, env={**os.environ, name: str(tmp_path)}, stderr=subprocess.DEVNULL)
    try:
        while not any(".flown" in line for line in below(f"{name}={tmp_path}").values()):
            assert run.poll() is None
            time.sleep(0.1)
        time.sleep(0.5)
    finally:
        run.kill()
        run.wait()
    time.sleep(1.5)
    assert below(f"{name}={tmp_path}") == {}


@pytest.mark.slow
def test_foreign_code_that_keeps_something_outside_its_state_is_refused(tmp_path):
    count = "    { static double seen = 0.0; seen = seen + 1.0; x->declared[0U] = (seen > 1500.0) ? 1.0 : x->declared[0U]; }\n"
    campaign = own_files(
        tmp_path, lambda text: text.replace("    voting_monitor(in, x, &s);", count + "    voting_monitor(in, x, &s);")
    )
    with pytest.raises(FddbenchError, match="supplied gives another verdict when a flight is flown again"):
        flown(tmp_path / "results", campaign, *FAST)


@pytest.mark.slow
def test_foreign_code_that_does_not_compile_is_refused_where_the_campaign_names_it(tmp_path):
    campaign = own_files(tmp_path, lambda _: "int broken(")
    with pytest.raises(CampaignError, match=r"own\.yaml:\d+:\d+: design 'supplied', code supplier: .* refuses"):
        assemble(read_campaign(campaign))


def test_a_flag_that_changes_bits_is_refused():
    with pytest.raises(FddbenchError, match="-ffast-math would change the bits of a flight"):
        compiler("true", ("-ffast-math",))
    with pytest.raises(FddbenchError, match="-ffp-contract=fast would change the bits"):
        compiler("true", ("-ffp-contract=fast",))


@pytest.mark.parametrize("flag", ["-m32", "-mfpmath=387", "-fsingle-precision-constant", "-mdaz-ftz", "-Ofast"])
def test_a_flag_beside_the_compiler_is_refused_too(flag):
    with pytest.raises(FddbenchError, match=f"{flag} would change the bits of a flight"):
        compiler(f"true {flag}")


def test_all_flags_are_told_and_none_of_the_user_wins_over_what_forbids_contraction(monkeypatch):
    monkeypatch.setenv("CFLAGS", "-O3 -ftree-slp-vectorize")
    compiler.cache_clear()
    try:
        said = str(compiler("true"))
    finally:
        compiler.cache_clear()
    assert said.endswith(", -std=c99 -O2 -O3 -ftree-slp-vectorize -ffp-contract=off -fno-tree-slp-vectorize")


def test_a_folder_without_a_cache_is_gone_when_the_process_ends(tmp_path):
    code = (
        "from fddbench import private\n"
        "from fddbench.exported.compiling import _place\n"
        "def none(): raise OSError\n"
        "private.folder = none\n"
        "assert _place() == _place() and _place().is_dir()\n"
        "print(_place())\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | {"TMPDIR": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.startswith(str(tmp_path))
    assert list(tmp_path.iterdir()) == []


def test_a_compiler_that_is_missing_is_named():
    with pytest.raises(FddbenchError, match="no compiler 'nocc' is here; install one"):
        compiler("nocc")


def test_symbols_of_a_campaign_refuse_what_needs_more(tmp_path):
    text = (
        shipped("smoke")
        .read_text()
        .replace("\ndetectors:", "\nsymbols: [add, sub, abs, max, compare, logic, switch]\ndetectors:")
    )
    (tmp_path / "own.yaml").write_text(text)
    before = read_campaign(shipped("smoke"))
    own = read_campaign(tmp_path / "own.yaml")
    assert own.sha256 == before.sha256  # they decide no row
    with pytest.raises(CampaignError, match="sliding_mode_published needs more than the symbols") as caught:
        assemble(own)
    assert "sin, 1 times: detector.py:" in str(caught.value)
    assert "48 states, at most 0 (delay)" in str(caught.value)
