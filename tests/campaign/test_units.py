"""Sizes of faults carry the unit of the benchmark's sites; a benchmark may have nothing to choose."""

from typing import ClassVar

import numpy as np
import pytest
from tests.campaign.conftest import Toy, pretend

from fddbench.campaign.check import describe
from fddbench.campaign.load import read_campaign
from fddbench.campaign.plan import plan
from fddbench.campaign.schema.anywhere import campaign_schema
from fddbench.errors import CampaignError
from fddbench.interfaces import Site
from fddbench.runner.faulty import batch_faults

TEXT = """\
name: plain
benchmark: numbers
seed: 7
detectors: [plain]
scenarios:
  - name: three
    manoeuvre: cruise
    faults:
      - {kind: jam, sites: [r1], onset_s: 4, amplitude: 1.5}
      - {kind: runaway, sites: [r2], onset_s: 10, rate_per_s: 0.2}
      - {kind: noise, sites: [r3], onset_s: 12, variance: 4}
"""


PLAIN = {"signal": "y", "unit_name": "", "admissible": 2.0, "stops": (-9.0, 9.0), "limits_s": (5.0,)}


class Numbers(Toy):
    """The toy benchmark with sites without a unit and nothing to choose."""

    name = "numbers"
    choices: ClassVar = {}
    sites = tuple(Site(name=f"r{row + 1}", row=row, **PLAIN) for row in range(3))


@pytest.fixture(autouse=True)
def numbers(monkeypatch, toys):
    pretend(monkeypatch, "benchmark", numbers=Numbers)


def refusal(path):
    with pytest.raises(CampaignError) as caught:
        read_campaign(path)
    return str(caught.value)


def test_plain_sizes_make_the_numbers(write):
    campaign = read_campaign(write(TEXT))
    half = np.full(1, 0.5)
    jam, runaway, noise = (
        fault.numbers(site, half) for fault, site in zip(campaign.scenarios[0].faults, Numbers.sites, strict=True)
    )
    assert (jam.offset, runaway.rate, noise.sigma) == (1.5, 0.2, 2.0)
    again = read_campaign(write(TEXT.replace("amplitude: 1.5", "amplitude_percent: 75")))
    assert again.scenarios[0].faults[0].numbers(Numbers.sites[0], half).offset == 1.5


def test_a_key_of_another_unit_is_refused_at_its_place(write):
    message = refusal(write(TEXT.replace("amplitude: 1.5", "amplitude_deg_s: 1.5")))
    assert "campaign.yaml:9:46: unknown key 'amplitude_deg_s'. Did you mean" in message
    assert "amplitude_percent, amplitude" in message
    message = refusal(write(TEXT.replace("rate_per_s: 0.2", "rate_deg_s2: 0.2")))
    assert "campaign.yaml:10:51: unknown key 'rate_deg_s2'" in message
    message = refusal(write(jam_a="jam_b", amplitude_percent="amplitude"))
    assert "unknown key 'amplitude'. Did you mean 'amplitude_percent'?" in message or "'amplitude_deg_s'" in message


def test_messages_name_the_keys_of_the_benchmark(write):
    text = TEXT.replace("amplitude: 1.5", "amplitude: 1.5, amplitude_percent: 3")
    assert "need exactly one of amplitude_percent | amplitude, got amplitude_percent, amplitude" in refusal(write(text))
    text = TEXT.replace("amplitude: 1.5", "mode: replace")
    assert "needs freeze: true | hold_value | hold_value_percent" in refusal(write(text))


@pytest.mark.parametrize("key", ["plant", "voter", "sensors", "wind"])
def test_choosing_where_there_is_nothing_to_choose_is_refused(write, key):
    message = refusal(write(TEXT + f"{key}: median\n"))
    assert f"campaign.yaml:12:1: unknown key {key!r}. " in message
    assert "Allowed: name, about, benchmark" in message
    assert read_campaign(write(TEXT)).choices == {}


def test_what_is_not_there_is_not_described(write):
    text = describe(plan(read_campaign(write(TEXT))))
    assert "Benchmark numbers\n" in text
    assert "runaway rate_per_s=0.2 on r2 at 10 s" in text


def limits_of(path):
    """Limit of the first flight from its first onset, and those of its faults from their own [s]."""
    planned = plan(read_campaign(path))
    _, faults = batch_faults(planned, planned.locate([0]))
    return float(faults.limit_s[0]), faults.event_limits_s[:, 0].tolist()


def test_the_limit_of_a_flight_runs_from_its_last_onset(write):
    assert limits_of(write(TEXT)) == (12.0 - 4.0 + 5.0, [5.0, 5.0, 5.0])
    text = TEXT.replace("    manoeuvre: cruise\n", "    manoeuvre: cruise\n    detection_time_limit_s: 3\n")
    assert limits_of(write(text)) == (12.0 - 4.0 + 3.0, [3.0, 3.0, 3.0])


def test_the_limit_runs_from_when_the_last_site_turns_faulty(write):
    """A delayed second site is the same flight as two faults, and has the same limit."""
    one = "    faults: [{kind: jam, sites: [r1, r2], onset_s: 4.0, delay_s: 0.5, amplitude: 1}]\n"
    first = "{kind: jam, sites: [r1], onset_s: 4.0, amplitude: 1}"
    two = f"    faults: [{first}, {{kind: jam, sites: [r2], onset_s: 4.5, amplitude: 1}}]\n"
    head = TEXT[: TEXT.index("    faults:")]
    assert limits_of(write(head + one)) == (5.5, [5.5])
    assert limits_of(write(head + two)) == (5.5, [5.0, 5.0])


def test_the_schema_knows_the_keys_of_every_unit():
    faults = campaign_schema()["$defs"]["ScenarioEntry"]["properties"]["faults"]["items"]["anyOf"]
    keys = {key for fault in faults for key in fault["properties"]}
    assert {"amplitude_deg_s", "amplitude", "rate_deg_s2", "rate_per_s", "variance_deg2_s2", "variance"} <= keys
