"""Laws of the samples that are no independent draws: by index, one run a part, the correlation that was asked for."""

import numpy as np
import pandas as pd
import pytest
import yaml
from scipy.stats import kstest, spearmanr

from fddbench.campaign.load import read_campaign
from fddbench.campaign.plan import plan
from fddbench.errors import CampaignError

MASS, CG = {"uniform": [180000, 220000]}, {"normal": {"mean": 0.3, "std": 0.02}}
SPEED = {"truncated_normal": {"mean": 290, "std": 20, "low": 260, "high": 320}}


def written(folder, monte_carlo, **more):
    """Campaign of a file."""
    content = {"name": "even", "benchmark": "yaw_rate", "seed": 7, "detectors": ["voting_monitor"]}
    content |= {
        "dispersions": {"monte_carlo": monte_carlo},
        "scenarios": [{"name": "a", "manoeuvre": "cruise"}],
        **more,
    }
    path = folder / "even.yaml"
    path.write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")
    return path


def drawn(folder, monte_carlo, **more):
    """Parameters of all runs."""
    planned = plan(read_campaign(written(folder, monte_carlo, **more)))
    return planned.parameters(np.arange(planned.n_cases))


ALL = {"mass_kg": MASS, "x_cg_ratio": CG, "v_cas_kt": SPEED}


@pytest.mark.parametrize("sampling", ["sobol", "halton"])
def test_points_by_index_more_runs_add_to_the_same(tmp_path, sampling):
    few, many = (drawn(tmp_path, {"runs": runs, "sampling": sampling, **ALL}) for runs in (100, 300))
    for name in ALL:
        assert np.array_equal(few[name], many[name][:100])
    again = drawn(tmp_path, {"runs": 100, "sampling": sampling, **ALL}, seed=8)
    assert not np.any(again["mass_kg"] == few["mass_kg"])
    other = drawn(tmp_path, {"runs": 100, "sampling": sampling, **ALL}, purpose="tuning")
    assert not np.any(other["mass_kg"] == few["mass_kg"])


@pytest.mark.parametrize("sampling", ["random", "sobol", "halton", "lhs"])
def test_every_sample_has_its_distributions(tmp_path, sampling):
    found = drawn(tmp_path, {"runs": 512, "sampling": sampling, **ALL})
    assert kstest(found["mass_kg"], "uniform", (180000, 40000)).pvalue > 1e-3
    assert kstest(found["x_cg_ratio"], "norm", (0.3, 0.02)).pvalue > 1e-3
    assert found["v_cas_kt"].min() >= 260.0
    assert found["v_cas_kt"].max() <= 320.0
    distance = kstest(found["mass_kg"], "uniform", (180000, 40000)).statistic
    assert (distance < 0.01) == (sampling != "random")  # even ones are far nearer than draws


def test_a_latin_hypercube_has_one_run_in_each_part(tmp_path):
    found = drawn(tmp_path, {"runs": 50, "sampling": "lhs", **ALL})
    parts = np.floor((found["mass_kg"] - 180000.0) / 40000.0 * 50.0).astype(int)
    assert sorted(parts) == list(range(50))
    assert abs(spearmanr(found["mass_kg"], found["x_cg_ratio"]).statistic) < 0.4


@pytest.mark.parametrize("sampling", ["random", "sobol", "lhs"])
def test_a_copula_correlates_and_leaves_each_distribution_alone(tmp_path, sampling):
    pairs = [["mass_kg", "x_cg_ratio", 0.8], ["v_cas_kt", "mass_kg", -0.5]]
    found = drawn(tmp_path, {"runs": 2048, "sampling": sampling, **ALL, "correlation": pairs})
    # of a Gaussian copula Spearman's is 6/pi arcsin(rho/2)
    for one, other, rho in pairs:
        assert spearmanr(found[one], found[other]).statistic == pytest.approx(6 / np.pi * np.arcsin(rho / 2), abs=0.04)
    assert kstest(found["mass_kg"], "uniform", (180000, 40000)).pvalue > 1e-3


