"""An aircraft of one's own: a changed copy of the shipped file beside a campaign, named as its plant."""

import pytest

import fddbench
from fddbench.benchmarks.yaw_rate.transport.gains import LAW
from fddbench.errors import FddbenchError
from fddbench.flight.transport.reading import SHIPPED

CAMPAIGN = """
name: own
about: flies an aircraft of one's own
benchmark: yaw_rate
plant: {plant}
purpose: tuning
seed: 4
duration_s: 12.0
detectors: [voting_monitor]
dispersions: {{monte_carlo: {{runs: 2}}}}
scenarios:
  - {{name: healthy, manoeuvre: dpm}}
"""


def written(folder, plant, change=lambda text: text, law=""):
    (folder / "mine.yaml").write_text(change(SHIPPED.read_text(encoding="utf-8")) + law, encoding="utf-8")
    path = folder / "campaign.yaml"
    path.write_text(CAMPAIGN.format(plant=plant), encoding="utf-8")
    return path


def rolled(folder, plant, **more):
    """Roll rates of the first flight."""
    campaign = fddbench.read(written(folder, plant, **more))
    out = folder / f"out_{plant}"
    fddbench.run(campaign, out)
    return fddbench.signals(out, "healthy").signals["p_true_deg_s"][:, 0].tolist(), out


def test_a_copy_flies_like_the_shipped_aircraft_and_travels_into_the_results(tmp_path):
    (tmp_path / "a").mkdir()
    shipped, _ = rolled(tmp_path / "a", "transport_6dof")
    copied, out = rolled(tmp_path / "a", "mine.yaml")
    assert copied == shipped
    assert (out / "mine.yaml").read_bytes() == SHIPPED.read_bytes()
    (tmp_path / "b").mkdir()
    changed, _ = rolled(
        tmp_path / "b", "mine.yaml", change=lambda text: text.replace("value: -0.46816", "value: -0.40")
    )
    assert changed != shipped
    (tmp_path / "c").mkdir()
    gentle = LAW.read_text(encoding="utf-8").replace("{value: 42.689", "{value: 30.0")
    law = "\nlaw:\n" + "".join(f"  {line}\n" for line in gentle.splitlines())
    slower, _ = rolled(tmp_path / "c", "mine.yaml", law=law)
    assert slower != shipped


def test_a_wrong_aircraft_is_told_where_the_campaign_names_it(tmp_path):
    path = written(tmp_path, "mine.yaml", change=lambda text: text.replace("c_m_q: -23.0", "c_m_q: -0.4"))
    with pytest.raises(FddbenchError) as caught:
        fddbench.read(path)
    message = str(caught.value)
    assert "campaign.yaml:5:8" in message
    assert "pitch.c_m_q: plausible is -50 to -5, got -0.4; is it in per degree?" in message


def test_a_missing_file_is_told(tmp_path):
    path = written(tmp_path, "other.yaml")
    with pytest.raises(FddbenchError, match="no file other.yaml in .*; a file of data lies beside the campaign"):
        fddbench.read(path)
