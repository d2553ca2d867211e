"""`fddbench bound`: a table of detectability, of a campaign or a folder of results."""

import pytest

from fddbench.cli import main


def test_it_prints_distances_and_what_they_stand_on(capsys):
    assert main(["bound", "smoke", "--flights", "1", "--p-fa", "1e-3"]) == 0
    text = capsys.readouterr().out
    assert "walk 0.5" in text
    assert "≥ 100" in text
    assert "false alarms of its one decision 0.001" in text


def test_a_benchmark_without_a_model_says_so(capsys):
    assert main(["bound", "jet_engine_monte_carlo", "--flights", "1"]) == 0
    assert "with Δ known two samples betray any fault" in capsys.readouterr().out
    assert main(["bound", "b747_figures"]) == 0
    assert "states no ideal model" in capsys.readouterr().out


@pytest.mark.parametrize("wrong", [["--p-fa", "2"], ["--flights", "0"]])
def test_numbers_out_of_range_are_refused(wrong, capsys):
    with pytest.raises(SystemExit):
        main(["bound", "smoke", *wrong])
    assert "need a" in capsys.readouterr().err
