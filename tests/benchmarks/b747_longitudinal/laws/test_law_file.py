"""Law files: read, discretised, refused."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from scipy.signal import cont2discrete

from fddbench.benchmarks.b747_longitudinal.laws import law_file
from fddbench.benchmarks.b747_longitudinal.laws.law_file import law_of, read_law
from fddbench.errors import DesignError

DATA = Path(law_file.__file__).parents[1] / "data"


def gains(name="lqi"):
    return yaml.safe_load((DATA / f"law_{name}.yaml").read_text())["gains"]


@pytest.mark.parametrize("name", ["hinf", "lqi", "scheduled"])
def test_a_shipped_law_is_discretised_by_tustin_s_rule(name):
    law = read_law(DATA / f"law_{name}.yaml")
    at = law.discrete(0.01)
    np.testing.assert_array_equal(at.E, 0.01 * law.E)
    for j in range(len(law.C)):
        A, B, C, D, _ = cont2discrete((law.A, law.B, law.C[j], law.D[j]), 0.01, method="bilinear")
        for own, other in ((at.A, A), (at.B, B), (at.C[j], C), (at.D[j], D)):
            np.testing.assert_allclose(own, other, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"inputs": ["pitch_deg"]}, "inputs of a law are flight_path_error_deg"),
        ({"A": [[1.0, 2.0], [3.0]]}, "ValueError"),
        ({"B": [[1.0]]}, r"B needs finite numbers of shape \(7, 7\), got shape \(1, 1\)"),
        ({"inputs": None}, "inputs of a law are flight_path_error_deg.*got None"),
        ({"outputs": 3}, "outputs of a law are elevator_deg.*got 3"),
        ({"handovr": 3}, "unknown key handovr; allowed: inputs, outputs"),
        (
            {"handover": {"lead_s": 2.0, "lag_s": 0.0, "command_lag_s": -1.0}},
            "must be > 0 .s., got lag_s = 0, command_lag_s = -1",
        ),
        ({"handover": {"lead_s": 2.0}}, "handover: {lead_s, lag_s, command_lag_s}"),
        ({"dynamic_pressure_pa": [2.0, 1.0]}, r"C needs finite numbers of shape \(2, 2, 7\)"),
    ],
)
def test_what_is_no_law_is_refused(change, message):
    with pytest.raises(DesignError, match=message):
        law_of(gains() | change, where="mine.yaml")


def test_knots_rise_and_a_law_says_that_it_is_one(tmp_path):
    own = gains("scheduled")
    with pytest.raises(DesignError, match="dynamic_pressure_pa needs two or more numbers in rising order"):
        law_of(own | {"dynamic_pressure_pa": own["dynamic_pressure_pa"][::-1]}, where="mine.yaml")
    (tmp_path / "no.yaml").write_text("gains: {")
    for name in ("no.yaml", "nowhere.yaml"):
        with pytest.raises(DesignError, match=f"{name} cannot be read"):
            read_law(tmp_path / name)
    (tmp_path / "no.yaml").write_text("kind: hinf_filter\n")
    with pytest.raises(DesignError, match="holds no law"):
        read_law(tmp_path / "no.yaml")
