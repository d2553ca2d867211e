"""The table of trim and modes of an aircraft."""

import pytest

from fddbench.cli.main import main
from fddbench.flight.transport.reading import SHIPPED


def test_shows_the_shipped_aircraft(capsys):
    assert main(["modes"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 109
    assert "short_period_damping" in lines[0]
    assert "anticipation_1_g_s2" in lines[0]
    assert sum("above M_MO" in line for line in lines) == 9
    assert main(["modes", "--feasible"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 82


def test_shows_an_aircraft_of_ones_own_and_what_is_wrong_with_it(tmp_path, capsys):
    mine = tmp_path / "mine.yaml"
    mine.write_bytes(SHIPPED.read_bytes())
    assert main(["modes", str(mine)]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 109
    mine.write_text(SHIPPED.read_text(encoding="utf-8").replace("span_m: 60.3", "span_m: 197.8"), encoding="utf-8")
    assert main(["modes", str(mine)]) == 2
    assert "geometry.span_m: plausible is 20 to 90, got 197.8; is it in feet?" in capsys.readouterr().err


@pytest.mark.parametrize("option", ["--help"])
def test_says_what_it_shows(option, capsys):
    with pytest.raises(SystemExit):
        main(["modes", option])
    assert "Table 5" in capsys.readouterr().out