def test_a_correlation_changes_no_draw_of_others_and_a_plain_campaign_means_what_it_did(tmp_path):
    alone = drawn(tmp_path, {"runs": 20, **ALL})
    pair = drawn(tmp_path, {"runs": 20, **ALL, "correlation": [["mass_kg", "x_cg_ratio", 0.5]]})
    assert np.array_equal(alone["v_cas_kt"], pair["v_cas_kt"])
    plain = read_campaign(written(tmp_path, {"runs": 20, **ALL})).sha256
    assert (
        plain == read_campaign(written(tmp_path, {"runs": 20, **ALL, "sampling": "random", "correlation": []})).sha256
    )
    assert plain != read_campaign(written(tmp_path, {"runs": 20, **ALL, "sampling": "sobol"})).sha256


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_a_table_gives_the_cases_as_they_are_written(tmp_path, suffix):
    table = pd.DataFrame({"mass_kg": [181000.5, 0.1 + 199999.9, 210000], "v_cas_kt": [270.0, 300.25, 1e2 + 200]})
    table.to_csv(tmp_path / "c.csv", index=False)
    table.to_parquet(tmp_path / "c.parquet")
    found = drawn(tmp_path, {"runs": 3, "table": f"c{suffix}", "x_cg_ratio": CG})
    assert found["mass_kg"].tolist() == table["mass_kg"].tolist()
    assert found["v_cas_kt"].tolist() == table["v_cas_kt"].tolist()
    campaign = read_campaign(tmp_path / "even.yaml")
    assert f"c{suffix}" in campaign.files()
    table.loc[0, "mass_kg"] += 1.0
    table.to_csv(tmp_path / "c.csv", index=False)
    table.to_parquet(tmp_path / "c.parquet")
    assert read_campaign(tmp_path / "even.yaml").sha256 != campaign.sha256


@pytest.mark.parametrize(
    ("monte_carlo", "table", "message"),
    [
        ({"sampling": "sobl"}, None, "sobol"),
        ({"table": "d.csv"}, None, "put the file beside the campaign"),
        ({"table": "../c.csv"}, None, "a table is a file beside the campaign"),
        ({"table": "c.csv"}, "mass_kg\n200000\n", "it has 1 rows, a row a run, and runs is 4; ask for at most 1 runs"),
        ({"table": "c.csv"}, "mass_kg\n", "it has no row"),
        ({"table": "c.csv"}, "mas_kg\n1\n2\n3\n4\n", "no parameter is called 'mas_kg'. Did you mean 'mass_kg'?"),
        (
            {"table": "c.csv"},
            "mass_kg\n2e5\n2e5\n9e9\n2e5\n",
            "line 4: mass_kg must be within 100000 to 260000, got 9e+09",
        ),
        (
            {"table": "c.csv"},
            "mass_kg\n2e5\nx\n2e5\n2e5\n",
            "c.csv, line 3: mass_kg is 'x', every row needs a number here",
        ),
        (
            {"table": "c.csv", "mass_kg": MASS},
            "mass_kg\n2e5\n2e5\n2e5\n2e5\n",
            "mass_kg is dispersed in monte_carlo as well",
        ),
        ({**ALL, "correlation": [["mass_kg", "altitude_ft", 0.1]]}, None, "'altitude_ft' is not drawn here"),
        ({**ALL, "correlation": [["mass_kg", "x_cg_ratio", 1.0]]}, None, "a correlation lies between -1 and 1, got 1"),
        ({**ALL, "correlation": [["mass_kg", "mass_kg", 0.1]]}, None, "correlated with another one"),
        (
            {
                **ALL,
                "correlation": [
                    ["mass_kg", "x_cg_ratio", 0.9],
                    ["x_cg_ratio", "v_cas_kt", 0.9],
                    ["mass_kg", "v_cas_kt", -0.9],
                ],
            },
            None,
            "no numbers have all these correlations at once",
        ),
    ],
)
def test_mistakes_are_told_with_their_place(tmp_path, monte_carlo, table, message):
    if table is not None:
        (tmp_path / "c.csv").write_text(table, encoding="utf-8")
    path = written(tmp_path, {"runs": 4, **monte_carlo})
    with pytest.raises(CampaignError) as caught:
        read_campaign(path)
    assert message in str(caught.value)
    assert f"{path}:" in str(caught.value)


def test_runs_of_a_scenario_do_not_cut_a_latin_hypercube(tmp_path):
    scenarios = [{"name": "a", "manoeuvre": "cruise", "runs": 3}]
    with pytest.raises(CampaignError, match="a Latin hypercube is one sample of all runs"):
        read_campaign(written(tmp_path, {"runs": 4, "sampling": "lhs", **ALL}, scenarios=scenarios))
