"""A recipe of a law that asks for what is not there is refused at its place in the file."""

import pytest

from fddbench.benchmarks.b747_longitudinal.laws import law_file
from fddbench.design.recipe import cook
from fddbench.errors import DesignError

LAW = (law_file.Path(law_file.__file__).parents[1] / "data" / "law_lqi.yaml").read_text().split("gains:")[
    0
] + "gains: {}\n"
SCHEDULED = ("method: lqi", "method: scheduled_lqi\n  dynamic_pressure_pa: [8000.0, 9000.0]")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            [("[7000.0]", "[70000.0]"), ("[241.0]", "[24.0]")],
            r"law.yaml:8:15: recipe.altitude_m: must lie in 1000 ... 11000 \[m\]",
        ),
        (
            [("[7000.0]", "[70000.0]"), ("[241.0]", "[24.0]")],
            r"law.yaml:9:14: recipe.v_tas_m_s: must lie in 150 ... 280 \[m/s\]",
        ),
        ([("error: [0.5, 1.5]", "error: [1.0e-150, 1.5]")], r"law.yaml:7:3: the numbers of this recipe give no design"),
        ([SCHEDULED, ("[241.0]", "[10.0]")], r"law.yaml:9:15: recipe.altitude_m: no point of its grid"),
        (
            [SCHEDULED, ("[8000.0, 9000.0]", "[9000.0, 8000.0]")],
            r"law.yaml:8:24: recipe.dynamic_pressure_pa: must rise",
        ),
    ],
)
def test_a_law_that_cannot_be_made(tmp_path, changes, message):
    text = LAW
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = tmp_path / "law.yaml"
    path.write_text(text)
    with pytest.raises(DesignError, match=message):
        cook(path)
