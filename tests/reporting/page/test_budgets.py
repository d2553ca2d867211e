"""How large a page is, and what it costs: aggregates only, so the number of flights is no part of its size."""

import subprocess
import sys
import time
from dataclasses import replace

import pytest
from tests.reporting.page.many import many_designs, many_rows

from fddbench.cli import main
from fddbench.reporting.page.writing import page_html
from fddbench.results.table import load


@pytest.fixture
def report(make_report):
    return make_report(scenarios=(), flights=0, recordings=(), published=(), provenance={})


def page_of(report, detectors, scenarios, runs):
    rows, designs = many_rows(detectors, scenarios, runs), many_designs(detectors)
    return page_html(replace(report, rows=rows, designs=designs))


def test_a_page_of_five_detectors_and_twelve_scenarios_is_small(report):
    started = time.process_time()
    page = page_of(report, 5, 12, 100)
    assert "What a step takes of a flight computer" in page
    assert len(page.encode()) <= 150_000
    assert time.process_time() - started < 5.0


@pytest.mark.slow
def test_a_page_of_ten_detectors_and_forty_scenarios_is_not_large(report):
    assert len(page_of(report, 10, 40, 30).encode()) <= 600_000


@pytest.mark.slow
@pytest.mark.parametrize(("runs", "rows", "cpu_s"), [(2000, 144_000, 5.0), (14_000, 1_008_000, 10.0)])
def test_a_folder_of_many_rows_takes_seconds_and_no_more_than_a_gigabyte(tmp_path, runs, rows, cpu_s):
    """In a process of its own, from the folder to the page, signals aside."""
    folder, changed = tmp_path / "many", f"dispersions.monte_carlo.runs={runs}"
    assert main(["run", "jet_engine_monte_carlo", "--quiet", "--set", changed, "--out", str(folder)]) == 0
    assert len(load(folder, ["run"])) == rows
    code = f"import resource, fddbench; fddbench.report({str(folder)!r}, replay=False)"
    # VmHWM is this program's own; ru_maxrss still has the peak of the one that started it
    code += "; used = resource.getrusage(resource.RUSAGE_SELF); status = open('/proc/self/status').read()"
    code += "; print(used.ru_utime + used.ru_stime, int(status.split('VmHWM:')[1].split()[0]) * 1024 / 1e9)"
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    used_s, peak_gb = map(float, done.stdout.split())
    assert used_s <= cpu_s
    assert peak_gb <= 1.0
    assert (folder / "report.html").stat().st_size <= 200_000
