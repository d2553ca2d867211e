from pathlib import Path

import pytest
import yaml

from fddbench import gallery, kinds
from fddbench.campaign.load import read_campaign
from fddbench.errors import FddbenchError
from fddbench.interfaces import SinglePlant
from fddbench.reporting import page
from fddbench.reporting.published import iterations_for, published, published_for


@pytest.mark.parametrize("table", ["table7", "table8", "table9", "table10", "table11"])
def test_times_are_the_printed_ratio_times_the_inferred_limit(table):
    content = published(table)
    assert f"table{content.table}" == table
    assert "inferred" in content.note
    assert set(content.inferred) == {"detection_time_limit_s", "detection_time_samples"}
    assert {row.variant for row in content.rows} == set(content.variants)
    for row in (row for row in content.rows if row.n_faulty):
        limit_s = 1.5 if row.scenario == "runaway_a" else {1: 120.0, 2: 0.36}[row.n_faulty]
        assert row.detection_time_limit_s == limit_s
        assert row.detection_time_samples * content.sample_s == pytest.approx(
            row.normalized_detection_time * limit_s, abs=0.5e-4 * limit_s + 1e-9
        )
        assert sum(size is not None for size in (row.amplitude_percent, row.rate_percent_s, row.variance_percent)) == 1


def test_table8_as_printed():
    table = published("table8")
    times = {variant: [row.detection_time_samples for row in table.rows if row.variant == variant and row.n_faulty]
             for variant in table.variants}  # fmt: skip
    assert times == {
        "simulink": [410, 11, 100, 11, 41, 13, 100, 11, 102, 13],
        "sao": [410, 10, 100, 10, 41, 12, 100, 10, 102, 12],
    }
    assert table.row("sao", "fault_free") is None
    assert table.row("sao", "no_such") is None


def test_a_campaign_names_its_table():
    assert [found.table for found in published_for({}, "table8")] == [8]
    named = {"report": {"published": ["table10", "table9"]}}
    assert [found.table for found in published_for(named, "table8")] == [10, 9]
    assert published_for({}) == ()
    with pytest.raises(FddbenchError, match="no published table is called 'table88'. Did you mean 'table8'"):
        published_for({"report": {"published": ["table88"]}})


def test_what_is_printed_of_a_benchmark_comes_with_the_benchmark():
    assert published_for({}, kinds.find("benchmark", "yaw_rate").member().published)[0].table == 8
    assert iterations_for(kinds.find("benchmark", "jet_engine").member().iterations).table == 1
    assert iterations_for(SinglePlant.iterations) is None
    assert published_for({}, SinglePlant.published) == ()


def test_every_printed_row_has_a_flight_in_the_campaigns_of_the_whole_envelope():
    """Tables 7 to 11: a scenario of the printed size, onset and number of sensors, found by its name."""
    for name, tables in (("fes_parametric", [7]), ("fes_monte_carlo", [8]), ("fes_maturation", [9, 10, 11])):
        campaign = read_campaign(gallery.folder("campaigns") / f"{name}.yaml")
        scenarios = {scenario.name: scenario for scenario in campaign.scenarios}
        found = published_for(yaml.safe_load(campaign.text))
        assert [table.table for table in found] == tables
        for table in found:
            for row in table.rows:
                own = f"{row.scenario}_{row.variant}" if row.n_faulty else f"healthy_{row.manoeuvre}"
                flown = scenarios.get(own) or scenarios[row.scenario]
                assert flown.entry.manoeuvre == (row.manoeuvre or "cruise")
                for fault in flown.faults:
                    assert (fault.onset_s, len(fault.sites)) == (row.onset_s, row.n_faulty)
                    sizes = fault.model_dump(by_alias=True)
                    for key in ("amplitude_percent", "rate_percent_s", "variance_percent"):
                        assert getattr(row, key) is None or sizes[key] == getattr(row, key)


def test_the_report_names_no_benchmark():
    for path in Path(page.__file__).parent.rglob("*.*"):
        if path.suffix in {".py", ".j2", ".css"}:
            for name in kinds.known("benchmark"):
                # "recorded" is a word besides
                assert (name if "_" in name else f'"{name}"') not in path.read_text(encoding="utf-8"), path
